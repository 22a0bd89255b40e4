//! The two kinds of number in which barycentric coordinates are exact.

use std::cmp::Ordering;

use dashu_int::IBig;

use walpha_regular::number::{Number, integer, lowest_bit};

/// A number of which barycentric coordinates are made; doubles are exact only where a
/// [`BitRange`](walpha_regular::BitRange) says that no operation rounds.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_are_what_doubles_are() {
        let offsets = integer_offsets(&[[3.5, -1.0, 0.0], [0.25, 8.0, -0.0]], [0.5, 0.0, 1.0]);
        let expected = [[12, -4, -4], [-1, 32, -4]].map(|row| row.map(IBig::from));
        assert_eq!(offsets, expected);
    }
}
