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

/// A double and a bound on its distance from the true value: a running error analysis.
///
/// With u = 2⁻⁵³, a rounded sum s differs from the exact sum by at most u·|s|, a rounded product
/// by at most u·|p| plus half the smallest subnormal. The bound itself is computed with at most
/// seven roundings, each losing a factor of at most 1 − u, which the factor 1 + 8u makes good;
/// whatever underflows on the way is below [`f64::MIN_POSITIVE`]. An overflow makes the bound
/// infinite or NaN, and then nothing is decided.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approx {
    value: f64,
    error: f64,
}

impl Approx {
    const U: f64 = f64::EPSILON / 2.0;

    /// A number known exactly.
    pub(super) fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    fn rounded(value: f64, inherited: f64) -> Self {
        let error = (inherited + value.abs() * Self::U) * (1.0 + 8.0 * Self::U);
        Self { value, error: error + f64::MIN_POSITIVE }
    }

    /// The computed value and a bound on its error.
    pub(super) fn value_and_error(self) -> (f64, f64) {
        (self.value, self.error)
    }

    /// The sign of the true value, if the bound proves it. Never `Equal`.
    pub(super) fn sign(self) -> Option<Ordering> {
        if self.value > self.error {
            Some(Ordering::Greater)
        } else if -self.value > self.error {
            Some(Ordering::Less)
        } else {
            None
        }
    }
}

impl Number for Approx {
    fn plus(&self, other: &Self) -> Self {
        Self::rounded(self.value + other.value, self.error + other.error)
    }
    fn minus(&self, other: &Self) -> Self {
        Self::rounded(self.value - other.value, self.error + other.error)
    }
    fn times(&self, other: &Self) -> Self {
        let inherited = self.value.abs() * other.error
            + other.value.abs() * self.error
            + self.error * other.error;
        Self::rounded(self.value * other.value, inherited)
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
    use super::*;

    /// The ends of the interval of a number, where they are doubles.
    fn ends(number: Approx) -> [f64; 2] {
        [number.value - number.error, number.value + number.error]
    }

    /// The interval of a result contains all results for numbers in the intervals of the operands, and hardly more.
    #[test]
    fn errors_bound_the_worst_case() {
        let all =
            [(1000.0, 1.0), (-3.0, 0.5), (0.25, 0.125), (-64.0, 32.0), (0.0, 2.0), (8.0, 0.0)];
        let all = all.map(|(value, error)| Approx { value, error });
        for x in all {
            for y in all {
                type Of<T> = fn(&T, &T) -> T;
                let operations: [(Of<Approx>, Of<f64>); 3] = [
                    (Approx::plus, |x, y| x + y),
                    (Approx::minus, |x, y| x - y),
                    (Approx::times, |x, y| x * y),
                ];
                for (rounded, exact) in operations {
                    let found = rounded(&x, &y);
                    let worst = ends(x).into_iter().flat_map(|p| ends(y).map(|q| exact(&p, &q)));
                    let worst = worst.map(|value| (value - found.value).abs()).fold(0.0, f64::max);
                    assert!(found.error >= worst, "{x:?} {y:?}: {found:?}, {worst}");
                    let most = worst + found.value.abs() * 1.1 * Approx::U + 1e-300;
                    assert!(found.error <= most * (1.0 + 1e-14), "{x:?} {y:?}: {found:?}, {worst}");
                }
            }
        }
    }

    /// The error includes roundings of the value and of the bound itself.
    #[test]
    fn roundings_are_errors() {
        let tiny = Approx::U / 2.0;
        let sum = Approx::exact(1.0).plus(&Approx::exact(tiny));
        assert!(sum.value == 1.0 && sum.error >= tiny);
        let product = Approx::exact(1.0 + f64::EPSILON).times(&Approx::exact(1.0 + f64::EPSILON));
        assert!(product.error >= f64::EPSILON * f64::EPSILON);
        assert!(Approx { value: 1.5, error: 1.0 }.plus(&Approx::exact(0.0)).error > 1.0);
        assert!(Approx::exact(1e-200).times(&Approx::exact(1e-200)).sign().is_none());
    }

    #[test]
    fn a_sign_is_returned_where_it_is_certain() {
        let sign = |value, error| Approx { value, error }.sign();
        assert_eq!(
            [sign(3.0, 2.0), sign(-3.0, 2.0)],
            [Some(Ordering::Greater), Some(Ordering::Less)]
        );
        assert_eq!([sign(2.0, 2.0), sign(-2.0, 2.0), sign(0.0, 0.0)], [None; 3]);
        assert_eq!([sign(1.0, f64::NAN), sign(f64::NAN, 1.0), sign(1.0, f64::INFINITY)], [None; 3]);
    }
}
