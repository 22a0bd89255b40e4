//! A simplex as rays from one point, and bounds of the terms of its polynomials, which give bounds of their rounding errors.

use super::Site;
use super::formulas::Ray;
use crate::number::dot;

/// The rays from a point to the vertices of a simplex. The first is 0 if the point is the first vertex.
pub(super) struct View<const N: usize> {
    pub rays: [Ray<f64>; N],
    pub size: Size,
}

impl<const N: usize> View<N> {
    #[inline(always)]
    pub(super) fn of(p: Site, sites: [Site; N]) -> Self {
        let mut size = Size { length: 0.0, power: 0.0 };
        let mut rays = [Ray { vector: [0.0; 3], power: 0.0 }; N];
        for (to, q) in rays.iter_mut().zip(sites) {
            let (ray, of_ray) = ray(p, q);
            size = size.larger(of_ray);
            *to = ray;
        }
        Self { rays, size }
    }
}

/// The ray from p to q, and its size.
#[inline(always)]
pub(super) fn ray(p: Site, q: Site) -> (Ray<f64>, Size) {
    let vector = [0, 1, 2].map(|k| q.position[k] - p.position[k]);
    let length = vector.iter().fold(0f64, |most, x| most.max(x.abs()));
    let heavier = p.weight - q.weight;
    let size = Size { length, power: 3.0 * length * length + heavier.abs() };
    (Ray { power: dot(&vector, &vector) + heavier, vector }, size)
}

/// Magnitudes of a set of rays.
#[derive(Clone, Copy)]
pub(super) struct Size {
    /// The largest magnitude of a coordinate of a vector.
    pub length: f64,
    /// The largest sum of the magnitudes of the terms of a power.
    pub power: f64,
}

/// Sums of the magnitudes of the terms of numerator and denominator of a squared radius.
pub(super) struct Bounds {
    pub numerator: f64,
    pub denominator: f64,
}

impl Size {
    /// Lengths between `SHORTEST` and `LONGEST`, and squares up to `LARGEST_SQUARE`, have polynomials up to degree 8
    /// within the range of doubles.
    pub(super) const SHORTEST: f64 = 1e-30;
    pub(super) const LONGEST: f64 = 1e30;
    pub(super) const LARGEST_SQUARE: f64 = 1e60;

    #[inline(always)]
    pub(super) fn larger(self, other: Self) -> Self {
        Self { length: self.length.max(other.length), power: self.power.max(other.power) }
    }

    /// Whether polynomials of degree up to 8 neither overflow nor lose bits to underflow.
    pub(super) fn is_sane(self) -> bool {
        self.length > Self::SHORTEST
            && self.length < Self::LONGEST
            && self.power < Self::LARGEST_SQUARE
    }

    /// Bounds of the terms of [`quotient`](super::formulas::quotient) for a simplex with this many vertices.
    #[inline(always)]
    pub(super) fn bounds(self, vertices: usize) -> Bounds {
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

    /// A bound of the terms of each number of [`Solution::barycentric`](super::formulas::Solution::barycentric) for a simplex with this many
    /// vertices. Squares of lengths are at most a third of a power.
    #[inline(always)]
    pub(super) fn barycentric_bound(self, vertices: usize) -> f64 {
        let square = self.length * self.length;
        match vertices {
            2 => 3.0 * self.power,
            3 => 24.0 * self.power * square,
            _ => 132.0 * self.power * square * square,
        }
    }

    /// A bound of the terms of [`side`](super::formulas::side) for a simplex with this many vertices.
    #[inline(always)]
    pub(super) fn side_bound(self, vertices: usize) -> f64 {
        let square = self.length * self.length;
        match vertices {
            1 => self.power,
            2 => 6.0 * self.power * square,
            _ => 54.0 * self.power * square * square,
        }
    }
}
