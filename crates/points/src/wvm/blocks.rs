//! Sets of voxels in blocks of 4×4×4, one bit per voxel, and the neighbourhoods of voxels.

use std::collections::HashMap;

/// A voxel or a block, by its indices (x, y, z).
pub(super) type Cell = [u32; 3];

/// The number of voxels along each side of a block.
pub(super) const SIDE: u32 = 4;

/// The number of blocks in the neighbourhood of a block, including itself in the middle.
pub(super) const AROUND: usize = 27;

/// The index of the block itself in its neighbourhood.
pub(super) const MIDDLE: usize = AROUND / 2;

/// The size of a grid, in voxels and in blocks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// The number of voxels along each axis.
    pub voxels: Cell,
    /// The number of blocks along each axis.
    pub blocks: Cell,
}

impl Shape {
    pub(super) fn new(voxels: Cell) -> Self {
        Self { voxels, blocks: voxels.map(|n| n.div_ceil(SIDE)) }
    }

    /// The number of a block. There are no more blocks than voxels, which are fewer than 2³².
    pub(super) fn number(&self, [x, y, z]: Cell) -> u32 {
        let [nx, ny, _] = self.blocks;
        x + nx * (y + ny * z)
    }

    /// The cell at a step from another, if it is within `end`.
    pub(super) fn offset(cell: Cell, step: [i32; 3], end: Cell) -> Option<Cell> {
        let mut there = cell;
        for k in 0..3 {
            there[k] = cell[k].checked_add_signed(step[k]).filter(|&x| x < end[k])?;
        }
        Some(there)
    }

    /// The voxels of a block that are within the grid, as bits.
    pub(super) fn within(&self, block: Cell) -> u64 {
        let ends = [0, 1, 2].map(|k| (self.voxels[k] - SIDE * block[k]).min(SIDE));
        let inside = |bit: &u32| (0..3).all(|k| place_in_block(*bit)[k] < ends[k]);
        (0..64).filter(inside).map(|bit| 1 << bit).sum()
    }
}

/// The bit of a voxel in its block.
pub(super) fn bit_of(voxel: Cell) -> u32 {
    let [x, y, z] = voxel.map(|v| v % SIDE);
    x + SIDE * (y + SIDE * z)
}

/// The position in its block of the voxel of a bit.
pub(super) fn place_in_block(bit: u32) -> Cell {
    [bit % SIDE, bit / SIDE % SIDE, bit / (SIDE * SIDE)]
}

/// A set of voxels. Empty blocks are not stored.
#[derive(Debug, Default)]
pub(super) struct Blocks(HashMap<u32, u64>);

impl Blocks {
    /// The voxels of the block with this number, as bits.
    pub(super) fn of(&self, number: u32) -> u64 {
        self.0.get(&number).copied().unwrap_or_default()
    }

    /// Adds a voxel of a block.
    pub(super) fn add(&mut self, number: u32, bit: u32) {
        *self.0.entry(number).or_default() |= 1 << bit;
    }

    /// The voxels of a block and of the blocks around it.
    pub(super) fn around(&self, shape: &Shape, block: Cell) -> [u64; AROUND] {
        let mut around = [0; AROUND];
        for (voxels, step) in around.iter_mut().zip(steps(1)) {
            if let Some(there) = Shape::offset(block, step, shape.blocks) {
                *voxels = self.of(shape.number(there));
            }
        }
        around
    }
}

/// All steps of up to `reach` along each axis, z slowest.
pub(super) fn steps(reach: i32) -> impl Iterator<Item = [i32; 3]> {
    let along = move || -reach..=reach;
    along().flat_map(move |z| along().flat_map(move |y| along().map(move |x| [x, y, z])))
}

/// For each voxel of a block, a mask of the voxels at certain steps from it, in the blocks around.
pub(super) struct Window(Vec<[u64; AROUND]>);

impl Window {
    /// The window of the wanted steps, which are at most 4 along each axis.
    pub(super) fn new(wanted: impl Fn([i32; 3]) -> bool) -> Self {
        let steps: Vec<[i32; 3]> =
            steps(SIDE as i32).filter(|&step| step != [0; 3] && wanted(step)).collect();
        let of = |bit: u32| {
            let mut window = [0; AROUND];
            for step in &steps {
                let (block, bit) = reached(bit, *step);
                window[block] |= 1u64 << bit;
            }
            window
        };
        Self((0..64).map(of).collect())
    }

    /// The number of voxels around that are in the window of the voxel of a bit.
    pub(super) fn count(&self, around: &[u64; AROUND], bit: u32) -> usize {
        let pairs = self.0[bit as usize].iter().zip(around);
        pairs.map(|(window, voxels)| (window & voxels).count_ones() as usize).sum()
    }
}

/// The voxel at a step from the voxel of a bit: its block among those around, and its bit.
pub(super) fn reached(bit: u32, step: [i32; 3]) -> (usize, u32) {
    let place = place_in_block(bit);
    let (mut block, mut voxel) = (0, [0; 3]);
    for k in (0..3).rev() {
        let there = place[k] as i32 + step[k] + SIDE as i32;
        block = 3 * block + there as usize / SIDE as usize;
        voxel[k] = there as u32 % SIDE;
    }
    (block, bit_of(voxel))
}

/// Whether a step leads to a voxel that comes earlier, in the order of z, then y, then x.
pub(super) fn is_earlier([x, y, z]: [i32; 3]) -> bool {
    [z, y, x] < [0; 3]
}

/// The squared length of a step.
pub(super) fn squared(step: [i32; 3]) -> i32 {
    step.iter().map(|v| v * v).sum()
}
