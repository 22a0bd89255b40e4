//! Squared radii as numbers: the nearest double, and the exact number if two have the same nearest double.

use super::formulas::{Ray, Solution, quotient};
use super::size::{Size, View};
use super::twofold::Twofold;
use super::{Predicates, Ratio, Site, centred, close, exact};
use crate::number::{Number, dot};

/// A squared radius on a lattice, exactly: numerator / (4 denominator) in squares of the step, less the weight.
#[derive(Clone, Copy, Debug)]
pub struct SmallRadius {
    numerator: i64,
    denominator: i64,
    weight: f64,
}

impl SmallRadius {
    /// Whether two numbers are known to be equal. Equal numbers with different weights may give `false`.
    pub fn equals(self, other: Self) -> bool {
        let product = |a: i64, b: i64| i128::from(a) * i128::from(b);
        self.weight == other.weight
            && product(self.numerator, other.denominator)
                == product(other.numerator, self.denominator)
    }
}

impl Predicates<'_> {
    /// The double nearest to the squared radius of the smallest orthogonal sphere; of two equally near ones the even one. Never
    /// −0.
    ///
    /// If a lattice makes numerator and denominator exact, this takes one division. Otherwise an approximate centre is corrected,
    /// or for flat simplices numbers have twice the digits of doubles (only powers do if a lattice makes vectors exact). Integers
    /// decide values that are too near to the midpoint of two doubles for that.
    pub fn nearest_radius<const N: usize>(&self, simplex: [u32; N]) -> f64 {
        let sites = self.sites(simplex);
        let View { rays, size } = View::<N>::of(sites[0], sites);
        self.radius(simplex, &sites, &rays, size, &Solution::of(&rays[1..]))
    }

    /// [`Self::nearest_radius`] of a simplex with these corners, as seen from the first one.
    #[inline(always)]
    pub(super) fn radius<const N: usize>(
        &self,
        simplex: [u32; N],
        sites: &[Site; N],
        rays: &[Ray<f64>; N],
        size: Size,
        solution: &Solution,
    ) -> f64 {
        let weight = sites[0].weight;
        if N == 1 {
            return 0.0 - weight;
        }
        let bounds = size.bounds(N);
        let terms = bounds.numerator + 4.0 * weight.abs() * bounds.denominator;
        if self.lattice.holds_weights && self.holds(terms, 2 * N) {
            let (numerator, denominator) = solution.quotient(&rays[1..]);
            // Simplices of a triangulation are not degenerate, so the exact denominator is not 0.
            return (numerator - 4.0 * weight * denominator) / (4.0 * denominator) + 0.0;
        }
        let sane = size.is_sane() && weight.abs() < Size::LARGEST_SQUARE;
        if sane && let Some(nearest) = centred::nearest(sites, rays, size, solution) {
            return nearest;
        }
        self.nearest_radius_closely(simplex)
    }

    /// [`Self::nearest_radius`], where no corrected centre determines it.
    #[cold]
    fn nearest_radius_closely<const N: usize>(&self, simplex: [u32; N]) -> f64 {
        let sites = self.sites(simplex);
        let View { rays, size } = View::<N>::of(sites[0], sites);
        let bounds = size.bounds(N);
        let weight = sites[0].weight;
        let rounded = if !(size.is_sane() && weight.abs() < Size::LARGEST_SQUARE) {
            None
        } else if self.holds_vectors(size, N) {
            let (numerator, denominator) = quotient(&lattice_rays(sites, rays)[1..]);
            let denominator = Twofold { high: denominator, low: 0.0 };
            rounded(numerator, denominator, bounds.numerator, 0.0, weight)
        } else {
            let (numerator, denominator) = quotient(&close::rays(sites[0], &sites)[1..]);
            rounded(numerator, denominator, bounds.numerator, bounds.denominator, weight)
        };
        rounded.unwrap_or_else(|| self.exact_radius(simplex).nearest())
    }

    /// Whether the vectors of a simplex with this many vertices and the denominator of its squared radius are exact in
    /// doubles, and products of two lengths have at most 26 bits.
    #[inline(always)]
    fn holds_vectors(&self, size: Size, vertices: usize) -> bool {
        // Factors of `Twofold` by `Scale<f64>` have at most 26 bits.
        const MAX_FACTOR: f64 = (1u64 << 26) as f64;
        let step = self.lattice.step;
        3.0 * size.length * size.length <= MAX_FACTOR * (step * step)
            && self.holds(size.bounds(vertices).denominator, 2 * vertices - 2)
    }

    /// The exact squared radius of the smallest orthogonal sphere, in integers of arbitrary length.
    pub fn exact_radius<const N: usize>(&self, simplex: [u32; N]) -> Ratio {
        exact::squared_radius(self.sites(simplex))
    }

    /// The squared radius of the smallest orthogonal sphere as a ratio of 64-bit integers, if a lattice allows that.
    pub fn small_radius<const N: usize>(&self, simplex: [u32; N]) -> Option<SmallRadius> {
        let sites = self.sites(simplex);
        let weight = sites[0].weight;
        if N == 1 {
            return Some(SmallRadius { numerator: 0, denominator: 1, weight });
        }
        let equal_weights = sites.iter().all(|site| site.weight == weight);
        if !(equal_weights || self.lattice.holds_weights) {
            return None;
        }
        let View { rays, size } = View::<N>::of(sites[0], sites);
        let bounds = size.bounds(N);
        if !(self.holds(bounds.numerator, 2 * N) && self.holds(bounds.denominator, 2 * N - 2)) {
            return None;
        }
        let (numerator, denominator) = quotient(&rays[1..]);
        let steps = |value: f64, degree: usize| {
            // Division by a power of two is exact.
            (value / self.lattice.step.powi(degree as i32)) as i64
        };
        let terms = bounds.numerator + 4.0 * weight.abs() * bounds.denominator;
        let folded = self.lattice.holds_weights && self.holds(terms, 2 * N);
        let (numerator, weight) = if folded {
            (numerator - 4.0 * weight * denominator, 0.0)
        } else {
            (numerator, weight)
        };
        Some(SmallRadius {
            numerator: steps(numerator, 2 * N),
            denominator: steps(denominator, 2 * N - 2),
            weight,
        })
    }
}

/// The double nearest to numerator / (4 denominator) − weight, if the error bounds determine it. `above` and `below` are
/// the sums of the magnitudes of the terms of numerator and denominator.
#[inline(always)]
fn rounded(
    numerator: Twofold,
    denominator: Twofold,
    above: f64,
    below: f64,
    weight: f64,
) -> Option<f64> {
    let (above, below) = (above * Twofold::ROUNDING, below * Twofold::ROUNDING);
    let d = denominator.high;
    if d <= 4.0 * below {
        return None;
    }
    let fourth = numerator.over(denominator);
    let quotient = Twofold { high: fourth.high / 4.0, low: fourth.low / 4.0 };
    let radius = Twofold::sum(quotient.high, -weight);
    let radius = Twofold::sum(radius.high, radius.low + quotient.low);
    // |n/d − ñ/d̃| ≤ (e_n + (ñ/d̃) e_d) / (d̃ − e_d); then the division and the difference.
    let error = (above + 4.0 * quotient.high.abs() * below) / (4.0 * (d - 2.0 * below))
        + Twofold::ROUNDING * (quotient.high.abs() + weight.abs());
    radius.nearest(error).map(|radius| radius + 0.0)
}

/// Rays with exact vectors in doubles, and powers with twice the digits.
#[inline(always)]
fn lattice_rays<const N: usize>(sites: [Site; N], rays: [Ray<f64>; N]) -> [Ray<Twofold, f64>; N] {
    let mut exact = [Ray { power: Twofold::sum(0.0, 0.0), vector: [0.0; 3] }; N];
    for ((to, ray), q) in exact.iter_mut().zip(&rays).zip(sites) {
        let heavier = Twofold::sum(sites[0].weight, -q.weight);
        let square = Twofold { high: dot(&ray.vector, &ray.vector), low: 0.0 };
        *to = Ray { power: square.plus(&heavier), vector: ray.vector };
    }
    exact
}
