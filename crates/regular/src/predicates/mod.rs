//! Exact answers to every geometric question that a regular triangulation and an α-complex are made
//! of: orientation, power test, radius of the smallest orthogonal sphere, and whether it is empty.
//!
//! Each answer is the sign of a polynomial. It is computed in doubles and believed when it passes a
//! forward error bound, or when the arithmetic was exact because all numbers are small multiples of
//! a power of two, as on voxel grids. Otherwise integers decide.

mod exact;
mod formulas;
mod nearest;
mod ratio;
mod screen;
mod size;
mod twofold;

use std::cmp::Ordering;

use formulas::{determinant, power_determinant, quotient, side};
pub use nearest::Small as SmallRadius;
pub use ratio::Ratio;
pub use screen::Screen;
use size::{Size, View, ray};

use super::Torus;
use crate::Lattice;

/// A weighted point.
#[derive(Clone, Copy)]
pub(crate) struct Site {
    position: [f64; 3],
    weight: f64,
}

/// Doubles around a number: `low` ≤ it ≤ `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Not above the number.
    pub low: f64,
    /// Not below it.
    pub high: f64,
}

impl Interval {
    /// Around a number of which this is the nearest double.
    pub fn around(nearest: f64) -> Self {
        Self { low: nearest.next_down(), high: nearest.next_up() }
    }
}

/// Weighted points, asked about by index.
pub struct Predicates<'a> {
    positions: &'a [[f64; 3]],
    weights: &'a [f64],
    lattice: Lattice,
    /// Below these, polynomials of degree 1 to 8 in coordinates are exact in doubles; 0 off a
    /// lattice.
    exact: [f64; 8],
    /// Where points stand for all their copies: a simplex is made of those nearest to its first corner.
    torus: Option<Torus>,
}

/// Every number is the result of fewer than 32 roundings, so a polynomial is off by less than 2⁻⁴⁸
/// of the sum of the magnitudes of its terms.
const ROUNDING: f64 = 1.0 / (1u64 << 48) as f64;

impl<'a> Predicates<'a> {
    /// Looks for what the numbers have in common. O(n).
    pub fn new(positions: &'a [[f64; 3]], weights: &'a [f64]) -> Self {
        Self::on(Lattice::of(positions, weights), positions, weights)
    }

    /// The same, where a lattice of all numbers is known.
    pub fn on(lattice: Lattice, positions: &'a [[f64; 3]], weights: &'a [f64]) -> Self {
        let most = (1u64 << 53) as f64;
        let exact = [1, 2, 3, 4, 5, 6, 7, 8].map(|degree| most * lattice.step.powi(degree));
        Self { positions, weights, lattice, exact, torus: None }
    }

    /// Looks for what the numbers of points of a torus have in common. Corners of a simplex, and what is
    /// asked about beside it, must each be nearer to its first corner than half a side. O(n).
    pub fn on_torus(positions: &'a [[f64; 3]], weights: &'a [f64], torus: Option<Torus>) -> Self {
        let lattice = lattice(positions, weights, torus);
        Self { torus, ..Self::on(lattice, positions, weights) }
    }

    #[inline(always)]
    fn site(&self, v: u32) -> Site {
        Site { position: self.positions[v as usize], weight: self.weights[v as usize] }
    }

    #[inline(always)]
    fn sites<const N: usize>(&self, simplex: [u32; N]) -> [Site; N] {
        let mut sites = [Site { position: [0.0; 3], weight: 0.0 }; N];
        for (site, v) in sites.iter_mut().zip(simplex) {
            *site = self.site(v);
        }
        if let Some(torus) = &self.torus {
            let first = sites[0].position;
            sites.iter_mut().for_each(|site| site.position = torus.near(first, site.position));
        }
        sites
    }

    /// A point beside a simplex.
    #[inline(always)]
    fn nearest_copy(&self, p: Site, v: u32) -> Site {
        let site = self.site(v);
        match &self.torus {
            None => site,
            Some(torus) => Site { position: torus.near(p.position, site.position), ..site },
        }
    }

    /// The squared radius of the smallest orthogonal sphere of a simplex: α at which it fits.
    #[inline]
    pub fn squared_radius<const N: usize>(&self, simplex: [u32; N]) -> Interval {
        let p = self.site(simplex[0]);
        if N == 1 {
            return Interval { low: -p.weight, high: -p.weight };
        }
        let View { rays, size } = View::<N>::of(p, self.sites(simplex));
        let (numerator, denominator) = quotient(&rays[1..]);
        let bounds = size.bounds(N);
        let error = |bound: f64, degree: usize, exact: bool| {
            if exact && self.holds(bound, degree) { 0.0 } else { bound * ROUNDING }
        };
        let above = error(bounds.numerator, 2 * N, self.lattice.holds_weights);
        let below = error(bounds.denominator, 2 * N - 2, true);
        if !(size.is_sane() && denominator > 2.0 * below) {
            let high = self.first_alpha(simplex);
            return Interval { low: high.next_down(), high };
        }
        let quotient = numerator / (4.0 * denominator);
        let radius = quotient - p.weight;
        // |n/d − ñ/d̃| ≤ (e_n + (ñ/d̃) e_d) / (d̃ − e_d); then the division and the difference.
        let error = (above + 4.0 * quotient * below) / (4.0 * (denominator - below))
            + f64::EPSILON * (quotient + radius.abs());
        let error = error * (1.0 + 1e-9);
        Interval { low: (radius - error).next_down(), high: (radius + error).next_up() }
    }

    /// Whether a simplex fits α: the squared radius of its smallest orthogonal sphere, of which the
    /// interval is known, is at most α. Exact.
    #[inline]
    pub fn fits_by<const N: usize>(&self, simplex: [u32; N], radius: Interval, alpha: f64) -> bool {
        if radius.high <= alpha || alpha == f64::INFINITY {
            return true;
        }
        if radius.low > alpha || alpha == f64::NEG_INFINITY {
            return false;
        }
        self.fits(simplex, alpha)
    }

    /// The smallest double that is not below the squared radius: the first α at which it fits. By
    /// division of integers; some microseconds.
    pub fn first_alpha<const N: usize>(&self, simplex: [u32; N]) -> f64 {
        let sites = self.sites(simplex);
        if N == 1 { -sites[0].weight } else { exact::squared_radius(sites).rounded_up() }
    }

    /// Whether a point lies strictly inside the smallest orthogonal sphere of a vertex, an edge or
    /// a facet. Exact.
    #[inline]
    pub fn inside<const N: usize>(&self, simplex: [u32; N], x: u32) -> bool {
        let sites = self.sites(simplex);
        let p = sites[0];
        let x = self.nearest_copy(p, x);
        let View { rays, size } = View::<N>::of(p, sites);
        let (ray, reach) = ray(p, x);
        let size = size.larger(reach);
        let value = if N == 1 { ray.power } else { side(&rays[1..], &ray) };
        let bound = size.side_bound(N);
        let exact = self.lattice.holds_weights && self.holds(bound, 2 * N);
        if exact || (size.is_sane() && value.abs() > bound * ROUNDING) {
            value < 0.0
        } else {
            exact::inside(sites, x)
        }
    }

    /// The sign of the determinant of b − a, c − a, d − a. Exact.
    pub fn orientation(&self, corners: [u32; 4]) -> Ordering {
        let sites = self.sites(corners);
        let View { rays: [_, b, c, d], size } = View::of(sites[0], sites);
        let value = determinant([&b.vector, &c.vector, &d.vector]);
        let bound = 6.0 * size.length * size.length * size.length;
        if self.holds(bound, 3) || (size.is_sane() && value.abs() > bound * ROUNDING) {
            sign(value)
        } else {
            exact::orientation(sites)
        }
    }

    /// Whether three points lie on one line. Exact, by integers.
    pub fn collinear(&self, corners: [u32; 3]) -> bool {
        exact::collinear(self.sites(corners))
    }

    /// Whether a point lies inside (`Less`), on (`Equal`) or outside the orthogonal sphere of a
    /// positively oriented cell. Exact.
    pub fn power(&self, cell: [u32; 4], t: u32) -> Ordering {
        let sites = self.sites(cell);
        let t = self.nearest_copy(sites[0], t);
        let View { rays, size } = View::of(t, sites);
        let value = power_determinant(&rays);
        let bound = 24.0 * size.length * size.length * size.length * size.power;
        let alike = sites.iter().all(|site| site.weight == t.weight);
        let exact = (alike || self.lattice.holds_weights) && self.holds(bound, 5);
        if exact || (size.is_sane() && value.abs() > bound * ROUNDING) {
            sign(value)
        } else {
            exact::power([sites[0], sites[1], sites[2], sites[3], t])
        }
    }

    /// Whether a simplex fits a finite α: the squared radius of its smallest orthogonal sphere is at
    /// most α. Exact.
    #[inline]
    pub fn fits<const N: usize>(&self, simplex: [u32; N], alpha: f64) -> bool {
        let sites = self.sites(simplex);
        let p = sites[0];
        if N == 1 {
            return -p.weight <= alpha;
        }
        let View { rays, size } = View::<N>::of(p, sites);
        let (numerator, denominator) = quotient(&rays[1..]);
        let ball = alpha + p.weight;
        let value = numerator - 4.0 * ball * denominator;
        let bounds = size.bounds(N);
        let bound = bounds.numerator + 4.0 * ball.abs() * bounds.denominator;
        let exact = self.lattice.holds_weights && self.on_lattice(alpha);
        let sane = size.is_sane() && ball.abs() < Size::LARGEST_SQUARE;
        if (exact && self.holds(bound, 2 * N)) || (sane && value.abs() > bound * ROUNDING) {
            value <= 0.0
        } else {
            exact::fits(sites, alpha)
        }
    }

    /// Whether doubles hold a polynomial of this degree whose terms sum to `bound` in magnitude.
    #[inline]
    fn holds(&self, bound: f64, degree: usize) -> bool {
        // Without a step nothing is exact, not even a bound that underflowed to 0.
        self.lattice.step != 0.0 && bound <= self.exact[degree - 1]
    }

    fn on_lattice(&self, square: f64) -> bool {
        let multiple = square / (self.lattice.step * self.lattice.step);
        self.lattice.step != 0.0
            && multiple.abs() < (1u64 << 53) as f64
            && multiple.round() == multiple
    }
}

/// The lattice of points and, on a torus, of all their copies.
pub fn lattice(positions: &[[f64; 3]], weights: &[f64], torus: Option<Torus>) -> Lattice {
    match torus {
        None => Lattice::of(positions, weights),
        Some(torus) => Lattice::of(&[positions, &[torus.sides()]].concat(), weights),
    }
}

/// The smallest and largest coordinates of points; of none, +∞ and −∞. O(n).
pub(crate) fn extent(positions: &[[f64; 3]]) -> ([f64; 3], [f64; 3]) {
    let nothing = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    positions.iter().fold(nothing, |(low, high), p| {
        ([0, 1, 2].map(|k| p[k].min(low[k])), [0, 1, 2].map(|k| p[k].max(high[k])))
    })
}

fn sign(value: f64) -> Ordering {
    value.partial_cmp(&0.0).expect("no NaN passes a bound")
}

#[cfg(test)]
mod tests;
