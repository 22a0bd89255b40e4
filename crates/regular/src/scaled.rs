//! Points scaled to a size for which doubles decide.

use walpha_base::parallel::prelude::*;

use crate::number::highest_bit;
use crate::{MAX_COORDINATE, MAX_WEIGHT};

/// Weighted points whose coordinates were multiplied by a power of two, so that the largest is near 1, and weights by its square.
///
/// All numbers are exact, so predicates have the same signs, and triangulations and shapes have the same simplices. But
/// polynomials of degree 8 in coordinates beyond 10³⁰, or below 10⁻³⁰, leave the range of doubles, and integers must decide: for
/// weighted lattices that takes thirty times as long.
#[derive(Debug)]
pub struct Scaled<const D: usize = 3> {
    /// The positions.
    pub positions: Vec<[f64; D]>,
    /// Their weights.
    pub weights: Vec<f64>,
    factor: f64,
}

impl<const D: usize> Scaled<D> {
    /// Coordinates up to 2 to this power, or its inverse, are not changed.
    const NEAR: i32 = 64;

    /// Scales points. `None` if they are of a usual size, or if a number is not accepted by [`Sites`](crate::Sites), would lose
    /// bits, or would exceed the range of doubles. O(n).
    pub fn of(positions: &[[f64; D]], weights: &[f64]) -> Option<Self> {
        let coordinates = positions.as_flattened();
        let largest = coordinates.par_iter().coarse().map(|x| x.abs()).reduce(|| 0.0, f64::max);
        let exponent = highest_bit(largest)?;
        let in_range = largest <= MAX_COORDINATE && weights.iter().all(|w| w.abs() <= MAX_WEIGHT);
        if exponent.abs() <= Self::NEAR || !in_range {
            return None;
        }
        // For subnormal coordinates, not all powers of two that are needed are doubles.
        let factor = 2f64.powi((-exponent).min(f64::MAX_EXP - 2));
        let scale = |x: f64| exactly(x, factor);
        let place = |p: &[f64; D]| {
            let mut scaled = *p;
            for x in &mut scaled {
                *x = scale(*x)?;
            }
            Some(scaled)
        };
        Some(Self {
            positions: positions.par_iter().coarse().map(place).collect::<Option<_>>()?,
            weights: weights
                .par_iter()
                .coarse()
                .map(|&w| square(w, factor))
                .collect::<Option<_>>()?,
            factor,
        })
    }

    /// The power of two that coordinates were multiplied by.
    pub fn factor(&self) -> f64 {
        self.factor
    }

    /// A squared length, such as α, at the same scale; `None` if it would lose bits or exceed the range of doubles. An infinite
    /// one is infinite.
    pub fn square(&self, squared: f64) -> Option<f64> {
        if squared.is_infinite() { Some(squared) } else { square(squared, self.factor) }
    }
}

/// The product with a power of two, if that is exact.
fn exactly(x: f64, factor: f64) -> Option<f64> {
    let scaled = x * factor;
    (scaled.is_finite() && scaled / factor == x).then_some(scaled)
}

fn square(squared: f64, factor: f64) -> Option<f64> {
    exactly(exactly(squared, factor)?, factor).filter(|square| square.abs() <= MAX_WEIGHT)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_scaled_without_loss_or_not_at_all() {
        let of = |x: f64, y: f64, w: f64| Scaled::of(&[[x, y, 0.0]], &[w]);
        let near = |x: f64| (0.5..1.0).contains(&x.abs());
        for (x, y, w) in [
            (-1e100, 1e80, 1e190),
            (1e-100, 3e-101, -1e-200),
            (3e150, 1.0, 0.0),
            (1e-300, 0.0, 0.0),
        ] {
            let scaled = of(x, y, w).unwrap();
            let [a, b, _] = scaled.positions[0];
            assert!(near(a), "{x}: {a}");
            let factor = a / x;
            assert_eq!(factor.log2().fract(), 0.0);
            assert_eq!((b, scaled.weights[0]), (y * factor, w * factor * factor));
            assert_eq!(scaled.square(w), Some(scaled.weights[0]));
            assert_eq!(scaled.square(f64::INFINITY), Some(f64::INFINITY));
        }
        // Usual sizes, and sizes for which bits are lost or numbers exceed the range.
        assert!(of(1000.0, 1e-9, 5.0).is_none() && of(0.0, 0.0, 1.0).is_none());
        assert!(of(1e100, 1e-310, 0.0).is_none() && of(1e100, 1.0, 1e-300).is_none());
        assert!(of(1e-100, 0.0, 1e200).is_none());
        assert_eq!(of(1e-100, 0.0, 0.0).unwrap().square(1e200), None);
        assert_eq!(of(1e100, 0.0, 0.0).unwrap().square(1e-200), None);
        // The smallest double, as large as a factor can make it.
        assert_eq!(of(5e-324, 0.0, 0.0).unwrap().positions[0][0], 2f64.powi(-52));
    }
}
