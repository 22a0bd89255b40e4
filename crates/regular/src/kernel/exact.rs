//! The predicates in integers, without any rounding. 128 bits suffice on most lattices, for any weights; otherwise integers are
//! of arbitrary length.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::formulas::{Centre, Ray, centre, determinant, power_determinant, quotient, side};
use super::{Ratio, Site};
use crate::number::{Integer, cross, dot, highest_bit, lowest_bit};

/// The bits of the magnitude of an `i128`.
const BITS_OF_I128: u32 = 127;

/// Evaluates an expression over integers `$T` that hold magnitudes of `$bits` bits: `i128` or `IBig`.
macro_rules! in_integers {
    ($bits:expr, $T:ident => $value:expr) => {
        if $bits < BITS_OF_I128 {
            type $T = i128;
            $value
        } else {
            type $T = IBig;
            $value
        }
    };
}

/// The sign of the determinant of b − a, c − a, d − a.
pub(super) fn orientation(sites: [Site; 4]) -> Ordering {
    let units = Units::of(&sites, 0.0);
    in_integers!(3 * units.coordinate_bits + 3, T => {
        let [_, b, c, d] = sites.map(|q| units.vector::<T>(sites[0], q));
        determinant([&b, &c, &d]).cmp(&T::ZERO)
    })
}

/// Whether three points lie on one line.
pub(super) fn collinear(sites: [Site; 3]) -> bool {
    let units = Units::of(&sites, 0.0);
    let [_, b, c] = sites.map(|q| units.vector::<IBig>(sites[0], q));
    cross(&b, &c).iter().all(|component| *component == IBig::ZERO)
}

/// Whether the last point lies inside (`Less`) or outside (`Greater`) the orthogonal sphere of the
/// positively oriented cell of the others.
pub(super) fn power(sites: [Site; 5]) -> Ordering {
    let units = Units::of(&sites, 0.0);
    in_integers!(3 * units.coordinate_bits + units.power_bits + 5, T => {
        let [a, b, c, d, _] = sites.map(|q| units.ray::<T>(sites[4], q));
        power_determinant(&[a, b, c, d]).cmp(&T::ZERO)
    })
}

/// Whether the squared radius of the smallest orthogonal sphere is at most a finite α.
pub(super) fn fits<const N: usize>(sites: [Site; N], alpha: f64) -> bool {
    let units = Units::of(&sites, alpha);
    let Units { coordinate_bits: c, power_bits: p, finer, .. } = units;
    // Bits of the numerator, and of the product of ball α + ω and denominator.
    let bits =
        (2 * (N as u32 - 2) * c + 2 * p + 7).max(p + 2 * (N as u32 - 1) * c + 9 + finer as u32);
    in_integers!(bits, T => {
        let rays = sites.map(|q| units.ray::<T>(sites[0], q));
        let (numerator, denominator) = quotient(&rays[1..]);
        let ball: T = units.height::<T>(alpha) + units.height::<T>(sites[0].weight);
        numerator <= (ball * denominator).shifted(finer + 2)
    })
}

/// The squared radius of the smallest orthogonal sphere.
pub(super) fn squared_radius<const N: usize>(sites: [Site; N]) -> Ratio {
    let units = Units::of(&sites, 0.0);
    let rays = sites.map(|q| units.ray::<IBig>(sites[0], q));
    let height = units.height::<IBig>(sites[0].weight);
    if N == 1 {
        return Ratio::new(-height, IBig::ONE, units.square());
    }
    let (four_d_c2, d) = quotient(&rays[1..]);
    let denominator = d << (units.finer + 2);
    let numerator = four_d_c2 - height * &denominator;
    Ratio::new(numerator, denominator, units.square())
}

/// The centre of the orthogonal sphere of a positively oriented cell, relative to its first corner: each coordinate is the
/// nearest double.
pub(super) fn centre_of(sites: [Site; 4]) -> [f64; 3] {
    let units = Units::of(&sites, 0.0);
    let [_, b, c, d] = sites.map(|q| units.ray::<IBig>(sites[0], q));
    let Centre { twice, det, .. } = centre([&b, &c, &d]);
    let exponent = units.coordinate - units.finer as i32;
    twice.map(|twice| Ratio::new(twice, &det << 1, exponent).nearest())
}

/// The rays of a simplex from its first corner, and their units.
pub(super) fn rays<const N: usize>(sites: &[Site; N]) -> ([Ray<IBig>; N], Units) {
    let units = Units::of(sites, 0.0);
    (sites.map(|q| units.ray::<IBig>(sites[0], q)), units)
}

/// Whether `x` lies strictly inside the smallest orthogonal sphere of a vertex, an edge or a facet.
pub(super) fn inside<const N: usize>(sites: [Site; N], x: Site) -> bool {
    let mut units = Units::of(&sites, 0.0);
    units.include(x);
    let bits = units.power_bits + 2 * (N as u32 - 1) * units.coordinate_bits + 6;
    in_integers!(bits, T => {
        let rays = sites.map(|q| units.ray::<T>(sites[0], q));
        let ray = units.ray::<T>(sites[0], x);
        (if N == 1 { ray.power } else { side(&rays[1..], &ray) }) < T::ZERO
    })
}

/// Units in which all numbers are integers: powers of two, one for coordinates, and one for squares, which is
/// `finer` bits finer than the square of the first. The formulas are homogeneous in each unit, so that points on
/// a lattice with arbitrary doubles as weights need few bits for their coordinates.
pub(super) struct Units {
    /// The unit of coordinates is two to this power.
    coordinate: i32,
    finer: usize,
    /// Bits of a difference of coordinates.
    coordinate_bits: u32,
    /// Bits of a power |q − p|² + ω(p) − ω(q).
    power_bits: u32,
    /// The lowest bit of any coordinate, and of any weight or α.
    lowest: [Option<i32>; 2],
    /// The exponent above the highest bit of these.
    highest: [Option<i32>; 2],
}

impl Units {
    fn of(sites: &[Site], alpha: f64) -> Self {
        let mut units = Self {
            coordinate: 0,
            finer: 0,
            coordinate_bits: 0,
            power_bits: 0,
            lowest: [None, lowest_bit(alpha)],
            highest: [None, highest_bit(alpha)],
        };
        for &site in sites {
            units.widen(site);
        }
        units.settle();
        units
    }

    fn include(&mut self, site: Site) {
        self.widen(site);
        self.settle();
    }

    /// Takes the bits of a site into account.
    fn widen(&mut self, site: Site) {
        let [x, y, z] = site.position;
        for (kind, value) in [(0, x), (0, y), (0, z), (1, site.weight)] {
            if let (Some(low), Some(high)) = (lowest_bit(value), highest_bit(value)) {
                let lowest = &mut self.lowest[kind];
                *lowest = Some(lowest.map_or(low, |bit| bit.min(low)));
                self.highest[kind] = self.highest[kind].max(Some(high));
            }
        }
    }

    /// Computes units and numbers of bits from the lowest and highest bits.
    fn settle(&mut self) {
        self.coordinate = self.lowest[0].unwrap_or(0);
        let height = self.lowest[1].map_or(2 * self.coordinate, |bit| bit.min(2 * self.coordinate));
        self.finer = (2 * self.coordinate - height) as usize;
        self.coordinate_bits = self.highest[0].map_or(0, |bit| (bit - self.coordinate) as u32) + 1;
        let weight = self.highest[1].map_or(0, |bit| (bit - height).max(0) as u32) + 1;
        // Three squares and a difference of weights.
        self.power_bits = (2 * self.coordinate_bits + 2 + self.finer as u32).max(weight) + 1;
    }

    /// The unit of coordinates is two to this power.
    pub(super) fn coordinate(&self) -> i32 {
        self.coordinate
    }

    /// The number of bits by which the unit of squares is finer than the square of the unit of coordinates.
    pub(super) fn finer(&self) -> usize {
        self.finer
    }

    /// The unit of squares is two to this power.
    fn square(&self) -> i32 {
        2 * self.coordinate - self.finer as i32
    }

    /// A squared length in units of squares.
    fn height<T: Integer>(&self, square: f64) -> T {
        T::of(square, self.square())
    }

    /// q − p in units of coordinates.
    fn vector<T: Integer>(&self, p: Site, q: Site) -> [T; 3] {
        let at = |site: Site, k: usize| T::of(site.position[k], self.coordinate);
        [0, 1, 2].map(|k| at(q, k).minus(&at(p, k)))
    }

    fn ray<T: Integer>(&self, p: Site, q: Site) -> Ray<T> {
        let vector = self.vector::<T>(p, q);
        let power = dot(&vector, &vector).shifted(self.finer).plus(&self.height(p.weight));
        Ray { power: power.minus(&self.height(q.weight)), vector }
    }
}
