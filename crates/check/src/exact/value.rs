mod nearest;

use std::fmt;

use dashu_int::IBig;
use dashu_int::ops::Gcd;
use serde::{Serialize, Serializer};

use super::WeightedPoint;
use super::formulas::{Power1, Power2, Power3, Power4, Radius2, Radius3, Radius4, Volume};
use super::frame::{Digits, Formula, Frame, cross, dot};
use super::number::Number;

/// An exact rational number: numerator / denominator · 2^exponent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exact {
    numerator: IBig,
    denominator: IBig,
    exponent: i64,
}

impl Exact {
    /// In lowest terms, both odd or zero.
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

impl fmt::Display for Exact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
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
    /// As text: JSON numbers would round it.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
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

#[cfg(test)]
mod tests {
    use super::*;

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
}
