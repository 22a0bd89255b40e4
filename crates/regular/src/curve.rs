//! An order of points in which neighbours in the order are neighbours in space.

use rayon::prelude::*;

/// Bits along each axis: 2¹⁶ steps in the largest extent.
const BITS: u32 = 16;

/// A place on the curve, and the number of a point.
pub(super) type Keyed = (u64, u32);

/// The points along a Hilbert curve through the cube around them; a point of the plane lies at z = 0.
/// Points in one cube of the grid, equal ones among them, come in ascending order. O(n log n).
pub(super) fn keyed<const D: usize>(positions: &[[f64; D]]) -> Vec<Keyed> {
    let ends = |k: usize| {
        let at = positions.par_iter().map(|p| p[k]);
        at.map(|x| (x, x)).reduce(
            || (f64::INFINITY, f64::NEG_INFINITY),
            |(low, high), (a, b)| (low.min(a), high.max(b)),
        )
    };
    let ends: [(f64, f64); D] = std::array::from_fn(ends);
    let widest = ends.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
    let scale = f64::from((1u32 << BITS) - 1) / widest;
    let mut keyed: Vec<Keyed> = (positions.par_iter().enumerate())
        .map(|(i, p)| {
            let mut step = [0; 3];
            for k in 0..D {
                step[k] = (((p[k] - ends[k].0) * scale) as u32).min((1 << BITS) - 1);
            }
            (place(step), i as u32)
        })
        .collect();
    keyed.par_sort_unstable();
    keyed
}

/// How far along the curve a place of the grid is: Skilling's transform ("Programming the Hilbert
/// curve", AIP Conference Proceedings 707, 2004, doi:10.1063/1.1751381), then bits interleaved.
fn place(mut x: [u32; 3]) -> u64 {
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
    let spread = x.map(|x| spread(u64::from(x ^ flips)));
    spread[0] << 2 | spread[1] << 1 | spread[2]
}

/// Bits 0, 1, 2, … of a number below 2²¹ at places 0, 3, 6, …
fn spread(mut x: u64) -> u64 {
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On a grid of a power of two, each step along the curve is one step in space.
    #[test]
    fn neighbours_in_order_are_neighbours_in_space() {
        let corner = |i: u32| [i % 8, i / 8 % 8, i / 64];
        let positions: Vec<_> = (0..512).map(|i| corner(i).map(f64::from)).collect();
        for pair in keyed(&positions).windows(2) {
            let (a, b) = (corner(pair[0].1), corner(pair[1].1));
            let apart: u32 = (0..3).map(|k| a[k].abs_diff(b[k])).sum();
            assert_eq!(apart, 1, "{a:?} {b:?}");
        }
    }

    #[test]
    fn one_place_keeps_its_order() {
        let points = |keyed: Vec<Keyed>| keyed.into_iter().map(|(_, i)| i).collect::<Vec<_>>();
        assert_eq!(points(keyed(&[[1.0, 2.0, 3.0]; 4])), [0, 1, 2, 3]);
        assert!(keyed::<3>(&[]).is_empty());
    }
}
