//! Squared radii as numbers: the nearest double, and the exact number where that does not distinguish two
//! apart.

use super::formulas::{Ray, quotient};
use super::size::{Size, View};
use super::twofold::Twofold;
use super::{Predicates, Ratio, Site, exact};
use crate::number::{Number, dot};

/// A squared radius on a lattice: numerator / 4 denominator, in squares of its step, less a weight.
#[derive(Clone, Copy, Debug)]
pub struct Small {
    numerator: i64,
    denominator: i64,
    weight: f64,
}

impl Small {
    /// Whether two are surely the same number. Two that are the same may say no where they have
    /// different weights.
    pub fn equals(self, other: Self) -> bool {
        let product = |a: i64, b: i64| i128::from(a) * i128::from(b);
        self.weight == other.weight
            && product(self.numerator, other.denominator)
                == product(other.numerator, self.denominator)
    }
}

impl Predicates<'_> {
    /// The double nearest to the squared radius of the smallest orthogonal sphere, of two the one
    /// whose last digit is even. Never −0.
    ///
    /// By one division where a lattice makes numerator and denominator exact, else by twice the digits
    /// of doubles, of powers alone where a lattice makes vectors exact; what lies too near to the middle
    /// of two doubles for that, by integers.
    pub fn nearest_radius<const N: usize>(&self, simplex: [u32; N]) -> f64 {
        let sites = self.sites(simplex);
        if N == 1 {
            return 0.0 - sites[0].weight;
        }
        let View { rays, size } = View::<N>::of(sites[0], sites);
        let bounds = size.bounds(N);
        let weight = sites[0].weight;
        let terms = bounds.numerator + 4.0 * weight.abs() * bounds.denominator;
        if self.lattice.holds_weights && self.holds(terms, 2 * N) {
            let (numerator, denominator) = quotient(&rays[1..]);
            // A face of a lattice's triangulation is not flat: its denominator is not 0.
            return (numerator - 4.0 * weight * denominator) / (4.0 * denominator) + 0.0;
        }
        let rounded = if !(size.is_sane() && weight.abs() < 1e60) {
            None
        } else if self.holds_vectors(size, N) {
            let (numerator, denominator) = quotient(&lattice_rays(sites, rays)[1..]);
            let denominator = Twofold { high: denominator, low: 0.0 };
            rounded(numerator, denominator, bounds.numerator, 0.0, weight)
        } else {
            let (numerator, denominator) = quotient(&twofold_rays(sites)[1..]);
            rounded(numerator, denominator, bounds.numerator, bounds.denominator, weight)
        };
        rounded.unwrap_or_else(|| self.exact_radius(simplex).nearest())
    }

    /// Whether the vectors of so many vertices, and what a radius needs of them without weights, are exact
    /// in doubles, and products of two lengths have at most 26 digits.
    #[inline(always)]
    fn holds_vectors(&self, size: Size, vertices: usize) -> bool {
        const DIGITS: f64 = (1u64 << 26) as f64;
        let step = self.lattice.step;
        3.0 * size.length * size.length <= DIGITS * (step * step)
            && self.holds(size.bounds(vertices).denominator, 2 * vertices - 2)
    }

    /// The squared radius of the smallest orthogonal sphere, exactly. By integers of any length.
    pub fn exact_radius<const N: usize>(&self, simplex: [u32; N]) -> Ratio {
        exact::squared_radius(self.sites(simplex))
    }

    /// The same in small integers, where a lattice has them.
    pub fn small_radius<const N: usize>(&self, simplex: [u32; N]) -> Option<Small> {
        let sites = self.sites(simplex);
        let weight = sites[0].weight;
        if N == 1 {
            return Some(Small { numerator: 0, denominator: 1, weight });
        }
        let alike = sites.iter().all(|site| site.weight == weight);
        if !(alike || self.lattice.holds_weights) {
            return None;
        }
        let View { rays, size } = View::<N>::of(sites[0], sites);
        let bounds = size.bounds(N);
        if !(self.holds(bounds.numerator, 2 * N) && self.holds(bounds.denominator, 2 * N - 2)) {
            return None;
        }
        let (numerator, denominator) = quotient(&rays[1..]);
        let steps = |value: f64, degree: usize| {
            // A power of two: nothing is rounded.
            (value / self.lattice.step.powi(degree as i32)) as i64
        };
        let terms = bounds.numerator + 4.0 * weight.abs() * bounds.denominator;
        let folded = self.lattice.holds_weights && self.holds(terms, 2 * N);
        let (numerator, weight) = if folded {
            (numerator - 4.0 * weight * denominator, 0.0)
        } else {
            (numerator, weight)
        };
        Some(Small {
            numerator: steps(numerator, 2 * N),
            denominator: steps(denominator, 2 * N - 2),
            weight,
        })
    }
}

/// The double nearest to numerator / 4 denominator − weight, if it is certain, from the sums of magnitudes
/// of the terms of both.
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

/// Of the rays in doubles, whose vectors are exact, those with exact powers, too.
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

#[inline(always)]
fn twofold_rays<const N: usize>(sites: [Site; N]) -> [Ray<Twofold>; N] {
    let p = sites[0];
    sites.map(|q| {
        let vector = [0, 1, 2].map(|k| Twofold::sum(q.position[k], -p.position[k]));
        let heavier = Twofold::sum(p.weight, -q.weight);
        Ray { power: dot(&vector, &vector).plus(&heavier), vector }
    })
}
