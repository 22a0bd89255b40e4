//! A simplex as rays from one point, and the magnitudes that bound the rounding of its polynomials.

use super::Site;
use super::formulas::Ray;
use crate::number::dot;

/// A simplex as rays from a point; from its own first vertex the first ray is 0.
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
            let (ray, reach) = ray(p, q);
            size = size.larger(reach);
            *to = ray;
        }
        Self { rays, size }
    }
}

#[inline(always)]
pub(super) fn ray(p: Site, q: Site) -> (Ray<f64>, Size) {
    let vector = [0, 1, 2].map(|k| q.position[k] - p.position[k]);
    let length = vector.iter().fold(0f64, |most, x| most.max(x.abs()));
    let heavier = p.weight - q.weight;
    let size = Size { length, power: 3.0 * length * length + heavier.abs() };
    (Ray { power: dot(&vector, &vector) + heavier, vector }, size)
}

/// Magnitudes: the largest coordinate of a ray, and the terms of the largest power.
#[derive(Clone, Copy)]
pub(super) struct Size {
    pub length: f64,
    pub power: f64,
}

pub(super) struct Bounds {
    pub numerator: f64,
    pub denominator: f64,
}

impl Size {
    pub(super) const LARGEST_SQUARE: f64 = 1e60;

    #[inline(always)]
    pub(super) fn larger(self, other: Self) -> Self {
        Self { length: self.length.max(other.length), power: self.power.max(other.power) }
    }

    /// Whether nothing overflows or loses digits to underflow; degrees go up to 8.
    pub(super) fn is_sane(self) -> bool {
        self.length > 1e-30 && self.length < 1e30 && self.power < Self::LARGEST_SQUARE
    }

    /// The terms of the two polynomials behind a radius, for so many vertices.
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

    /// The terms of the polynomial that separates inside from outside.
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
