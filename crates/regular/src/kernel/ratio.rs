use std::cmp::Ordering;

use dashu_int::IBig;
use dashu_int::ops::{BitTest, DivEuclid, DivRemEuclid, UnsignedAbs};

/// An exact number: numerator / denominator · 2^exponent with a positive denominator.
#[derive(Clone, Debug)]
pub struct Ratio {
    numerator: IBig,
    denominator: IBig,
    exponent: i32,
}

/// The exponent of the smallest positive double: −1074.
const LOWEST: i32 = f64::MIN_EXP - f64::MANTISSA_DIGITS as i32;
/// Bits of the mantissa of a double.
const MANTISSA_BITS: i32 = f64::MANTISSA_DIGITS as i32;

impl Ratio {
    pub(super) fn new(numerator: IBig, denominator: IBig, exponent: i32) -> Self {
        Self { numerator, denominator, exponent }
    }

    /// The number rounded up to a double; +∞ beyond the largest.
    pub(super) fn rounded_up(self) -> f64 {
        // The quotient has up to 4 bits more than a double, but none below the lowest of a double.
        let shift = self.shift_for(MANTISSA_BITS + 3);
        let (numerator, denominator, exponent) = self.shifted(shift);
        let ceiling = -((-numerator).div_euclid(denominator));
        // Rounding up in two steps is rounding up once.
        let spare = (bits(&ceiling) - MANTISSA_BITS).max(0);
        let unit = IBig::ONE << spare as usize;
        let digits = -((-ceiling).div_euclid(unit));
        let value = double(digits, exponent + spare);
        if value == f64::NEG_INFINITY { f64::MIN } else { value }
    }

    /// The nearest double, of two equally near ones the even one; ±∞ beyond the largest. Never −0.
    pub fn nearest(self) -> f64 {
        // The quotient has 53 or 54 bits, or fewer if the double is subnormal.
        let shift = self.shift_for(MANTISSA_BITS);
        let (numerator, denominator, exponent) = self.shifted(shift);
        let negative = numerator < IBig::ZERO;
        let numerator = if negative { -numerator } else { numerator };
        let mut unit = denominator;
        let mut exponent = exponent;
        let (mut digits, mut rest) = (&numerator).div_rem_euclid(&unit);
        if bits(&digits) > MANTISSA_BITS {
            (unit, exponent) = (unit << 1, exponent + 1);
            (digits, rest) = (&numerator).div_rem_euclid(&unit);
        }
        let twice = rest.as_ibig().clone() << 1;
        let odd = digits.bit(0);
        let up = twice > unit || (twice == unit && odd);
        let value = double(if up { digits + IBig::ONE } else { digits }, exponent);
        if negative && value != 0.0 { -value } else { value }
    }

    /// The number of bits by which the numerator must be shifted to the left for a quotient of `count` bits or one more, but with
    /// no bits below the lowest bit of a double. Negative for a shift of the denominator.
    fn shift_for(&self, count: i32) -> i32 {
        (count - bits(&self.numerator) + bits(&self.denominator)).min(self.exponent - LOWEST)
    }

    /// Numerator, denominator and exponent of the same number, shifted.
    fn shifted(self, shift: i32) -> (IBig, IBig, i32) {
        let Self { numerator, denominator, exponent } = self;
        if shift >= 0 {
            (numerator << shift as usize, denominator, exponent - shift)
        } else {
            (numerator, denominator << shift.unsigned_abs() as usize, exponent - shift)
        }
    }
}

impl Ord for Ratio {
    fn cmp(&self, other: &Self) -> Ordering {
        let mut here = &self.numerator * &other.denominator;
        let mut there = &other.numerator * &self.denominator;
        match self.exponent - other.exponent {
            finer if finer >= 0 => here <<= finer as usize,
            finer => there <<= finer.unsigned_abs() as usize,
        }
        here.cmp(&there)
    }
}

impl PartialOrd for Ratio {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Ratio {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Ratio {}

/// Bits of the magnitude.
fn bits(number: &IBig) -> i32 {
    number.unsigned_abs().bit_len() as i32
}

/// `digits`, of magnitude at most 2⁵³, times 2^`power`.
fn double(digits: IBig, power: i32) -> f64 {
    let digits = i64::try_from(digits).expect("at most 2⁵³") as f64;
    // Two steps are needed because a power alone may be out of range; each product is exact.
    digits * 2f64.powi(power / 2) * 2f64.powi(power - power / 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ratio(numerator: i64, denominator: i64, exponent: i32) -> Ratio {
        Ratio::new(numerator.into(), denominator.into(), exponent)
    }

    #[test]
    fn the_nearest_double() {
        for (n, d) in [(1, 3), (2, 3), (-10, 7), (1, 1), (0, 5), (22, 7), (-1, 1 << 40)] {
            assert_eq!(ratio(n, d, 0).nearest(), n as f64 / d as f64, "{n}/{d}");
            assert_eq!(ratio(n << 5, d, -5).nearest(), n as f64 / d as f64, "{n}/{d}");
        }
        // Halfway: to the even one.
        let two_53 = 1 << 53;
        for odd in [1, 3, 5, 7, -1, -3] {
            assert_eq!(ratio(two_53 + odd, 1, 0).nearest(), (two_53 + odd) as f64);
            assert_eq!(ratio(3 * (two_53 + odd), 3, 0).nearest(), (two_53 + odd) as f64);
            assert_eq!(ratio(odd, 2, LOWEST).nearest(), (odd / 2 + odd / 2 % 2) as f64 * 5e-324);
        }
        assert_eq!(ratio(1, 1, 1024).nearest(), f64::INFINITY);
        assert_eq!(ratio(-1, 1, 1024).nearest(), f64::NEG_INFINITY);
        assert!(ratio(-1, 3, LOWEST).nearest().is_sign_positive());
    }

    #[test]
    fn order() {
        assert!(ratio(1, 3, 0) < ratio(1, 2, 0) && ratio(1, 3, 2) > ratio(1, 2, 1));
        assert_eq!(ratio(2, 6, 3), ratio(4, 3, 1));
        assert!(ratio(-1, 3, 0) < ratio(1, 9, -7));
    }
}
