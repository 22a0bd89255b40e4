//! Cells in the slots of leaves, so that merging does not move kept cells.

use crate::incremental::Built;
use crate::{Cell, DELETED, Triangulation};

/// Cells by slot, in one chunk for each of consecutive leaves. The number of a slot is that of its leaf, followed by as many bits
/// as the numbers of all leaves leave free.
pub(super) struct Slots {
    pub chunks: Vec<Vec<Cell>>,
    /// The leaf of the first chunk.
    first: usize,
    /// Bits of a slot's number within its leaf.
    pub bits: u32,
}

impl Slots {
    /// The slots of a triangulation in one piece.
    pub(super) fn of_one(cells: Vec<Cell>) -> Self {
        Self { chunks: vec![cells], first: 0, bits: Triangulation::MAX_CELLS.ilog2() }
    }

    #[inline(always)]
    fn at(&self, slot: u32) -> (usize, usize) {
        ((slot >> self.bits) as usize - self.first, (slot & ((1 << self.bits) - 1)) as usize)
    }

    #[inline(always)]
    pub(super) fn get(&self, slot: u32) -> &Cell {
        let (chunk, at) = self.at(slot);
        &self.chunks[chunk][at]
    }

    #[inline(always)]
    pub(super) fn get_mut(&mut self, slot: u32) -> &mut Cell {
        let (chunk, at) = self.at(slot);
        &mut self.chunks[chunk][at]
    }

    /// A new slot; `None` if the last leaf is full.
    pub(super) fn push(&mut self) -> Option<u32> {
        let leaf = self.first + self.chunks.len() - 1;
        let chunk = self.chunks.last_mut()?;
        let at = chunk.len();
        chunk.push(Cell::default());
        (at >> self.bits == 0).then_some((leaf as u32) << self.bits | at as u32)
    }

    /// A mark for each slot, none of them set.
    pub(super) fn marks(&self) -> Marks {
        let marks = self.chunks.iter().map(|chunk| vec![0; chunk.len()]).collect();
        Marks { marks, first: self.first, bits: self.bits }
    }
}

/// A number for each slot, 0 at first.
pub(super) struct Marks {
    marks: Vec<Vec<u8>>,
    first: usize,
    bits: u32,
}

impl Marks {
    #[inline(always)]
    pub(super) fn of(&mut self, slot: u32) -> &mut u8 {
        let chunk = (slot >> self.bits) as usize - self.first;
        &mut self.marks[chunk][(slot & ((1 << self.bits) - 1)) as usize]
    }
}

/// The triangulation of consecutive leaves. Vertices have the numbers that they have in the whole.
pub(super) struct Mesh {
    pub slots: Slots,
    /// Slots of deleted cells.
    pub free: Vec<u32>,
    /// Number of cells; 0 if the points of the leaves span no volume.
    pub count: usize,
    /// The slot of an infinite cell, if there are cells.
    pub infinite: u32,
}

impl Mesh {
    /// The mesh of a leaf whose points span no volume.
    pub(super) fn of_flat_leaf(leaf: usize, leaves: usize) -> Self {
        let slots = Slots { chunks: vec![Vec::new()], first: leaf, bits: bits(leaves) };
        Self { slots, free: Vec::new(), count: 0, infinite: 0 }
    }

    /// Whether the points of the leaves span a volume.
    pub(super) fn spans(&self) -> bool {
        self.count > 0
    }

    /// The mesh of one of `leaves` leaves, whose first point is given; `None` if it has more cells than slots.
    pub(super) fn of_leaf(
        built: Built,
        leaf: usize,
        leaves: usize,
        first_point: usize,
        at_infinity: u32,
    ) -> Option<Self> {
        let Built { mut cells, mut free_slots, at_infinity: own_infinite } = built;
        let bits = bits(leaves);
        if cells.len() > 1 << bits {
            return None;
        }
        let start = (leaf as u32) << bits;
        let mut infinite = 0;
        for (slot, cell) in (start..).zip(&mut cells).filter(|(_, c)| c.corners[0] != DELETED) {
            for v in &mut cell.corners {
                if *v == own_infinite {
                    *v = at_infinity;
                    infinite = slot;
                } else {
                    *v += first_point as u32;
                }
            }
            cell.neighbors.iter_mut().for_each(|side| *side += 4 * start);
        }
        free_slots.iter_mut().for_each(|slot| *slot += start);
        let count = cells.len() - free_slots.len();
        let slots = Slots { chunks: vec![cells], first: leaf, bits };
        Some(Self { slots, free: free_slots, count, infinite })
    }

    /// The cells of both, without merging. `other` has the leaves that follow.
    pub(super) fn append(&mut self, other: Self) {
        self.slots.chunks.extend(other.slots.chunks);
        self.free.extend(other.free);
        self.count += other.count;
    }
}

/// The number of bits that the numbers of this many leaves leave free.
fn bits(leaves: usize) -> u32 {
    Triangulation::MAX_CELLS.ilog2().saturating_sub(leaves.next_power_of_two().ilog2())
}
