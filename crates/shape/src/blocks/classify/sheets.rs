use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use walpha_base::UnionFind;
use walpha_base::parallel::prelude::*;
use walpha_base::sort::sort_handful_by;

use super::CELLS;
use super::local::{Local, even};
use super::records::{Owned, Side};
use super::state::Kind;

/// Sheets of the boundary: a union-find over the corners of exterior cells.
///
/// A corner is a cell seen from one of its vertices: 4·cell + corner. Two exterior cells with a common
/// exterior facet are in one sector of the space around each vertex of that facet, so their corners there are united.
/// The corners on one side of a boundary facet, and those at both ends of a singular edge, are on one sheet. A
/// block unites corners at its own points only: it does not know the whole stars of other points, and their
/// blocks do.
pub(super) struct Sheets {
    /// The number of each cell among the exterior cells that are not foreign.
    number: Vec<u32>,
    sets: UnionFind,
}

impl Sheets {
    pub(super) fn new(kinds: &[Kind]) -> Self {
        let is_exterior = |kind: &Kind| matches!(kind, Kind::Infinite | Kind::Outside);
        let (number, count) = ranks(kinds, is_exterior);
        Self { number, sets: UnionFind::new(4 * count as usize) }
    }

    fn at(&self, corner: u32) -> u32 {
        4 * self.number[corner as usize / 4] + corner % 4
    }

    pub(super) fn unite(&self, a: u32, b: u32) {
        self.sets.unite(self.at(a), self.at(b));
    }

    /// Replaces corners by the numbers of their sheets, which count from 0.
    pub(super) fn number(self, owned: &mut Owned) {
        let is_sheet: Vec<_> = (0..self.sets.members()).map(|_| AtomicBool::new(false)).collect();
        owned.each_sheet(|corner| {
            *corner = self.sets.find(self.at(*corner));
            is_sheet[*corner as usize].store(true, Relaxed);
        });
        let (number, count) = ranks(&is_sheet, |is_sheet| is_sheet.load(Relaxed));
        owned.each_sheet(|root| *root = number[*root as usize]);
        owned.sheets = count;
    }
}

/// For each item, the number of counted items before it; and the number of all counted items.
fn ranks<T: Sync>(items: &[T], is_counted: impl Fn(&T) -> bool + Sync) -> (Vec<u32>, u32) {
    let count = |items: &[T]| items.iter().filter(|item| is_counted(item)).count() as u32;
    let mut starts: Vec<u32> = items.par_chunks(CELLS).map(count).collect();
    let mut total = 0;
    for start in &mut starts {
        total += std::mem::replace(start, total);
    }
    let mut ranks = vec![0; items.len()];
    let chunks = ranks.par_chunks_mut(CELLS).zip(items.par_chunks(CELLS)).zip(starts);
    chunks.for_each(|((ranks, items), mut next)| {
        for (rank, item) in ranks.iter_mut().zip(items) {
            *rank = next;
            next += u32::from(is_counted(item));
        }
    });
    (ranks, total)
}

impl Local<'_> {
    /// Unites the corners of the cells on both sides of an exterior facet, at each owned vertex of it.
    pub(super) fn unite_across(&self, here: u32, there: u32, sheets: &Sheets) {
        let cells = self.cells;
        let (cell, next) = (cells[here as usize / 4], cells[there as usize / 4]);
        for (k, &v) in cell.iter().enumerate() {
            if k == here as usize % 4 || !self.owned(v) {
                continue;
            }
            let m = next.iter().position(|&w| w == v).expect("both have the corners of the facet");
            sheets.unite(here / 4 * 4 + k as u32, there / 4 * 4 + m as u32);
        }
    }

    /// The corner of a cell at an owned vertex of one of its facets, 4·cell + corner opposite.
    pub(super) fn owned_corner(&self, side: u32) -> u32 {
        let cell = self.cells[side as usize / 4];
        let owned = (1..4).map(|step| (side + step) % 4).find(|&k| self.owned(cell[k as usize]));
        side / 4 * 4 + owned.expect("an owned point on each facet that is asked about")
    }

    /// Unites the corners on one side of a boundary facet; returns the side if other blocks know it, too.
    pub(super) fn unite_side(&self, side: u32, sheets: &Sheets) -> Option<Side> {
        let cell = self.cells[side as usize / 4];
        let mut corners = [1, 2, 3].map(|step| (side as usize + step) % 4);
        let own = corners.iter().filter(|&&k| self.owned(cell[k])).count();
        // The only owned vertex of the cell is opposite this facet, so the facet belongs to other blocks.
        if own == 0 {
            return None;
        }
        let first = self.owned_corner(side);
        for &k in corners.iter().filter(|&&k| self.owned(cell[k])) {
            sheets.unite(first, side / 4 * 4 + k as u32);
        }
        if own == 3 {
            return None;
        }
        sort_handful_by(&mut corners, |&k, &l| self.input(cell[k]).cmp(&self.input(cell[l])));
        let [a, b, c] = corners;
        let simplex = corners.map(|k| self.input(cell[k]));
        let windings = self.block.windings(cell[a]);
        let side = u32::from(even(a, b, c));
        Some(Side { simplex, side, sheet: first, windings })
    }
}
