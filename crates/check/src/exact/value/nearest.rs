use std::cmp::Ordering;

use dashu_int::IBig;
use dashu_int::ops::{BitTest, DivRem, UnsignedAbs};

use super::Exact;
use crate::exact::number::sign;

/// Digits of a double, and the exponent of the first one of the smallest normal double.
const DIGITS: i64 = 53;
const NORMAL: i64 = -1022;
/// Above the first digit of all doubles.
const LARGEST: i64 = 1024;

impl Exact {
    /// The nearest double, of two equally near ones the even one; ±∞ beyond all doubles.
    ///
    /// # Panics
    /// Never: no more than 53 digits are kept.
    pub fn nearest(&self) -> f64 {
        let negative = sign(&self.numerator).is_lt();
        let size = if negative { -&self.numerator } else { self.numerator.clone() };
        if size.is_zero() {
            return 0.0;
        }
        // Enough digits of the quotient for the remainder to decide ties only.
        let more = (DIGITS + 13 + length(&self.denominator) - length(&size)).max(0);
        let (quotient, rest) = (size << more as usize).div_rem(&self.denominator);
        let exponent = self.exponent - more;
        let top = exponent + length(&quotient) - 1;
        if top >= LARGEST {
            return if negative { f64::NEG_INFINITY } else { f64::INFINITY };
        }
        let kept = DIGITS - (NORMAL - top).max(0);
        let dropped = (length(&quotient) - kept) as usize;
        let digits = &quotient >> dropped;
        let tail = quotient - (&digits << dropped);
        let up = match tail.cmp(&(IBig::ONE << (dropped - 1))) {
            Ordering::Equal => !rest.is_zero() || digits.bit(0),
            order => order.is_gt(),
        };
        let digits = i64::try_from(digits).expect("at most 53 digits") + i64::from(up);
        let power = exponent + dropped as i64;
        // Two powers, as one alone may be out of range; each product is exact, or infinite.
        let half = power / 2;
        let value = digits as f64 * 2f64.powi(half as i32) * 2f64.powi((power - half) as i32);
        if negative && value != 0.0 { -value } else { value }
    }

    /// The order of two numbers.
    pub fn compare(&self, other: &Self) -> Ordering {
        let mut here = &self.numerator * &other.denominator;
        let mut there = &other.numerator * &self.denominator;
        let finer = self.exponent - other.exponent;
        if finer > 0 {
            here <<= finer as usize;
        } else {
            there <<= finer.unsigned_abs() as usize;
        }
        here.cmp(&there)
    }
}

fn length(number: &IBig) -> i64 {
    number.unsigned_abs().bit_len() as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(numerator: i64, denominator: i64, exponent: i64) -> Exact {
        Exact::new(numerator.into(), denominator.into(), exponent)
    }

    #[test]
    fn the_nearest_double() {
        for (n, d) in [(1, 3), (2, 3), (-10, 7), (5, 1), (0, 5), (22, 7), (-1, 1 << 40)] {
            assert_eq!(exact(n, d, 0).nearest(), n as f64 / d as f64, "{n}/{d}");
        }
        let two_53 = 1 << 53;
        for odd in [1, 3, 5, 7, -1, -3] {
            assert_eq!(exact(two_53 + odd, 1, 0).nearest(), (two_53 + odd) as f64);
            let half = (odd / 2 + odd / 2 % 2) as f64 * 5e-324;
            assert_eq!(exact(odd, 2, -1074).nearest(), half);
        }
        assert_eq!(exact(3 * two_53 + 1, 3, 0).nearest(), two_53 as f64);
        assert_eq!(exact(3 * two_53 + 4, 3, 0).nearest(), (two_53 + 2) as f64);
        assert_eq!(exact(1, -3, 0).nearest(), -1.0 / 3.0);
        assert_eq!(exact(-2, -6, 0), exact(1, 3, 0));
        assert_eq!(exact(1, 1, 1023).nearest(), 2f64.powi(1023));
        assert_eq!(exact(two_53 - 1, 1, 971).nearest(), f64::MAX);
        assert_eq!(exact(1, 1, 1024).nearest(), f64::INFINITY);
        assert_eq!(exact(-1, 1, 2000).nearest(), f64::NEG_INFINITY);
        assert_eq!(exact(1, 3, -1080).nearest(), 0.0);
        assert_eq!(exact(2, 3, -1074).nearest(), 5e-324);
        // A little less than halfway, which 53 digits cannot distinguish from halfway.
        assert_eq!(exact(3 * (1 << 60) - 1, 1, -1074 - 61).nearest(), 5e-324);
    }

    #[test]
    fn order() {
        assert!(exact(1, 3, 0).compare(&exact(1, 2, 0)).is_lt());
        assert!(exact(1, 3, 2).compare(&exact(1, 2, 1)).is_gt());
        assert!(exact(2, 6, 3).compare(&exact(4, 3, 1)).is_eq());
        assert!(exact(-1, 3, 0).compare(&exact(1, 9, -7)).is_lt());
    }
}
