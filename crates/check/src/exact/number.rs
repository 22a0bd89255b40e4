//! The number types of the predicates, and the binary digits of doubles.

use std::cmp::Ordering;

use dashu_int::{IBig, Sign};

/// A number type of predicates. One formula serves all of them: [`Approx`] decides the easy cases, [`Bits`] proves that `i128`
/// holds the rest, and [`IBig`] holds anything; [`Wide`](super::wide::Wide) is for sums.
pub(super) trait Number: Clone {
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
}

impl Number for i128 {
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
}

impl Number for IBig {
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
}

/// A bound on an integer: its magnitude is below 2^`0`. Running a formula on bounds bounds every
/// intermediate result as well, because each is below the final one or feeds it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bits(pub u32);

impl Bits {
    /// The widest integer an `i128` can hold in both signs.
    pub(super) const I128: u32 = 127;
}

impl Number for Bits {
    fn plus(&self, other: &Self) -> Self {
        Self(self.0.max(other.0) + 1)
    }
    fn minus(&self, other: &Self) -> Self {
        self.plus(other)
    }
    fn times(&self, other: &Self) -> Self {
        Self(self.0 + other.0)
    }
}

/// A double and a bound on its distance from the true value, by the number of roundings on the way to it.
///
/// With u = 2⁻⁵³, a value that took r roundings is off by at most 2 r u m. Here m, computed along with the value, is at least its
/// magnitude: the sum of magnitudes, as if nothing cancelled. A rounding adds at most u m, so 2 u m leaves as much again for the
/// roundings of m itself and for products of two errors, which are below u m for fewer than 2²⁰ roundings. What underflows in a
/// product is at most u times [`f64::MIN_POSITIVE`], which is therefore added to m. An overflow makes the bound infinite or NaN,
/// and then nothing is decided.
///
/// Formulas have no branches, so compilers know each r, and only two numbers are computed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approx {
    value: f64,
    /// m.
    most: f64,
    /// r.
    roundings: u32,
}

impl Approx {
    /// A number known exactly.
    #[inline(always)]
    pub(super) fn exact(value: f64) -> Self {
        Self { value, most: value.abs(), roundings: 0 }
    }

    /// The sum or difference of two numbers, whose rounded value is given.
    #[inline(always)]
    fn sum(self, other: Self, value: f64) -> Self {
        let roundings = self.roundings.max(other.roundings) + 1;
        // The only rounding of a sum of exact numbers is its own.
        let most = if roundings == 1 { value.abs() } else { self.most + other.most };
        Self { value, most, roundings }
    }

    /// The computed value and a bound on its error.
    #[inline(always)]
    pub(super) fn value_and_error(self) -> (f64, f64) {
        (self.value, f64::from(self.roundings) * f64::EPSILON * self.most)
    }

    /// The sign of the true value, if the bound proves it. Never `Equal`.
    #[inline(always)]
    pub(super) fn sign(self) -> Option<Ordering> {
        let (value, error) = self.value_and_error();
        if value > error {
            Some(Ordering::Greater)
        } else if -value > error {
            Some(Ordering::Less)
        } else {
            None
        }
    }
}

impl Number for Approx {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        self.sum(*other, self.value + other.value)
    }
    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        self.sum(*other, self.value - other.value)
    }
    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        Self {
            value: self.value * other.value,
            most: self.most * other.most + f64::MIN_POSITIVE,
            roundings: self.roundings + other.roundings + 1,
        }
    }
}

/// The sign of a big integer, as its comparison with zero.
pub(super) fn sign(value: &IBig) -> Ordering {
    match value.sign() {
        _ if value.is_zero() => Ordering::Equal,
        Sign::Positive => Ordering::Greater,
        Sign::Negative => Ordering::Less,
    }
}

/// A finite double as mantissa · 2^exponent with an odd mantissa (or zero), without loss of information.
#[derive(Clone, Copy, Debug)]
pub(super) struct Binary {
    mantissa: i64,
    exponent: i32,
}

impl Binary {
    pub(super) fn new(value: f64) -> Self {
        debug_assert!(value.is_finite());
        let bits = value.to_bits();
        let biased = (bits >> 52 & 0x7ff) as i32;
        let fraction = (bits & ((1 << 52) - 1)) as i64;
        let (magnitude, exponent) =
            if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
        if magnitude == 0 {
            return Self { mantissa: 0, exponent: 0 };
        }
        let zeros = magnitude.trailing_zeros();
        let odd = magnitude >> zeros;
        let mantissa = if value < 0.0 { -odd } else { odd };
        Self { mantissa, exponent: exponent + zeros as i32 }
    }

    /// The value in units of 2^`exponent`, which must not exceed its own exponent, when
    /// [`Range::bits`] says that it fits.
    pub(super) fn small(self, exponent: i32) -> i128 {
        if self.mantissa == 0 { 0 } else { i128::from(self.mantissa) << (self.exponent - exponent) }
    }

    /// The value in units of 2^`exponent`, which must not exceed its own exponent.
    pub(super) fn big(self, exponent: i32) -> IBig {
        if self.mantissa == 0 {
            IBig::ZERO
        } else {
            IBig::from(self.mantissa) << (self.exponent - exponent) as usize
        }
    }
}

/// The binary digits that a set of numbers spans.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    /// Exponent of the lowest digit set in any of them.
    low: i32,
    /// Exponent just above the highest.
    high: i32,
}

impl Range {
    pub(super) const EMPTY: Self = Self { low: i32::MAX, high: i32::MIN };

    pub(super) fn with(self, number: Binary) -> Self {
        if number.mantissa == 0 {
            return self;
        }
        let length = (64 - number.mantissa.unsigned_abs().leading_zeros()) as i32;
        Self { low: self.low.min(number.exponent), high: self.high.max(number.exponent + length) }
    }

    /// The exponent of the common unit; `None` if all numbers are zero.
    pub(super) fn unit(self) -> Option<i32> {
        (self.low < self.high).then_some(self.low)
    }

    /// The number of binary digits that the numbers need in units of 2^`unit`, without the sign.
    pub(super) fn bits(self, unit: i32) -> u32 {
        if self.low < self.high { (self.high - unit) as u32 } else { 0 }
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;

    /// The errors of random sums, differences and products of integers, which are known exactly, are within their bounds, and
    /// these are not much larger than necessary.
    #[test]
    fn errors_bound_the_distance() {
        let mut random = Random::new(3);
        let (mut off, mut widest) = (0, 0.0f64);
        for _ in 0..2000 {
            let mut known: Vec<(Approx, IBig)> = (0..4)
                .map(|_| {
                    let shift = random.below(12);
                    let digits = random.next() as i64 >> (11 + random.below(40));
                    let exact = IBig::from(digits) << shift;
                    (Approx::exact(digits as f64 * 2f64.powi(shift as i32)), exact)
                })
                .collect();
            for _ in 0..8 {
                let [(x, p), (y, q)] = [(); 2].map(|()| &known[random.below(known.len())]);
                let next = match random.below(3) {
                    0 => (x.plus(y), p + q),
                    1 => (x.minus(y), p - q),
                    _ => (x.times(y), p * q),
                };
                known.push(next);
            }
            for (approx, exact) in &known[4..] {
                let (value, error) = approx.value_and_error();
                if !error.is_finite() {
                    continue;
                }
                let binary = Binary::new(value);
                let rounded = binary.big(0);
                let distance = (rounded - exact).to_f64().value().abs();
                assert!(distance <= error, "{approx:?}: {distance}");
                off += usize::from(distance > 0.0);
                widest = widest.max(distance / error);
            }
        }
        assert!(off > 5000 && widest > 0.25, "{off}, {widest}");
    }

    /// A difference of equal exact numbers is certainly 0; a difference of rounded numbers is not.
    #[test]
    fn what_cancels_leaves_its_error() {
        let third = Approx::exact(1.0 / 3.0);
        assert_eq!(third.minus(&third).value_and_error(), (0.0, 0.0));
        let square = third.times(&third);
        let (value, error) = square.minus(&square).value_and_error();
        assert!(value == 0.0 && error >= f64::EPSILON / 9.0, "{error}");
    }

    /// The error includes roundings of the value and of the bound itself.
    #[test]
    fn roundings_are_errors() {
        let tiny = f64::EPSILON / 4.0;
        let (value, error) = Approx::exact(1.0).plus(&Approx::exact(tiny)).value_and_error();
        assert!(value == 1.0 && error >= tiny);
        let product = Approx::exact(1.0 + f64::EPSILON).times(&Approx::exact(1.0 + f64::EPSILON));
        assert!(product.value_and_error().1 >= f64::EPSILON * f64::EPSILON);
        let large = Approx::exact(1e200).times(&Approx::exact(1e200));
        assert!(large.sign().is_none() && large.minus(&large).sign().is_none());
        let lost = Approx::exact(1e-200).times(&Approx::exact(1e-200));
        let (value, error) = lost.times(&Approx::exact(1e300)).value_and_error();
        assert!((value - 1e-100).abs() <= error);
        assert!(Approx::exact(1e-200).times(&Approx::exact(1e-200)).sign().is_none());
    }

    #[test]
    fn a_sign_is_returned_where_it_is_certain() {
        let sign =
            |value, error: f64| Approx { value, most: error / f64::EPSILON, roundings: 1 }.sign();
        assert_eq!(
            [sign(3.0, 2.0), sign(-3.0, 2.0)],
            [Some(Ordering::Greater), Some(Ordering::Less)]
        );
        assert_eq!([sign(2.0, 2.0), sign(-2.0, 2.0), sign(0.0, 0.0)], [None; 3]);
        assert_eq!([sign(1.0, f64::NAN), sign(f64::NAN, 1.0), sign(1.0, f64::INFINITY)], [None; 3]);
    }
}
