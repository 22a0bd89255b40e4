//! Exact rational numbers: volumes, powers and squared radii, and the nearest doubles.

use std::cmp::Ordering;
use std::fmt;

use dashu_int::IBig;
use dashu_int::ops::{BitTest, DivRem, Gcd, UnsignedAbs};
use serde::{Serialize, Serializer};
use walpha_base::shown::{number, six_digits};

use super::formulas::{Power1, Power2, Power3, Power4, Radius2, Radius3, Radius4, Volume};
use super::frame::{Digits, Formula, Frame, WeightedPoint, cross, dot};
use super::number::{Number, sign};

/// An exact rational number: numerator / denominator · 2^exponent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exact {
    numerator: IBig,
    denominator: IBig,
    exponent: i64,
}

impl Exact {
    /// Creates a value in lowest terms: numerator and denominator are odd or zero.
    pub(crate) fn new(numerator: IBig, denominator: IBig, exponent: i64) -> Self {
        let Some(twos) = numerator.trailing_zeros() else {
            return Self { numerator, denominator: IBig::ONE, exponent: 0 };
        };
        let sign = if denominator < IBig::ZERO { -IBig::ONE } else { IBig::ONE };
        let common = IBig::from((&numerator).gcd(&denominator)) * sign;
        let (numerator, denominator) = (numerator / &common, denominator / common);
        let up = numerator.trailing_zeros().unwrap_or(0);
        let down = denominator.trailing_zeros().unwrap_or(0);
        debug_assert!(up <= twos);
        Self {
            numerator: numerator >> up,
            denominator: denominator >> down,
            exponent: exponent + up as i64 - down as i64,
        }
    }

    /// Whether it is zero.
    pub fn is_zero(&self) -> bool {
        self.numerator.is_zero()
    }

    /// Whether it is this decimal number, of few digits, and not only the double nearest to it.
    fn is(&self, rounded: f64) -> bool {
        let text = format!("{rounded:e}");
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        let power: i64 = power.parse().unwrap_or_default();
        let after = digits.split_once('.').map_or(0, |(_, after)| after.len() as i64);
        let Ok(digits) = digits.replace('.', "").parse::<i64>() else { return false };
        let ten = |power: i64| IBig::from(10).pow(power.max(0) as usize);
        let (up, down) = (ten(power - after), ten(after - power));
        self.compare(&Self::new(IBig::from(digits) * up, down, 0)).is_eq()
    }

    pub(crate) fn integer(value: IBig, exponent: i64) -> Self {
        Self::new(value, IBig::ONE, exponent)
    }
}

impl Default for Exact {
    /// Zero.
    fn default() -> Self {
        Self { numerator: IBig::ZERO, denominator: IBig::ONE, exponent: 0 }
    }
}

/// Beyond this exponent a power of two is not multiplied out when printed.
const PRINTED_EXPONENT: i64 = 128;

/// Rounded to six digits, with ≈ where that is another number; `{:#}` writes the fraction.
impl fmt::Display for Exact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !f.alternate() {
            let rounded = six_digits(self.nearest());
            let about = if self.is(rounded) { "" } else { "≈" };
            return write!(f, "{about}{}", number(rounded));
        }
        let Self { numerator, denominator, exponent } = self;
        let factor = IBig::ONE << exponent.unsigned_abs().min(PRINTED_EXPONENT as u64) as usize;
        let one = IBig::ONE;
        let (top, bottom, rest) = match *exponent {
            e if e.abs() > PRINTED_EXPONENT => (numerator.clone(), denominator.clone(), e),
            e if e < 0 => (numerator.clone(), denominator * factor, 0),
            _ => (numerator * factor, denominator.clone(), 0),
        };
        write!(f, "{top}")?;
        if bottom != one {
            write!(f, "/{bottom}")?;
        }
        if rest != 0 { write!(f, "·2^{rest}") } else { Ok(()) }
    }
}

impl Serialize for Exact {
    /// Writes text, because JSON numbers would round the value.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&format_args!("{self:#}"))
    }
}

/// det(b−a, c−a, d−a).
pub(crate) fn six_volume([a, b, c, d]: [&WeightedPoint; 4]) -> Exact {
    let digits = Digits::new(a, [b, c, d], 0.0);
    Exact::integer(Volume.value(&digits.big()), 3 * i64::from(digits.coordinate))
}

/// The power of `q` with respect to the smallest orthogonal sphere of a simplex, less its weight:
/// |q − centre|² − R² − `w_q`, negative inside.
///
/// # Panics
/// If the simplex has no vertices, more than 4, or dependent ones.
pub(crate) fn power_value<const N: usize>(
    simplex: [&WeightedPoint; N],
    q: &WeightedPoint,
) -> Exact {
    match simplex[..] {
        [a] => ratio(&Power1, a, [q], |_| IBig::ONE),
        [a, b] => ratio(&Power2, a, [b, q], |f| dot(&f.offsets[0], &f.offsets[0])),
        [a, b, c] => ratio(&Power3, a, [b, c, q], |f| area(&f.offsets[0], &f.offsets[1])),
        [a, b, c, d] => {
            let det = |f: &Frame<IBig, 4>| {
                let [a, b, c, _] = &f.offsets;
                dot(&cross(a, b), c)
            };
            ratio(&Power4, a, [b, c, d, q], det)
        }
        _ => panic!("a simplex has 1 to 4 vertices, not {N}"),
    }
}

/// R² of the smallest orthogonal sphere of a simplex.
///
/// # Panics
/// If the simplex has no vertices, more than 4, or dependent ones.
pub(crate) fn radius_value<const N: usize>(simplex: [&WeightedPoint; N]) -> Exact {
    match simplex[..] {
        [a] => {
            let digits = Digits::<0>::new(a, [], 0.0);
            Exact::integer(-digits.big().level, i64::from(digits.height))
        }
        [a, b] => ratio(&Radius2, a, [b], |f| four_unit(f) * dot(&f.offsets[0], &f.offsets[0])),
        [a, b, c] => {
            ratio(&Radius3, a, [b, c], |f| four_unit(f) * area(&f.offsets[0], &f.offsets[1]))
        }
        [a, b, c, d] => ratio(&Radius4, a, [b, c, d], |f| {
            let det = Volume.value(f);
            four_unit(f) * &det * &det
        }),
        _ => panic!("a simplex has 1 to 4 vertices, not {N}"),
    }
}

/// A formula, whose value is a height times some factor, over that factor.
fn ratio<const N: usize>(
    formula: &impl Formula<N>,
    origin: &WeightedPoint,
    others: [&WeightedPoint; N],
    factor: impl Fn(&Frame<IBig, N>) -> IBig,
) -> Exact {
    let digits = Digits::new(origin, others, 0.0);
    let frame = digits.big();
    let factor = factor(&frame);
    assert!(!factor.is_zero(), "the simplex is flat");
    Exact::new(formula.value(&frame), factor, i64::from(digits.height))
}

fn four_unit<const N: usize>(frame: &Frame<IBig, N>) -> IBig {
    &frame.unit * 4
}

/// |a × b|², the determinant of the Gram matrix.
fn area(a: &[IBig; 3], b: &[IBig; 3]) -> IBig {
    let normal = cross(a, b);
    normal[0]
        .times(&normal[0])
        .plus(&normal[1].times(&normal[1]))
        .plus(&normal[2].times(&normal[2]))
}

/// Digits of a double, and the exponent of the first one of the smallest normal double.
const DIGITS: i64 = 53;
const NORMAL: i64 = -1022;
/// Above the first digit of all doubles.
const LARGEST: i64 = 1024;

impl Exact {
    /// The nearest double, of two equally near ones the even one; ±∞ beyond all doubles.
    ///
    /// # Panics
    /// Never, because at most 53 digits are kept.
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
        // Two powers, because a single one may be out of range; each product is exact, or infinite.
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

    #[test]
    fn numbers_are_rounded_to_six_digits_or_fractions() {
        let exact = |numerator: i64, denominator: i64, exponent| {
            Exact::new(IBig::from(numerator), IBig::from(denominator), exponent)
        };
        for (number, decimals, fraction) in [
            (exact(0, 1, 0), "0", "0"),
            (exact(3, 4, 0), "0.75", "3/4"),
            (exact(-2, 3, 0), "≈-0.666667", "-2/3"),
            (exact(2, 1, 0), "2", "2"),
            (exact(1_234_567, 1, 0), "≈1234570", "1234567"),
            (exact(1_234_560, 1, 0), "1234560", "1234560"),
            (exact(1, 10, 0), "0.1", "1/10"),
            // The double nearest to 1/10.
            (exact(3602879701896397, 1, -55), "≈0.1", "3602879701896397/36028797018963968"),
            (exact(1, 1, -30), "≈9.31323e-10", "1/1073741824"),
            (exact(1, 1_000_000, 0), "1e-6", "1/1000000"),
            (exact(3, 1, 200), "≈4.82081e60", "3·2^200"),
        ] {
            assert_eq!(
                (number.to_string().as_str(), format!("{number:#}").as_str()),
                (decimals, fraction)
            );
        }
    }

    #[test]
    fn values_are_in_units_of_length() {
        let at = |position: [f64; 3]| WeightedPoint { position, weight: 0.0 };
        let [a, b, c, d] = [[0.0; 3], [0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5]].map(at);
        assert_eq!(six_volume([&a, &b, &c, &d]).nearest(), 0.125);
        assert_eq!(six_volume([&a, &c, &b, &d]).nearest(), -0.125);
        assert_eq!(radius_value([&a, &b, &c, &d]).nearest(), 0.1875);
        assert_eq!(power_value([&a, &b, &c, &d], &at([0.5; 3])).nearest(), 0.0);
        assert_eq!(power_value([&a, &c, &b, &d], &at([1.0; 3])).nearest(), 1.5);
        assert_eq!(power_value([&a, &b], &at([1.0; 3])).nearest(), 2.5);
    }

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
