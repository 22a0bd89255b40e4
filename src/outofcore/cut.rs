//! Into which boxes a volume is cut.

use walpha_base::memory;

use super::{Cutting, SampleBox};
use crate::shape::{AT_WORK, PlanError, ShapeError};

/// Bytes of memory that blocks keep to where nothing is said.
pub(super) const SILENT: u64 = 2 << 30;
/// Bytes for each sample of a tile, of which each thread has one.
pub(super) const TILE_SAMPLE: u64 = 48;
/// No volume has use for more blocks.
pub(super) const MOST: usize = 1 << 16;

/// Boxes of bricks with their points.
pub(super) struct Boxes<'a> {
    pub counts: &'a [u32],
    pub bricks: [usize; 3],
}

impl Boxes<'_> {
    /// The points of a box.
    pub(super) fn points(&self, part: &SampleBox) -> u64 {
        let mut points = 0;
        self.rows(part, |_, row| points += row.iter().map(|&n| u64::from(n)).sum::<u64>());
        points
    }

    fn rows(&self, part: &SampleBox, mut visit: impl FnMut([usize; 2], &[u32])) {
        let [cx, cy, _] = self.bricks;
        for z in part.first[2]..part.first[2] + part.size[2] {
            for y in part.first[1]..part.first[1] + part.size[1] {
                let from = (z * cy + y) * cx + part.first[0];
                visit([y - part.first[1], z - part.first[2]], &self.counts[from..][..part.size[0]]);
            }
        }
    }

    /// Cuts all bricks into so many boxes with about equally many points, each across its longest side, and
    /// fewer where a box is one brick. O(bricks log boxes).
    fn cut(&self, blocks: usize) -> Vec<SampleBox> {
        let mut pending = vec![(SampleBox::whole(self.bricks), blocks)];
        let mut cut = Vec::new();
        while let Some((part, blocks)) = pending.pop() {
            // Of equals the last, the slowest in memory.
            let axis = (0..3).max_by_key(|&k| part.size[k]).unwrap_or(2);
            if blocks <= 1 || part.size[axis] == 1 {
                cut.push(part);
                continue;
            }
            let mut planes = vec![0u64; part.size[axis]];
            self.rows(&part, |[y, z], row| match axis {
                0 => planes.iter_mut().zip(row).for_each(|(plane, &n)| *plane += u64::from(n)),
                _ => planes[[0, y, z][axis]] += row.iter().map(|&n| u64::from(n)).sum::<u64>(),
            });
            let left = blocks / 2;
            let wanted = planes.iter().sum::<u64>() * left as u64 / blocks as u64;
            let mut so_far = 0;
            let over = planes.iter().position(|&n| {
                so_far += n;
                so_far > wanted
            });
            let at = over.unwrap_or(0).clamp(1, part.size[axis] - 1);
            let (mut low, mut high) = (part, part);
            low.size[axis] = at;
            high.first[axis] += at;
            high.size[axis] -= at;
            // From the last to the first, so that blocks are numbered from low to high.
            pending.extend([(high, blocks - left), (low, left)]);
        }
        cut
    }

    /// The boxes asked for, or as few as keep to the memory of each process, and one for each of its threads,
    /// each with the points in it and around it.
    pub(super) fn planned(
        &self,
        cutting: Cutting,
        margin: [usize; 3],
        tile: u64,
        processes: usize,
    ) -> Result<Vec<(SampleBox, u64)>, ShapeError> {
        let with_halo = |blocks: usize| -> Vec<(SampleBox, u64)> {
            let around = |part: &SampleBox| self.points(&part.grown(margin, self.bricks));
            self.cut(blocks).into_iter().map(|part| (part, around(&part))).collect()
        };
        if let Some(blocks) = cutting.blocks {
            return Ok(with_halo(blocks.max(1)));
        }
        let threads = rayon::current_num_threads() as u64;
        let asked = cutting.memory.unwrap_or(SILENT);
        let needs = |largest: u64| {
            let tiles = TILE_SAMPLE * tile;
            memory::resident_bytes().unwrap_or(0) + threads * (tiles + AT_WORK * largest)
        };
        let mut least = PlanError { asked, needed: u64::MAX, blocks: 1 };
        let mut blocks = processes * threads as usize;
        while blocks <= MOST {
            let cut = with_halo(blocks);
            let needed = needs(cut.iter().map(|(_, points)| *points).max().unwrap_or(0));
            if needed <= asked {
                return Ok(cut);
            }
            if needed < least.needed {
                least = PlanError { needed, blocks, ..least };
            } else if cut.len() < blocks / 2 {
                break;
            }
            blocks *= 2;
        }
        Err(ShapeError::Plan(least))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_share_the_points() {
        let bricks = [5, 4, 7];
        let counts: Vec<u32> = (0..140).map(|i| if i % 3 == 0 { i % 50 } else { 0 }).collect();
        let boxes = Boxes { counts: &counts, bricks };
        for blocks in [1, 2, 5, 64, 1000] {
            let cut = boxes.cut(blocks);
            assert!(cut.len() <= blocks && (blocks > 64 || cut.len() * 2 > blocks), "{blocks}");
            assert_eq!(cut.iter().map(SampleBox::samples).sum::<usize>(), 140);
            let points: u64 = cut.iter().map(|part| boxes.points(part)).sum();
            assert_eq!(points, counts.iter().map(|&n| u64::from(n)).sum::<u64>());
        }
    }
}
