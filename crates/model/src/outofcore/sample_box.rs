//! Boxes of samples.

use serde::{Deserialize, Serialize};

/// A box of samples of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SampleBox {
    /// The first sample along x, y and z.
    pub first: [usize; 3],
    /// The number of samples along x, y and z.
    pub size: [usize; 3],
}

impl SampleBox {
    /// The box of a whole grid.
    pub(super) fn whole(dims: [usize; 3]) -> Self {
        Self { first: [0; 3], size: dims }
    }

    /// The number of samples.
    pub fn samples(&self) -> usize {
        self.size.iter().product()
    }

    /// Whether the box contains a sample.
    pub(super) fn holds(&self, at: [usize; 3]) -> bool {
        (0..3).all(|k| at[k] >= self.first[k] && at[k] < self.first[k] + self.size[k])
    }

    /// The box from a first sample to an exclusive end.
    fn between(first: [usize; 3], end: [usize; 3]) -> Self {
        Self { first, size: [0, 1, 2].map(|k| end[k].saturating_sub(first[k])) }
    }

    fn end(&self) -> [usize; 3] {
        [0, 1, 2].map(|k| self.first[k] + self.size[k])
    }

    /// The box grown by a number of samples on each side, within the grid.
    pub(super) fn grown(&self, by: [usize; 3], dims: [usize; 3]) -> Self {
        let end = self.end();
        Self::between(
            [0, 1, 2].map(|k| self.first[k].saturating_sub(by[k])),
            [0, 1, 2].map(|k| end[k].saturating_add(by[k]).min(dims[k])),
        )
    }

    /// The smallest box of whole bricks with this side around the box, within the grid.
    pub(super) fn aligned(&self, side: usize, dims: [usize; 3]) -> Self {
        let end = self.end();
        Self::between(
            self.first.map(|i| i / side * side),
            [0, 1, 2].map(|k| end[k].next_multiple_of(side).min(dims[k])),
        )
    }

    /// The intersection of two boxes, which may be empty.
    pub(super) fn common(&self, other: &Self) -> Self {
        let (a, b) = (self.end(), other.end());
        Self::between(
            [0, 1, 2].map(|k| self.first[k].max(other.first[k])),
            [0, 1, 2].map(|k| a[k].min(b[k])),
        )
    }

    /// The tiles of this size, counted from the grid's first sample, that overlap this box, cut to it.
    pub(super) fn tiles(self, size: [usize; 3]) -> Vec<Self> {
        let starts = |k: usize| {
            let from = self.first[k] / size[k] * size[k];
            (from..self.first[k] + self.size[k]).step_by(size[k])
        };
        let mut tiles = Vec::new();
        for z in starts(2) {
            for y in starts(1) {
                tiles.extend(starts(0).map(|x| self.common(&Self { first: [x, y, z], size })));
            }
        }
        tiles
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_a_box_once() {
        let dims = [50, 20, 33];
        let part = SampleBox { first: [7, 0, 16], size: [40, 20, 17] };
        let tiles = part.tiles([16, 32, 8]);
        assert_eq!(tiles.iter().map(SampleBox::samples).sum::<usize>(), part.samples());
        assert!(tiles.iter().all(|tile| tile.common(&part) == *tile && tile.samples() > 0));
        let around = part.grown([1, 1, 1], dims).aligned(8, dims);
        assert_eq!(around, SampleBox { first: [0, 0, 8], size: [48, 20, 25] });
        assert!(part.holds([46, 19, 32]) && !part.holds([47, 19, 32]));
        assert_eq!(part.common(&SampleBox { first: [47, 0, 0], size: [3, 3, 3] }).samples(), 0);
    }
}
