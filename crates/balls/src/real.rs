//! Numbers with a bound on their error, for formulas that are written once: in doubles and in numbers of two doubles.
//!
//! A number stands for an unknown real number, which differs from its value by at most its error. Operations compute the value in
//! floating-point arithmetic, and the error from the errors of the operands and the rounding of the operation (running error analysis:
//! Higham 2002, doi:10.1137/1.9780898718027, section 3.3). `docs/balls.md` proves the model: in short, errors are sums and products of
//! numbers that are not negative, so that a chain of 2³⁰ operations rounds them by less than one part in 2²⁰, and
//! [`Real::bounded`] adds that once. It takes nothing of the mathematical library: square roots are those of IEEE 754, and
//! the angle is computed here.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use walpha_base::vector::V3;
use walpha_regular::internals::Twofold;
use walpha_regular::internals::number::Number;

/// A number with a bound on its error: the true number, of the input doubles, is within `bound` of `value`.
///
/// The bound is infinite where nothing is known, as for numbers that pass the range of doubles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounded {
    /// The value, a double near the true number.
    pub value: f64,
    /// How far the true number may be from it, in the same unit.
    pub bound: f64,
}

impl Bounded {
    /// The relative bound that totals are expected to keep: 10⁻⁹.
    pub const RELATIVE: f64 = 1e-9;

    /// Whether a number may be the true one.
    pub fn contains(self, number: f64) -> bool {
        (number - self.value).abs() <= self.bound
    }

    /// Whether the bound is at most a part of the value, such as [`Self::RELATIVE`].
    pub fn is_within(self, part: f64) -> bool {
        self.bound <= part * self.value.abs()
    }

    /// The product with a power of two.
    pub(crate) fn scaled(self, factor: f64) -> Self {
        if factor == 1.0 {
            return self;
        }
        // Exact, unless it falls below the normal doubles.
        Self { value: self.value * factor, bound: (self.bound * factor).next_up() }
    }
}

/// The way from one place to another.
pub(crate) type Ray<N> = [<N as Real>::Coordinate; 3];

/// A number with a bound on its error, and the arithmetic of formulas.
pub(crate) trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A coordinate of a difference of two places.
    type Coordinate: Copy;

    /// The way from one place to another.
    fn ray(from: V3, to: V3) -> Ray<Self>;
    /// A coordinate of a way.
    fn along(coordinate: Self::Coordinate) -> Self;
    /// The inner product.
    fn dot(a: Ray<Self>, b: Ray<Self>) -> Self;
    /// The squared length.
    fn squared(a: Ray<Self>) -> Self;
    /// The cross product.
    fn cross(a: Ray<Self>, b: Ray<Self>) -> [Self; 3];
    /// The inner product of a cross product and a way.
    fn triple(normal: [Self; 3], a: Ray<Self>) -> Self;
    /// The squared length of a cross product.
    fn squared_normal(normal: [Self; 3]) -> Self;
    /// The sum of two doubles.
    fn sum(a: f64, b: f64) -> Self;
    /// π.
    fn pi() -> Self;
    /// The product with a power of two.
    fn times(self, power_of_two: f64) -> Self;
    /// The square root of a number that is known not to be negative.
    fn sqrt(self) -> Self;
    /// The angle from 0 to π between the first axis and the direction (x, y), for y known not to be negative. Where both may be 0, the angle
    /// is any in this range.
    fn angle(y: Self, x: Self) -> Self;
    /// The value, with the error as far as it has been computed.
    fn rounded(self) -> Single;

    /// A double.
    fn exact(x: f64) -> Self {
        Self::sum(x, 0.0)
    }

    fn half(self) -> Self {
        self.times(0.5)
    }

    fn square(self) -> Self {
        self * self
    }
}

/// 2⁻⁵³: a double differs from the number that it was rounded from by at most this part of either.
pub(crate) const U: f64 = f64::EPSILON / 2.0;

/// More than products and quotients lose that fall below the normal doubles.
const TINY: f64 = f64::MIN_POSITIVE;

/// A double and a bound on its error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Single {
    pub value: f64,
    pub error: f64,
}

impl Single {
    pub(crate) const ZERO: Self = Self { value: 0.0, error: 0.0 };

    /// A number of which nothing is known but that it lies between 0 and this.
    pub(crate) fn up_to(most: f64) -> Self {
        Self { value: most / 2.0, error: most * (0.5 + U) }
    }

    /// The number with the bound that is certain, roundings of errors included.
    pub(crate) fn bounded(self) -> Bounded {
        /// 1 + 2⁻²⁰.
        const INFLATED: f64 = 1.0 + 1.0 / (1 << 20) as f64;
        let bound = self.error * INFLATED;
        // NaN is no bound.
        let known = self.value.is_finite() && bound.is_finite();
        Bounded { value: self.value, bound: if known { bound } else { f64::INFINITY } }
    }

    /// Whether the error is certain to be at most this.
    #[inline(always)]
    pub(crate) fn is_within(self, error: f64) -> bool {
        self.error <= error
    }
}

impl Add for Single {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let value = self.value + other.value;
        Self { value, error: self.error + other.error + U * value.abs() }
    }
}

impl AddAssign for Single {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Neg for Single {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl Sub for Single {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Single {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.value.abs() * other.error + self.error * (other.value.abs() + other.error);
        Self { value, error: error + (U * value.abs() + TINY) }
    }
}

/// The error of a quotient, before rounding: the dividend's error and the quotient times that of the divisor, divided by the least magnitude
/// of the divisor. Infinite unless the divisor's error is at most half of it, so that the rounding of errors stays small.
#[inline(always)]
fn error_of_quotient(error: f64, quotient: f64, of_divisor: f64, divisor: f64) -> f64 {
    let least = divisor.abs() - of_divisor;
    if of_divisor <= least { (error + quotient.abs() * of_divisor) / least } else { f64::INFINITY }
}

impl Div for Single {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let error = error_of_quotient(self.error, value, other.error, other.value);
        Self { value, error: error + (U * value.abs() + TINY) }
    }
}

/// Errors of vectors, each rounding counted with the magnitude of its term and rounded up to a whole number of u. Differences of coordinates
/// err by u.
impl Real for Single {
    type Coordinate = f64;

    #[inline(always)]
    fn ray(from: V3, to: V3) -> Ray<Self> {
        [to[0] - from[0], to[1] - from[1], to[2] - from[2]]
    }

    #[inline(always)]
    fn along(coordinate: f64) -> Self {
        Self { value: coordinate, error: U * coordinate.abs() }
    }

    #[inline(always)]
    fn dot(a: Ray<Self>, b: Ray<Self>) -> Self {
        let [x, y, z] = [a[0] * b[0], a[1] * b[1], a[2] * b[2]];
        // Two differences, a product, two sums.
        Self { value: x + y + z, error: 6.0 * U * (x.abs() + y.abs() + z.abs()) + 4.0 * TINY }
    }

    #[inline(always)]
    fn squared(a: Ray<Self>) -> Self {
        let value = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
        Self { value, error: 6.0 * U * value + 4.0 * TINY }
    }

    #[inline(always)]
    fn cross(a: Ray<Self>, b: Ray<Self>) -> [Self; 3] {
        let minor = |i: usize, j: usize| {
            let (p, q) = (a[i] * b[j], a[j] * b[i]);
            // Two differences, a product, a sum.
            Self { value: p - q, error: 5.0 * U * (p.abs() + q.abs()) + 4.0 * TINY }
        };
        [minor(1, 2), minor(2, 0), minor(0, 1)]
    }

    #[inline(always)]
    fn triple(n: [Self; 3], a: Ray<Self>) -> Self {
        let value = n[0].value * a[0] + n[1].value * a[1] + n[2].value * a[2];
        // A difference, a product, two sums.
        let error = |k: usize| a[k].abs() * (n[k].error + 5.0 * U * n[k].value.abs());
        Self { value, error: error(0) + error(1) + error(2) + 4.0 * TINY }
    }

    #[inline(always)]
    fn squared_normal(n: [Self; 3]) -> Self {
        let value = n[0].value * n[0].value + n[1].value * n[1].value + n[2].value * n[2].value;
        // A product and two sums.
        let error = |k: usize| n[k].error * (2.0 * n[k].value.abs() + n[k].error);
        let error = error(0) + error(1) + error(2);
        Self { value, error: error + (4.0 * U * value + 4.0 * TINY) }
    }

    #[inline(always)]
    fn sum(a: f64, b: f64) -> Self {
        let value = a + b;
        // Of one number and 0 the sum is exact.
        let error = if b == 0.0 { 0.0 } else { U * value.abs() };
        Self { value, error }
    }

    #[inline(always)]
    fn pi() -> Self {
        Self { value: std::f64::consts::PI, error: 1.3e-16 }
    }

    #[inline(always)]
    fn times(self, power_of_two: f64) -> Self {
        let lost = if power_of_two.abs() < 1.0 { TINY } else { 0.0 };
        Self { value: self.value * power_of_two, error: self.error * power_of_two.abs() + lost }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // With r = √v: |√t − r| = |t − v| / (√t + r) ≤ e/r.
        if self.error <= self.value {
            let value = self.value.sqrt();
            if value == 0.0 {
                return Self::ZERO;
            }
            Self { value, error: self.error / value + U * value }
        } else {
            Self::up_to((self.value.max(0.0) + self.error).sqrt())
        }
    }

    #[inline(always)]
    fn angle(y: Self, x: Self) -> Self {
        let y = Self { value: y.value.max(0.0), ..y };
        let spread = spread([y, x]);
        if spread >= std::f64::consts::PI {
            return Self::up_to(std::f64::consts::PI);
        }
        let value = angle::of(y.value, x.value);
        Self { value, error: spread + (angle::ROUNDING * value + TINY) }
    }

    #[inline(always)]
    fn rounded(self) -> Single {
        self
    }
}

/// How much the direction of a point changes within its error; at least π where it may be any. With r the distance from 0 and s the sum of
/// the errors a of x and b of y, all points within the errors are at least r − s away, and the angle changes by at most
/// (|x| b + |y| a + 2 a b) / (r − s)².
#[inline(always)]
fn spread([y, x]: [Single; 2]) -> f64 {
    let squared = x.value * x.value + y.value * y.value;
    let errors = x.error + y.error;
    let change = x.value.abs() * y.error + y.value.abs() * x.error + 2.0 * x.error * y.error;
    if !(TINY..f64::MAX).contains(&squared) {
        return f64::INFINITY;
    }
    // Roundings are far smaller than what 1.003 and 4.1 leave.
    if errors * errors * 1e6 <= squared {
        1.003 * change / squared
    } else if errors * errors * 4.1 <= squared {
        4.1 * change / squared
    } else {
        f64::INFINITY
    }
}

/// Two doubles and a bound on the error of their sum.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Double {
    value: Twofold,
    error: f64,
}

/// 8u²: what an operation on numbers of two doubles rounds by at most, relative to its terms; u = 2⁻⁵³.
const UU: f64 = 8.0 * U * U;

/// More than is lost where the lower halves fall below the normal doubles.
const TINY_HALF: f64 = f64::MIN_POSITIVE / U;

impl Double {
    /// A volume, given six times the volume; exactly 0 where nothing has been summed.
    pub(crate) fn sixth(self) -> Single {
        if self.value.high == 0.0 && self.error == 0.0 {
            return Single::ZERO;
        }
        (self / Self::exact(6.0)).rounded()
    }
}

impl From<Single> for Double {
    fn from(number: Single) -> Self {
        Self { value: Twofold { high: number.value, low: 0.0 }, error: number.error }
    }
}

impl Add for Double {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let rounding = UU * (self.value.high.abs() + other.value.high.abs());
        Self { value: self.value.plus(&other.value), error: self.error + other.error + rounding }
    }
}

impl AddAssign<Single> for Double {
    #[inline(always)]
    fn add_assign(&mut self, other: Single) {
        *self = *self + Self::from(other);
    }
}

impl AddAssign for Double {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Neg for Double {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let Twofold { high, low } = self.value;
        Self { value: Twofold { high: -high, low: -low }, ..self }
    }
}

impl Sub for Double {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let value = Number::times(&self.value, &other.value);
        let [a, b] = [self, other].map(|number| number.value.high.abs());
        let error = (a * other.error + self.error * (b + other.error)) * (1.0 + 2.0 * U);
        Self { value, error: error + (UU * value.high.abs() * (1.0 + 4.0 * U) + TINY_HALF) }
    }
}

impl Div for Double {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        /// 2⁻⁹⁸.
        const ROUNDING: f64 = 32.0 * UU;
        let value = self.value.over(other.value);
        let error = error_of_quotient(self.error, value.high, other.error, other.value.high);
        let error = error * (1.0 + 16.0 * U);
        Self { value, error: error + (ROUNDING * value.high.abs() * (1.0 + 4.0 * U) + TINY_HALF) }
    }
}

/// Differences of coordinates are exact.
impl Real for Double {
    type Coordinate = Self;

    fn ray(from: V3, to: V3) -> Ray<Self> {
        [0, 1, 2].map(|k| Self::sum(to[k], -from[k]))
    }

    fn along(coordinate: Self) -> Self {
        coordinate
    }

    fn dot(a: Ray<Self>, b: Ray<Self>) -> Self {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    fn squared(a: Ray<Self>) -> Self {
        Self::dot(a, a)
    }

    fn cross(a: Ray<Self>, b: Ray<Self>) -> [Self; 3] {
        let minor = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
        [minor(1, 2), minor(2, 0), minor(0, 1)]
    }

    fn triple(normal: [Self; 3], a: Ray<Self>) -> Self {
        Self::dot(normal, a)
    }

    fn squared_normal(normal: [Self; 3]) -> Self {
        Self::dot(normal, normal)
    }

    #[inline(always)]
    fn sum(a: f64, b: f64) -> Self {
        Self { value: Twofold::sum(a, b), error: 0.0 }
    }

    #[inline(always)]
    fn pi() -> Self {
        Self { value: angle::PI, error: 1e-32 }
    }

    #[inline(always)]
    fn times(self, power_of_two: f64) -> Self {
        let Twofold { high, low } = self.value;
        let value = Twofold { high: high * power_of_two, low: low * power_of_two };
        let lost = if power_of_two.abs() < 1.0 { TINY_HALF } else { 0.0 };
        Self { value, error: self.error * power_of_two.abs() + lost }
    }

    fn sqrt(self) -> Self {
        /// Of one step of Newton's from the root in doubles, with the last product exact: below 2⁻¹⁰⁰.
        const ROUNDING: f64 = 8.0 * UU;
        let Twofold { high, low } = self.value;
        if high > 0.0 && self.error <= high * 0.5 {
            let root = high.sqrt();
            let square = Twofold::product(root, root);
            let rest = ((high - square.high) - square.low) + low;
            let value = Twofold::sum(root, rest / (2.0 * root));
            Self { value, error: self.error / root * (1.0 + 4.0 * U) + ROUNDING * root + TINY_HALF }
        } else {
            let most = ((high.max(0.0) + self.error) * (1.0 + 4.0 * U)).sqrt();
            Single::up_to(most * (1.0 + 4.0 * U)).into()
        }
    }

    fn angle(y: Self, x: Self) -> Self {
        if y.value.high.is_nan() || y.value.high <= 0.0 {
            // The first coordinate decides between 0 and π, and the error of the other what is between.
            let y = Single { value: 0.0, error: y.error };
            let x = x.rounded();
            return Single::angle(y, x).into();
        }
        let half = |number: Self| Single { value: number.value.high, error: number.error };
        let spread = spread([half(y), half(x)]) * (1.0 + 8.0 * U);
        if spread >= std::f64::consts::PI {
            return Single::up_to(std::f64::consts::PI).into();
        }
        let value = angle::of_twofold(y.value, x.value);
        Self { value, error: spread + (angle::ROUNDING_OF_TWOFOLD * value.high + TINY_HALF) }
    }

    #[inline(always)]
    fn rounded(self) -> Single {
        Single { value: self.value.high, error: self.error + self.value.low.abs() }
    }
}

mod angle;

#[cfg(test)]
mod tests;
