//! Coding of the voxels that have points.

use std::collections::HashSet;

use super::around::{Windows, earlier_steps};
use super::blocks::{Blocks, Cell, MIDDLE, SIDE, Shape, bit_of};
use super::coder::Coder;
use super::mixer::Mixer;

/// The number of blocks along each side of a superblock.
const SUPER: u32 = 8;

/// Codes occupied voxels layer by layer: the superblocks that have points, then their blocks, then the voxels
/// of these, each in the order of z, then y, then x. The voxels known so far are the contexts.
pub(super) struct Places {
    shape: Shape,
    known: Blocks,
    gaps: Mixer,
    blocks: Mixer,
    voxels: Mixer,
    earlier_blocks: Vec<[i32; 3]>,
    windows: Windows,
}

impl Places {
    /// A coder for a grid without known points.
    pub(super) fn new(voxels: Cell) -> Self {
        Self {
            shape: Shape::new(voxels),
            known: Blocks::default(),
            gaps: Mixer::new(1, 1, 60.0, 0.02),
            blocks: Mixer::new(4, 1, 250.0, 0.02),
            voxels: Mixer::new(8, 4, 250.0, 0.015),
            earlier_blocks: earlier_steps(2),
            windows: Windows::new(),
        }
    }

    /// The voxels known to have points.
    pub(super) fn known(&self) -> &Blocks {
        &self.known
    }

    /// Codes a layer of `count` voxels, and returns them in order. `fresh` are the voxels that an encoder
    /// adds, in order, none of them known before; a decoder passes none. `None` if a stream does not hold
    /// `count` voxels.
    pub(super) fn code(
        &mut self,
        coder: &mut impl Coder,
        fresh: &[Cell],
        count: usize,
    ) -> Option<Vec<Cell>> {
        let mut wanted = Blocks::default();
        let mut supers: Vec<Cell> = Vec::new();
        for voxel in fresh {
            let block = voxel.map(|v| v / SIDE);
            wanted.add(self.shape.number(block), bit_of(*voxel));
            supers.push(block.map(|b| b / SUPER));
        }
        supers.sort_unstable_by_key(|&[x, y, z]| [z, y, x]);
        supers.dedup();
        let supers = self.supers(coder, &supers, count)?;
        let blocks = self.code_blocks(coder, &supers, &wanted, count)?;
        self.code_voxels(coder, &blocks, &wanted, count)
    }

    /// Codes the superblocks by the number of empty ones between one and the next.
    fn supers(
        &mut self,
        coder: &mut impl Coder,
        wanted: &[Cell],
        count: usize,
    ) -> Option<Vec<Cell>> {
        let [nx, ny, nz] = self.shape.blocks.map(|n| u64::from(n.div_ceil(SUPER)));
        let number = |[x, y, z]: Cell| u64::from(x) + nx * (u64::from(y) + ny * u64::from(z));
        let many = self.gaps.number(coder, 0, wanted.len() as u64)?;
        if many > count as u64 {
            return None;
        }
        let (mut supers, mut next) = (Vec::new(), 0);
        for k in 0..many as usize {
            let gap = wanted.get(k).map_or(0, |&cell| number(cell) - next);
            let at = next + self.gaps.number(coder, 1, gap)?;
            if at >= nx * ny * nz {
                return None;
            }
            supers.push([at % nx, at / nx % ny, at / (nx * ny)].map(|v| v as u32));
            next = at + 1;
        }
        Some(supers)
    }

    fn code_blocks(
        &mut self,
        coder: &mut impl Coder,
        supers: &[Cell],
        wanted: &Blocks,
        count: usize,
    ) -> Option<Vec<Cell>> {
        let end = self.shape.blocks;
        let (mut blocks, mut flagged) = (Vec::new(), HashSet::new());
        rows(supers, SUPER, end, &mut |cell, y, z| {
            for x in span(cell[0], SUPER, end[0]) {
                let block = [x, y, z];
                let number = self.shape.number(block);
                let contexts = self.block_contexts(&flagged, block);
                let bit = wanted.of(number) != 0;
                if self.blocks.code(coder, &contexts, 0, bit) {
                    flagged.insert(number);
                    blocks.push(block);
                }
            }
            (blocks.len() <= count).then_some(())
        })?;
        Some(blocks)
    }

    fn block_contexts(&self, flagged: &HashSet<u32>, block: Cell) -> [usize; 4] {
        let end = self.shape.blocks;
        let is_flagged = |step: &[i32; 3]| {
            let there = Shape::offset(block, *step, end);
            there.is_some_and(|there| flagged.contains(&self.shape.number(there)))
        };
        let (near, far) = self.earlier_blocks.split_at(13);
        let mut pattern = 0;
        for (k, step) in near.iter().enumerate() {
            pattern |= usize::from(is_flagged(step)) << k;
        }
        let count = pattern.count_ones() as usize;
        let farther = far.iter().filter(|step| is_flagged(step)).count();
        let edge = usize::from((0..3).any(|k| block[k] == 0 || block[k] + 1 == end[k]));
        let here = self.known.of(self.shape.number(block)).count_ones().min(7) as usize;
        [
            pattern % 128 + 128 * here,
            count + 14 * (edge + 2 * here),
            pattern + 8192 * here,
            count + 14 * (farther / 4 + 13 * here),
        ]
    }

    fn code_voxels(
        &mut self,
        coder: &mut impl Coder,
        blocks: &[Cell],
        wanted: &Blocks,
        count: usize,
    ) -> Option<Vec<Cell>> {
        let (shape, mut voxels) = (self.shape, Vec::new());
        let flagged: HashSet<u32> = blocks.iter().map(|&block| shape.number(block)).collect();
        let mut fresh = Blocks::default();
        rows(blocks, SIDE, shape.voxels, &mut |block, y, z| {
            let number = shape.number(block);
            let mut around = self.known.around(&shape, block);
            let open = shape.within(block) & !(around[MIDDLE] & !fresh.of(number));
            for x in span(block[0], SIDE, shape.voxels[0]) {
                let voxel = [x, y, z];
                let bit = bit_of(voxel);
                if open >> bit & 1 == 0 {
                    continue;
                }
                // If a block has no point yet, the last candidate must be one.
                let left = (open >> bit).count_ones() as usize;
                let left = if fresh.of(number) == 0 { left } else { 0 };
                let has = wanted.of(number) >> bit & 1 == 1;
                let has = left == 1 || {
                    let counts = self.windows.count(&around, bit);
                    let sides = self.sides(&flagged, block, voxel);
                    let edge = (0..3).any(|k| voxel[k] == 0 || voxel[k] + 1 == shape.voxels[k]);
                    let contexts = counts.contexts(sides, left, usize::from(edge));
                    let set = usize::from(edge) + 2 * usize::from(left > 0);
                    self.voxels.code(coder, &contexts, set, has)
                };
                if has {
                    self.known.add(number, bit);
                    fresh.add(number, bit);
                    around[MIDDLE] |= 1 << bit;
                    voxels.push(voxel);
                }
            }
            (voxels.len() <= count).then_some(())
        })?;
        (voxels.len() == count).then_some(voxels)
    }

    /// Determines which of the three face neighbours of a block that are nearest to a voxel have points of this layer.
    fn sides(&self, flagged: &HashSet<u32>, block: Cell, voxel: Cell) -> usize {
        let mut sides = 0;
        for k in 0..3 {
            let mut step = [0; 3];
            step[k] = if voxel[k] % SIDE < SIDE / 2 { -1 } else { 1 };
            let there = Shape::offset(block, step, self.shape.blocks);
            let has = there.is_some_and(|there| flagged.contains(&self.shape.number(there)));
            sides |= usize::from(has) << k;
        }
        sides
    }
}

/// The range of smaller cells that a cell covers along an axis.
fn span(cell: u32, factor: u32, end: u32) -> std::ops::Range<u32> {
    cell * factor..end.min((cell + 1).saturating_mul(factor))
}

/// Visits the rows of smaller cells, `factor` along each side of a cell, in the order of the smaller cells:
/// each by its cell, its y and its z. Stops at the first `None`.
fn rows(
    cells: &[Cell],
    factor: u32,
    end: Cell,
    visit: &mut impl FnMut(Cell, u32, u32) -> Option<()>,
) -> Option<()> {
    for slab in cells.chunk_by(|a, b| a[2] == b[2]) {
        for z in span(slab[0][2], factor, end[2]) {
            for row in slab.chunk_by(|a, b| a[1] == b[1]) {
                for y in span(row[0][1], factor, end[1]) {
                    row.iter().try_for_each(|&cell| visit(cell, y, z))?;
                }
            }
        }
    }
    Some(())
}
