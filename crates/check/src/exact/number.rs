use std::cmp::Ordering;

use dashu_int::{IBig, Sign};

/// What a predicate computes with. One formula serves four kinds of number: [`Approx`] decides
/// the easy cases, [`Bits`] proves that `i128` holds the rest, and [`IBig`] holds anything.
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
