//! The order in which points are inserted: in rounds (a biased randomized insertion order: Amenta, Choi and Rote 2003,
//! doi:10.1145/777792.777824), and along a Hilbert curve within a round, so that consecutive points are close in space.

use walpha_base::parallel::prelude::*;
use walpha_base::spread_bits;

/// Bits of a grid coordinate: the longest side of the bounding box has 2¹⁶ grid steps.
const BITS: u32 = 16;

/// The index on the curve of a point's grid cell, and the number of the point.
pub(super) type Keyed = (u64, u32);

/// The points along a Hilbert curve through the cube around them; a point of the plane lies at z = 0.
/// Points in one cell of the grid, such as equal points, are in ascending order. O(n log n).
pub(super) fn along_curve<const D: usize>(positions: &[[f64; D]]) -> Vec<Keyed> {
    let curve = Curve::through(positions);
    let mut keyed: Vec<Keyed> = positions
        .par_iter()
        .coarse()
        .enumerate()
        .map(|(i, p)| (curve.index(p), i as u32))
        .collect();
    keyed.par_sort_unstable();
    keyed
}

/// A Hilbert curve through a grid in the cube around points.
pub(super) struct Curve<const D: usize> {
    low: [f64; D],
    /// Grid steps per unit of length.
    scale: f64,
}

impl<const D: usize> Curve<D> {
    /// The curve through the cube around points. O(n).
    pub(super) fn through(positions: &[[f64; D]]) -> Self {
        let ends = |k: usize| {
            let at = positions.par_iter().coarse().map(|p| p[k]);
            at.map(|x| (x, x)).reduce(
                || (f64::INFINITY, f64::NEG_INFINITY),
                |(low, high), (a, b)| (low.min(a), high.max(b)),
            )
        };
        let ends: [(f64, f64); D] = std::array::from_fn(ends);
        let widest = ends.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
        let scale = f64::from((1u32 << BITS) - 1) / widest;
        Self { low: ends.map(|(low, _)| low), scale }
    }

    /// The index of the grid cell that contains a point. The points whose indices begin with the same bits are those in a box;
    /// the next bit halves it, by a plane across one axis.
    pub(super) fn index(&self, position: &[f64; D]) -> u64 {
        let mut step = [0; 3];
        for k in 0..D {
            let steps = (position[k] - self.low[k]) * self.scale;
            step[k] = (steps as u32).min((1 << BITS) - 1);
        }
        hilbert_index(step)
    }
}

/// Bits of a position that are equal for equal positions: adding 0.0 turns −0.0 into 0.0.
pub(super) fn position_bits<const D: usize>(position: [f64; D]) -> [u64; D] {
    position.map(|x| (x + 0.0).to_bits())
}

/// The index of a grid cell on the curve: Skilling's transform ("Programming the Hilbert
/// curve", AIP Conference Proceedings 707, 2004, doi:10.1063/1.1751381), then bits interleaved.
fn hilbert_index(mut x: [u32; 3]) -> u64 {
    let mut bit = 1 << (BITS - 1);
    while bit > 1 {
        let below = bit - 1;
        for k in 0..3 {
            if x[k] & bit != 0 {
                x[0] ^= below;
            } else {
                let exchanged = (x[0] ^ x[k]) & below;
                x[0] ^= exchanged;
                x[k] ^= exchanged;
            }
        }
        bit >>= 1;
    }
    x[1] ^= x[0];
    x[2] ^= x[1];
    let mut flips = 0;
    let mut bit = 1 << (BITS - 1);
    while bit > 1 {
        if x[2] & bit != 0 {
            flips ^= bit - 1;
        }
        bit >>= 1;
    }
    let spread = x.map(|x| spread_bits(u64::from(x ^ flips)));
    spread[0] << 2 | spread[1] << 1 | spread[2]
}

/// The numbers 0..n in rounds, each about three times as large as all earlier ones together; ascending within a round.
pub(super) fn rounds(n: u32) -> impl Iterator<Item = u32> {
    let last = n.checked_ilog2().unwrap_or(0).saturating_sub(FIRST_ROUND_BITS) / GROWTH_BITS;
    (0..=last).rev().flat_map(move |round| (0..n).filter(move |&v| round_of(v).min(last) == round))
}

/// The first round has about 2¹⁰ to 2¹² points: in smaller ones the walks between distant points cost more than
/// the randomization saves.
const FIRST_ROUND_BITS: u32 = 10;
/// Each round multiplies the number of points inserted by 2 to this power.
const GROWTH_BITS: u32 = 2;
/// An odd multiplier that mixes the bits of a 32-bit number in two rounds of shift and multiply.
const MIX: u32 = 0x45d9_f3b5;

/// The round of a point, counted from the last, 0: the trailing zeros of its hashed number, divided by
/// [`GROWTH_BITS`]. Round r + 1 is 2^`GROWTH_BITS` times less probable than round r.
fn round_of(v: u32) -> u32 {
    let v = (v ^ v >> 16).wrapping_mul(MIX);
    let v = (v ^ v >> 16).wrapping_mul(MIX);
    (v ^ v >> 16).trailing_zeros() / GROWTH_BITS
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On a grid whose size is a power of two, each step along the curve is one step in space.
    #[test]
    fn neighbours_in_order_are_neighbours_in_space() {
        let corner = |i: u32| [i % 8, i / 8 % 8, i / 64];
        let positions: Vec<_> = (0..512).map(|i| corner(i).map(f64::from)).collect();
        for pair in along_curve(&positions).windows(2) {
            let (a, b) = (corner(pair[0].1), corner(pair[1].1));
            let apart: u32 = (0..3).map(|k| a[k].abs_diff(b[k])).sum();
            assert_eq!(apart, 1, "{a:?} {b:?}");
        }
    }

    #[test]
    fn one_place_keeps_its_order() {
        let points = |keyed: Vec<Keyed>| keyed.into_iter().map(|(_, i)| i).collect::<Vec<_>>();
        assert_eq!(points(along_curve(&[[1.0, 2.0, 3.0]; 4])), [0, 1, 2, 3]);
        assert!(along_curve::<3>(&[]).is_empty());
    }
}
