//! Smallest orthogonal spheres of simplices: their squared radii with bounds on the rounding, and
//! exact answers to the two questions an α-complex is made of.
//!
//! Each answer is the sign of a polynomial. It is computed in doubles and believed when it passes a
//! forward error bound, or when the arithmetic was exact because all numbers are small multiples of
//! a power of two, as on voxel grids. Otherwise integers of any length decide.

mod exact;
mod formulas;

use crate::cgal::Lattice;
use crate::number::dot;
use formulas::{Ray, quotient, side};

/// A weighted point.
#[derive(Clone, Copy)]
pub(crate) struct Site {
    position: [f64; 3],
    weight: f64,
}

/// Doubles around a number: `low` ≤ it ≤ `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    pub low: f64,
    pub high: f64,
}

/// Weighted points, asked about by index.
pub(crate) struct Spheres<'a> {
    positions: &'a [[f64; 3]],
    weights: &'a [f64],
    lattice: Lattice,
    /// Below these, polynomials of degree 2, 4, 6 and 8 in coordinates are exact in doubles.
    exact: [f64; 4],
}

/// Every number is the result of fewer than 32 roundings, so a polynomial is off by less than 2⁻⁴⁸
/// of the sum of the magnitudes of its terms.
const ROUNDING: f64 = 1.0 / (1u64 << 48) as f64;

impl<'a> Spheres<'a> {
    /// Looks for what the numbers have in common. O(n).
    pub fn new(positions: &'a [[f64; 3]], weights: &'a [f64]) -> Self {
        let lattice = Lattice::of(positions, weights);
        let square = lattice.step * lattice.step;
        let most = (1u64 << 53) as f64;
        let exact = [1, 2, 3, 4].map(|half| most * square.powi(half));
        Self { positions, weights, lattice, exact }
    }

    fn site(&self, v: u32) -> Site {
        Site { position: self.positions[v as usize], weight: self.weights[v as usize] }
    }

    /// The squared radius of the smallest orthogonal sphere of a simplex: α at which it fits.
    #[inline]
    pub fn squared_radius<const N: usize>(&self, simplex: [u32; N]) -> Interval {
        let p = self.site(simplex[0]);
        if N == 1 {
            return Interval { low: -p.weight, high: -p.weight };
        }
        let View { rays, size } = View::<N>::of(p, simplex.map(|v| self.site(v)));
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
    pub fn fits<const N: usize>(&self, simplex: [u32; N], radius: Interval, alpha: f64) -> bool {
        if radius.high <= alpha || alpha == f64::INFINITY {
            return true;
        }
        if radius.low > alpha || alpha == f64::NEG_INFINITY {
            return false;
        }
        self.decide(simplex, alpha)
    }

    /// The smallest double that is not below the squared radius: the first α at which it fits. By
    /// division of integers; some microseconds.
    pub fn first_alpha<const N: usize>(&self, simplex: [u32; N]) -> f64 {
        let sites = simplex.map(|v| self.site(v));
        if N == 1 { -sites[0].weight } else { exact::squared_radius(sites[0], &sites[1..]) }
    }

    /// Whether a point lies strictly inside the smallest orthogonal sphere of a vertex, an edge or
    /// a facet. Exact.
    #[inline]
    pub fn inside<const N: usize>(&self, simplex: [u32; N], x: u32) -> bool {
        let sites = simplex.map(|v| self.site(v));
        let (p, x) = (sites[0], self.site(x));
        let View { rays, size } = View::<N>::of(p, sites);
        let (ray, reach) = ray(p, x);
        let size = size.larger(reach);
        let value = if N == 1 { ray.power } else { side(&rays[1..], &ray) };
        let bound = size.side_bound(N);
        let exact = self.lattice.holds_weights && self.holds(bound, 2 * N);
        if exact || (size.is_sane() && value.abs() > bound * ROUNDING) {
            value < 0.0
        } else if N == 1 {
            exact::hides(p, x)
        } else {
            exact::inside(p, &sites[1..], x)
        }
    }

    /// Whether a simplex that is no vertex fits a finite α.
    fn decide<const N: usize>(&self, simplex: [u32; N], alpha: f64) -> bool {
        let sites = simplex.map(|v| self.site(v));
        let p = sites[0];
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
            exact::fits(p, &sites[1..], alpha)
        }
    }

    /// Whether doubles hold a polynomial of this degree whose terms sum to `bound` in magnitude.
    fn holds(&self, bound: f64, degree: usize) -> bool {
        self.lattice.step != 0.0 && bound <= self.exact[degree / 2 - 1]
    }

    fn on_lattice(&self, square: f64) -> bool {
        let multiple = square / (self.lattice.step * self.lattice.step);
        self.lattice.step != 0.0
            && multiple.abs() < (1u64 << 53) as f64
            && multiple.round() == multiple
    }
}

/// A simplex from its first vertex; the first ray is 0.
struct View<const N: usize> {
    rays: [Ray<f64>; N],
    size: Size,
}

impl<const N: usize> View<N> {
    #[inline(always)]
    fn of(p: Site, sites: [Site; N]) -> Self {
        let mut size = Size { length: 0.0, power: 0.0 };
        let rays = sites.map(|q| {
            let (ray, reach) = ray(p, q);
            size = size.larger(reach);
            ray
        });
        Self { rays, size }
    }
}

#[inline(always)]
fn ray(p: Site, q: Site) -> (Ray<f64>, Size) {
    let vector = [0, 1, 2].map(|k| q.position[k] - p.position[k]);
    let length = vector.iter().fold(0f64, |most, x| most.max(x.abs()));
    let heavier = p.weight - q.weight;
    let size = Size { length, power: 3.0 * length * length + heavier.abs() };
    (Ray { power: dot(&vector, &vector) + heavier, vector }, size)
}

/// Magnitudes: the largest coordinate of a ray, and the terms of the largest power.
#[derive(Clone, Copy)]
struct Size {
    length: f64,
    power: f64,
}

struct Bounds {
    numerator: f64,
    denominator: f64,
}

impl Size {
    const LARGEST_SQUARE: f64 = 1e60;

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self { length: self.length.max(other.length), power: self.power.max(other.power) }
    }

    /// Whether nothing overflows or loses digits to underflow; degrees go up to 8.
    fn is_sane(self) -> bool {
        self.length > 1e-30 && self.length < 1e30 && self.power < Self::LARGEST_SQUARE
    }

    /// The terms of the two polynomials behind a radius, for so many vertices.
    #[inline(always)]
    fn bounds(self, vertices: usize) -> Bounds {
        let square = self.length * self.length;
        let powers = self.power * self.power;
        match vertices {
            2 => Bounds { numerator: powers, denominator: 3.0 * square },
            3 => Bounds { numerator: 12.0 * square * powers, denominator: 18.0 * square * square },
            _ => Bounds {
                numerator: 108.0 * square * square * powers,
                denominator: 36.0 * square * square * square,
            },
        }
    }

    /// The terms of the polynomial that tells inside from outside.
    #[inline(always)]
    fn side_bound(self, vertices: usize) -> f64 {
        let square = self.length * self.length;
        match vertices {
            1 => self.power,
            2 => 6.0 * self.power * square,
            _ => 54.0 * self.power * square * square,
        }
    }
}

#[cfg(test)]
mod tests;
