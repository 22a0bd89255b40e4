//! Double-double numbers: twice the digits of doubles, at about twenty operations each (Dekker 1971,
//! doi:10.1007/BF01397083; bounds by Joldes, Muller and Popescu 2017, doi:10.1145/3121432).

use crate::number::{Number, Scale};

/// The unevaluated sum of two doubles, the second at most half a unit in the last place of the first.
///
/// With u = 2⁻⁵³, the error of each operation is at most 8u² = 2⁻¹⁰³ times the magnitudes of its terms, unless
/// something overflows or falls below the smallest normal double.
#[derive(Clone, Copy, Debug, Default)]
pub struct Twofold {
    /// The first, the double nearest to the sum.
    pub high: f64,
    /// The second.
    pub low: f64,
}

impl Twofold {
    /// Relative error of fewer than 32 [`Number`] operations, with respect to the sum of the magnitudes of the
    /// terms: 2⁻⁹⁷, twice 32·2⁻¹⁰³.
    pub(super) const ROUNDING: f64 = 1.0 / (1u128 << 97) as f64;

    /// The exact sum of two doubles (Knuth's `TwoSum`).
    #[inline(always)]
    pub fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let of_b = high - a;
        Self { high, low: (a - (high - of_b)) + (b - of_b) }
    }

    /// The exact product of two doubles (Dekker's): not every processor has fused multiplication and addition.
    #[inline(always)]
    pub fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        let ((a, a_low), (b, b_low)) = (halves(a), halves(b));
        let low = a_low * b_low - (((high - a * b) - a_low * b) - a * b_low);
        Self { high, low }
    }

    /// The quotient, with a relative error below 2⁻⁹⁸.
    #[inline(always)]
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        let quotient = self.high / other.high;
        let product = Self::product(quotient, other.high);
        let rest = ((self.high - product.high) - product.low) + (self.low - quotient * other.low);
        Self::sum(quotient, rest / other.high)
    }

    /// The double nearest to every number that differs from this one by at most `error`; `None` if these have different nearest
    /// doubles.
    #[inline(always)]
    pub(super) fn nearest(self, error: f64) -> Option<f64> {
        let error = error * (1.0 + 1e-9) + self.low.abs() * f64::EPSILON;
        let [low, high] = [self.low - error, self.low + error].map(|rest| self.high + rest);
        (low == high).then_some(low)
    }
}

/// Splits a double into the sum of two with half the digits each (Veltkamp).
#[inline(always)]
fn halves(value: f64) -> (f64, f64) {
    // 2²⁷ + 1: half of 53 bits, rounded up.
    const SPLIT: f64 = ((1u64 << 27) + 1) as f64;
    let scaled = SPLIT * value;
    let high = scaled - (scaled - value);
    (high, value - high)
}

impl Number for Twofold {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        let sum = Self::sum(self.high, other.high);
        Self::sum(sum.high, sum.low + (self.low + other.low))
    }

    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        self.plus(&Self { high: -other.high, low: -other.low })
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let product = Self::product(self.high, other.high);
        let rest = self.high * other.low + self.low * other.high;
        Self::sum(product.high, product.low + rest)
    }
}

/// Multiplication by a double of at most 26 bits, which need not be split.
impl Scale<f64> for Twofold {
    #[inline(always)]
    fn scaled(&self, factor: &f64) -> Self {
        let high = self.high * factor;
        let (upper, lower) = halves(self.high);
        let low = (upper * factor - high) + lower * factor;
        Self::sum(high, low + self.low * factor)
    }
}

#[cfg(test)]
mod tests {
    use dashu_int::IBig;

    use super::*;
    use crate::number::integer;

    /// The number in units of 2⁻²⁰⁰.
    fn exactly(number: Twofold) -> IBig {
        integer(number.high, -200) + integer(number.low, -200)
    }

    #[test]
    fn operations_keep_twice_the_digits() {
        let numbers = [1.0 / 3.0, -0.7, 1e10 / 7.0, 1e-9 / 3.0, -3.0, 0.1];
        let twofold = |i: usize| Twofold::sum(numbers[i], numbers[(i + 1) % 6] * 2f64.powi(-54));
        for (a, b) in (0..36).map(|i| (twofold(i / 6), twofold(i % 6))) {
            let (x, y) = (exactly(a), exactly(b));
            let close = |got: IBig, wanted: IBig, terms: IBig| {
                let off = if got > wanted { &got - &wanted } else { &wanted - &got };
                assert!(off << 103 <= terms, "{got} {wanted}");
            };
            let size = |n: &IBig| if *n < IBig::ZERO { -n } else { n.clone() };
            close(exactly(a.plus(&b)), &x + &y, size(&x) + size(&y));
            close(exactly(a.minus(&b)), &x - &y, size(&x) + size(&y));
            let product = (&x * &y) >> 200;
            close(exactly(a.times(&b)), product.clone(), size(&product));
            let short = f64::from(b.high as f32);
            let product = (&x * integer(short, -200)) >> 200;
            close(exactly(a.scaled(&short)), product.clone(), size(&product));
            let quotient = (&x << 200) / &y;
            close(exactly(a.over(b)) >> 6, quotient.clone() >> 6, size(&quotient));
        }
    }

    #[test]
    fn what_is_between_two_doubles_has_no_nearest() {
        let one = Twofold { high: 1.0, low: 0.0 };
        assert_eq!(one.nearest(1e-30), Some(1.0));
        let half = Twofold { high: 1.0, low: f64::EPSILON / 2.0 };
        assert_eq!(half.nearest(1e-30), None);
        let more = Twofold { high: 1.0, low: f64::EPSILON / 2.0 * 1.001 };
        assert_eq!(more.nearest(1e-30), Some(1.0 + f64::EPSILON));
    }
}
