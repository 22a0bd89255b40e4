//! Counts of the known points around a voxel, and the contexts that its bit is coded under.

use walpha_base::sort::sort_by_key;

use super::blocks::{AROUND, Window, is_earlier, reached, squared, steps};

/// The windows around a voxel in which points are counted.
pub(super) struct Windows {
    /// Shells of voxels that are coded earlier, the nearest first.
    earlier: [Window; 4],
    /// Shells of voxels that are coded later: only their points of earlier layers are known.
    later: [Window; 3],
    /// Steps to the nine nearest earlier voxels.
    nearest: Vec<[i32; 3]>,
}

/// The numbers of points around a voxel.
pub(super) struct Counts {
    earlier: [usize; 4],
    later: [usize; 3],
    /// One bit for each of the nine nearest earlier voxels.
    pattern: usize,
}

/// The steps to earlier voxels, the nearest first, ties in the order of z, then y, then x.
pub(super) fn earlier_steps(reach: i32) -> Vec<[i32; 3]> {
    let mut earlier: Vec<[i32; 3]> = steps(reach).filter(|&step| is_earlier(step)).collect();
    sort_by_key(&mut earlier, |&step| squared(step));
    earlier
}

impl Windows {
    pub(super) fn new() -> Self {
        let shell = |earlier: bool, low: i32, high: i32| {
            Window::new(move |step| {
                is_earlier(step) == earlier && squared(step) > low && squared(step) <= high
            })
        };
        Self {
            earlier: [(0, 3), (3, 6), (6, 12), (12, 48)].map(|(a, b)| shell(true, a, b)),
            later: [(0, 3), (3, 9), (9, 48)].map(|(a, b)| shell(false, a, b)),
            nearest: earlier_steps(1)[..9].to_vec(),
        }
    }

    pub(super) fn count(&self, around: &[u64; AROUND], bit: u32) -> Counts {
        let mut pattern = 0;
        for (k, &step) in self.nearest.iter().enumerate() {
            let (block, there) = reached(bit, step);
            pattern |= usize::from(around[block] >> there & 1 == 1) << k;
        }
        Counts {
            earlier: self.earlier.each_ref().map(|window| window.count(around, bit)),
            later: self.later.each_ref().map(|window| window.count(around, bit)),
            pattern,
        }
    }
}

/// The number of binary digits; 0 for 0.
fn size(count: usize) -> usize {
    (usize::BITS - count.leading_zeros()) as usize
}

impl Counts {
    /// The contexts of a voxel. They are computed from the counts, the nearby blocks with points of this layer, the number of
    /// voxels left in a block without points so far (0 if it has some), and whether the voxel is at an end of the grid.
    pub(super) fn contexts(&self, sides: usize, left: usize, edge: usize) -> [usize; 8] {
        let ([a, b, c, d], [e, f, g]) = (self.earlier, self.later);
        let left = if left == 0 { 0 } else { left.min(63) / 4 + 1 };
        let few = |count: usize| count.min(3);
        [
            self.pattern + 512 * (few(e) + 4 * left),
            a + 14 * (b + 28 * (size(c).min(6) + 7 * few(e))),
            a + 14
                * ((b / 2).min(9) + 10 * ((c / 4).min(9) + 10 * ((d / 8).min(15) + 16 * e.min(1)))),
            2 * a + 2 * b + c + 130 * ((d / 4).min(31) + 32 * (e + f / 2).min(7)),
            e + 14 * ((f / 2).min(15) + 16 * (few(a) + 4 * (edge + 2 * left))),
            sides + 8 * (few(a) + 4 * (left + 17 * size(d).min(8))),
            a + e + 27 * (((b + c + f) / 2).min(63) + 64 * ((d + g) / 8).min(31)),
            d.min(127) + 128 * (edge + 2 * (few(a) + 4 * left)),
        ]
    }
}
