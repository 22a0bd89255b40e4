//! The two kinds of number in which barycentric coordinates are exact.

use std::cmp::Ordering;

use dashu_int::IBig;

use crate::number::{Number, decode, integer, lowest_bit};

/// A number of which barycentric coordinates are made; doubles are exact only where [`Lattice`] says
/// that no operation rounds.
pub(super) trait Part: Number + Clone {
    fn zero() -> Self;
    fn sign(&self) -> Ordering;
    /// The share of a positive whole, from 0 to 1, as the double nearest to it or beside that.
    fn over(&self, whole: &Self) -> f64;
}

impl Part for f64 {
    fn zero() -> Self {
        0.0
    }
    fn sign(&self) -> Ordering {
        self.partial_cmp(&0.0).expect("products of bounded numbers")
    }
    fn over(&self, whole: &Self) -> f64 {
        self / whole
    }
}

impl Part for IBig {
    fn zero() -> Self {
        Self::ZERO
    }
    fn sign(&self) -> Ordering {
        self.cmp(&Self::ZERO)
    }
    fn over(&self, whole: &Self) -> f64 {
        const BITS: usize = 64;
        let share = (self << BITS) / whole;
        u128::try_from(share).expect("at most the whole") as f64 / 2f64.powi(BITS as i32)
    }
}

/// Differences of a place from others, in one unit that makes all of them integers.
pub(super) fn integer_offsets(corners: &[[f64; 3]], from: [f64; 3]) -> Vec<[IBig; 3]> {
    let numbers = corners.iter().chain([&from]).flatten().copied();
    let unit = numbers.filter_map(lowest_bit).min().unwrap_or(0);
    let origin = from.map(|x| integer(x, unit));
    let offset = |corner: &[f64; 3]| {
        let [x, y, z] = corner.map(|x| integer(x, unit));
        [x - &origin[0], y - &origin[1], z - &origin[2]]
    };
    corners.iter().map(offset).collect()
}

/// What a set of coordinates has in common, so that one knows where doubles do not round.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    /// All coordinates are integers times two to this power…
    unit: i32,
    /// …and less than two to this power.
    reach: i32,
}

impl Lattice {
    /// Bits of a coordinate in units. A difference has one more; a triple product of such three
    /// times that; sums of 24 of these five more: 3·16 + 5 = 53, what a double holds.
    const BITS: i32 = 15;
    /// Third powers of larger or smaller units leave the range of doubles.
    const RANGE: i32 = 300;

    /// The lattice of some places. O(n).
    pub fn of(places: &[[f64; 3]]) -> Self {
        let empty = Self { unit: i32::MAX, reach: i32::MIN };
        places.as_flattened().iter().fold(empty, |lattice, &x| lattice.with(x))
    }

    fn with(self, x: f64) -> Self {
        let (mantissa, bit) = decode(x);
        if mantissa == 0 {
            return self;
        }
        let bits = (mantissa.unsigned_abs().ilog2() + 1) as i32;
        Self { unit: self.unit.min(bit), reach: self.reach.max(bit + bits) }
    }

    /// Whether formulas over these places and one more are exact in doubles.
    pub fn is_exact_with(self, place: [f64; 3]) -> bool {
        let Self { unit, reach } = place.into_iter().fold(self, Self::with);
        reach <= unit.saturating_add(Self::BITS) && unit.abs() <= Self::RANGE || reach == i32::MIN
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_are_what_doubles_are() {
        let offsets = integer_offsets(&[[3.5, -1.0, 0.0], [0.25, 8.0, -0.0]], [0.5, 0.0, 1.0]);
        let expected = [[12, -4, -4], [-1, 32, -4]].map(|row| row.map(IBig::from));
        assert_eq!(offsets, expected);
    }

    #[test]
    fn lattices_know_where_doubles_round() {
        let lattice = Lattice::of(&[[0.0, 63.0, 12.0], [-5.0, 32767.0, 1.0]]);
        assert!(lattice.is_exact_with([1.0, 2.0, 0.0]));
        assert!(!lattice.is_exact_with([0.5, 2.0, 0.0]));
        assert!(!lattice.is_exact_with([32768.0, 2.0, 0.0]));
        let halves = Lattice::of(&[[0.5, 100.0, 511.5]]);
        assert!(halves.is_exact_with([0.25; 3]) && !halves.is_exact_with([0.1; 3]));
        assert!(!Lattice::of(&[[1e-200; 3]]).is_exact_with([0.0; 3]));
        assert!(Lattice::of(&[[0.0; 3]]).is_exact_with([0.0; 3]));
    }
}
