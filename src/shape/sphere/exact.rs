//! The same questions in integers of any length: no rounding from the doubles on.

use dashu_int::IBig;
use dashu_int::ops::{BitTest, DivEuclid, UnsignedAbs};

use super::Site;
use super::formulas::{Ray, quotient, side};
use crate::number::{dot, integer, lowest_bit};

/// Whether the squared radius of the smallest orthogonal sphere is at most a finite α.
pub(super) fn fits(p: Site, others: &[Site], alpha: f64) -> bool {
    let units = Units::of(others.iter().chain([&p]), alpha);
    let rays: Vec<_> = others.iter().map(|&q| units.ray(p, q)).collect();
    let (numerator, denominator) = quotient(&rays);
    let ball: IBig = units.height(alpha) + units.height(p.weight);
    numerator <= ((ball * denominator) << (units.finer + 2))
}

/// The squared radius of the smallest orthogonal sphere, rounded up to a double; ∞ beyond them.
pub(super) fn squared_radius(p: Site, others: &[Site]) -> f64 {
    let units = Units::of(others.iter().chain([&p]), 0.0);
    let rays: Vec<_> = others.iter().map(|&q| units.ray(p, q)).collect();
    let (four_d_c2, d) = quotient(&rays);
    let denominator = d << (units.finer + 2);
    let numerator = four_d_c2 - units.height(p.weight) * &denominator;
    rounded_up(numerator, denominator, units.square())
}

/// The smallest double that is not below numerator/denominator · 2^exponent; the denominator is
/// positive.
fn rounded_up(numerator: IBig, denominator: IBig, exponent: i32) -> f64 {
    let bits = |number: &IBig| number.unsigned_abs().bit_len() as i32;
    // So many more digits that the quotient has 55 or 56, but none below the last of a double.
    let more = (56 - bits(&numerator) + bits(&denominator)).min(exponent + 1074);
    let (numerator, denominator) = if more >= 0 {
        (numerator << more as usize, denominator)
    } else {
        (numerator, denominator << more.unsigned_abs() as usize)
    };
    let ceiling = -((-numerator).div_euclid(denominator));
    // Rounding up twice is rounding up once.
    let spare = (bits(&ceiling) - 53).max(0);
    let unit = IBig::ONE << spare as usize;
    let digits = -((-ceiling).div_euclid(unit));
    let digits = i64::try_from(digits).expect("at most 2⁵³") as f64;
    let power = exponent - more + spare;
    // In two steps, as a power alone may be out of range; each product is exact.
    let value = digits * 2f64.powi(power / 2) * 2f64.powi(power - power / 2);
    if value == f64::NEG_INFINITY { f64::MIN } else { value }
}

/// Whether `x` lies strictly inside the smallest orthogonal sphere of an edge or a facet.
pub(super) fn inside(p: Site, others: &[Site], x: Site) -> bool {
    let units = Units::of(others.iter().chain([&p, &x]), 0.0);
    let rays: Vec<_> = others.iter().map(|&q| units.ray(p, q)).collect();
    side(&rays, &units.ray(p, x)) < IBig::ZERO
}

/// Whether `x` lies strictly inside the sphere of squared radius −ω(p) about p.
pub(super) fn hides(p: Site, x: Site) -> bool {
    Units::of([&p, &x].into_iter(), 0.0).ray(p, x).power < IBig::ZERO
}

/// Units in which numbers are integers: powers of two, one for coordinates, and one for squares
/// that is `finer` bits finer than the first one squared. The formulas are homogeneous in each, so
/// that a lattice with arbitrary doubles as weights needs few digits for its coordinates.
struct Units {
    coordinate: i32,
    finer: usize,
}

impl Units {
    fn of<'a>(sites: impl Iterator<Item = &'a Site> + Clone, alpha: f64) -> Self {
        let lowest = |numbers: &mut dyn Iterator<Item = f64>| numbers.filter_map(lowest_bit).min();
        let coordinate = lowest(&mut sites.clone().flat_map(|s| s.position)).unwrap_or(0);
        let weight = lowest(&mut sites.map(|s| s.weight).chain([alpha]));
        let height = weight.map_or(2 * coordinate, |bit| bit.min(2 * coordinate));
        Self { coordinate, finer: (2 * coordinate - height) as usize }
    }

    /// The unit of squares is two to this power.
    fn square(&self) -> i32 {
        2 * self.coordinate - self.finer as i32
    }

    fn height(&self, square: f64) -> IBig {
        integer(square, self.square())
    }

    fn ray(&self, p: Site, q: Site) -> Ray<IBig> {
        let vector = [0, 1, 2].map(|k| {
            integer(q.position[k], self.coordinate) - integer(p.position[k], self.coordinate)
        });
        let power = (dot(&vector, &vector) << self.finer) + self.height(p.weight);
        Ray { power: power - self.height(q.weight), vector }
    }
}
