//! Digests of the samples that were read from a volume, brick by brick, so that a block can verify that it reads what was
//! planned.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use walpha_base::parallel::prelude::*;

use super::SampleBox;
use super::bytes::{Digest, Hasher};

/// Digests of the bricks of a box: 8 bytes for each, of 8³ or 16³ samples.
pub(super) struct ReadDigests {
    /// The number of samples along x, y and z in the volume, and along the sides of a brick.
    dims: [usize; 3],
    side: usize,
    /// The box in bricks.
    part: SampleBox,
    /// The digest of each brick; 0 if nothing was read yet.
    bricks: Vec<AtomicU64>,
    /// Whether a brick differed when it was read again.
    differs: AtomicBool,
}

impl ReadDigests {
    /// Creates empty digests for a box of samples of a volume.
    pub(super) fn none_of(part: &SampleBox, side: usize, dims: [usize; 3]) -> Self {
        let part = Self::around(part, side, dims);
        let bricks = (0..part.samples()).map(|_| AtomicU64::new(0)).collect();
        Self { dims, side, part, bricks, differs: AtomicBool::new(false) }
    }

    /// The bricks that overlap a box of samples.
    fn around(part: &SampleBox, side: usize, dims: [usize; 3]) -> SampleBox {
        let SampleBox { first, size } = part.aligned(side, dims);
        SampleBox { first: first.map(|i| i / side), size: size.map(|n| n.div_ceil(side)) }
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        let ([x0, y0, z0], [nx, ny, _]) = (self.part.first, self.part.size);
        ((z - z0) * ny + y - y0) * nx + x - x0
    }

    /// Records the samples of a box; returns whether all bricks agree with earlier reads. Bricks that are not completely in the
    /// box, or are outside the box of this object, are left out.
    pub(super) fn note(&self, part: &SampleBox, samples: &[f32]) -> bool {
        let bricks = Self::around(part, self.side, self.dims).common(&self.part);
        let SampleBox { first, size: [nx, ny, _] } = bricks;
        (0..bricks.samples()).into_par_iter().for_each(|i| {
            let at = [i % nx, i / nx % ny, i / (nx * ny)];
            let at = [0, 1, 2].map(|k| first[k] + at[k]);
            let Some(found) = self.of_brick(at, part, samples) else { return };
            let known = &self.bricks[self.index(at)];
            if let Err(before) =
                known.compare_exchange(0, found, Ordering::Relaxed, Ordering::Relaxed)
                && before != found
            {
                self.differs.store(true, Ordering::Relaxed);
            }
        });
        !self.differs.load(Ordering::Relaxed)
    }

    /// The digest of a brick; `None` if the box does not contain all of it.
    fn of_brick(&self, at: [usize; 3], part: &SampleBox, samples: &[f32]) -> Option<u64> {
        let whole = SampleBox { first: at.map(|i| i * self.side), size: [self.side; 3] };
        let whole = whole.common(&SampleBox::whole(self.dims));
        if whole.common(part) != whole {
            return None;
        }
        let [nx, ny, _] = part.size;
        let mut hasher = Hasher::default();
        let mut bytes = Vec::with_capacity(4 * whole.samples());
        for z in whole.first[2] - part.first[2]..whole.first[2] - part.first[2] + whole.size[2] {
            for y in whole.first[1] - part.first[1]..whole.first[1] - part.first[1] + whole.size[1]
            {
                let from = (z * ny + y) * nx + whole.first[0] - part.first[0];
                bytes.extend(samples[from..][..whole.size[0]].iter().flat_map(|v| v.to_le_bytes()));
            }
        }
        hasher.update(&bytes);
        Some(hasher.short().max(1))
    }

    /// The digest of the bricks that overlap a box of samples, in their order.
    pub(super) fn digest(&self, part: &SampleBox) -> Digest {
        let bricks = Self::around(part, self.side, self.dims).common(&self.part);
        let mut hasher = Hasher::default();
        for z in bricks.first[2]..bricks.first[2] + bricks.size[2] {
            for y in bricks.first[1]..bricks.first[1] + bricks.size[1] {
                let from = self.index([bricks.first[0], y, z]);
                for brick in &self.bricks[from..from + bricks.size[0]] {
                    hasher.update(&brick.load(Ordering::Relaxed).to_le_bytes());
                }
            }
        }
        hasher.digest()
    }

    /// The digests of this process, to be sent to others.
    pub(super) fn bricks(&self) -> Vec<u64> {
        self.bricks.iter().map(|brick| brick.load(Ordering::Relaxed)).collect()
    }

    /// Joins the digests of two processes; returns whether they agree on the bricks that both have read.
    pub(super) fn join(seen: &mut [u64], other: &[u64]) -> bool {
        let mut same = true;
        for (mine, &theirs) in seen.iter_mut().zip(other) {
            same &= *mine == 0 || theirs == 0 || *mine == theirs;
            *mine = (*mine).max(theirs);
        }
        same
    }

    /// Replaces the digests by the joined ones of all processes.
    pub(super) fn take(&mut self, all: Vec<u64>) {
        self.bricks = all.into_iter().map(AtomicU64::new).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(part: &SampleBox, dims: [usize; 3]) -> Vec<f32> {
        let mut samples = Vec::new();
        for z in part.first[2]..part.first[2] + part.size[2] {
            for y in part.first[1]..part.first[1] + part.size[1] {
                let row = (z * dims[1] + y) * dims[0];
                samples.extend(
                    (part.first[0]..part.first[0] + part.size[0]).map(|x| (row + x) as f32),
                );
            }
        }
        samples
    }

    /// The same bricks have the same digests however the volume is read; another sample in any of them changes its digest.
    #[test]
    fn bricks_are_known_again() {
        let dims = [21, 17, 30];
        let whole = SampleBox::whole(dims);
        let planned = ReadDigests::none_of(&whole, 8, dims);
        assert!(planned.note(&whole, &samples(&whole, dims)));
        let block = SampleBox { first: [9, 3, 8], size: [4, 9, 15] };
        let around = block.aligned(8, dims);
        let again = ReadDigests::none_of(&block, 8, dims);
        assert_ne!(again.digest(&block), planned.digest(&block), "nothing was read yet");
        for tile in around.tiles([16, 8, 8]) {
            let outer = tile.grown([1; 3], dims).aligned(8, dims);
            assert!(again.note(&outer, &samples(&outer, dims)));
        }
        assert_eq!(again.digest(&block), planned.digest(&block));
        for at in 0..around.samples() {
            let other = ReadDigests::none_of(&block, 8, dims);
            let mut values = samples(&around, dims);
            values[at] += 0.5;
            assert!(other.note(&around, &values));
            assert_ne!(other.digest(&block), planned.digest(&block), "{at}");
            assert!(!planned.note(&around, &values), "{at}: it was something else before");
            planned.differs.store(false, Ordering::Relaxed);
        }
        // A part that contains no complete brick has no digest.
        let part = SampleBox { first: [1, 0, 0], size: [7, 17, 30] };
        assert!(planned.note(&part, &vec![0.0; part.samples()]));
    }

    #[test]
    fn processes_join_what_they_saw() {
        let mut mine = vec![0, 5, 7, 0];
        assert!(ReadDigests::join(&mut mine, &[3, 5, 0, 0]));
        assert_eq!(mine, [3, 5, 7, 0]);
        assert!(!ReadDigests::join(&mut mine, &[0, 6, 0, 0]));
    }
}
