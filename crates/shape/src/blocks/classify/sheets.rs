use walpha_base::UnionFind;

use super::rows::{Owned, Shelf, Side};
use super::{Local, State, even};

/// Sheets of the boundary: the corners of exterior cells, united.
///
/// A corner is a cell seen from one of its vertices: 4·cell + place. Corners of exterior cells that meet
/// at a vertex through an exterior facet lie in one sector of the space around that vertex; all that
/// a side of a boundary facet has, and those at both ends of a singular edge, lie on one sheet. A
/// block unites corners at its own points only: at others not all is known to it, and the blocks
/// that own them will say.
pub(super) struct Sheets {
    /// The number of each cell among those that are not inside.
    number: Vec<u32>,
    sets: UnionFind,
}

impl Sheets {
    pub(super) fn new(states: &[State]) -> Self {
        let mut count = 0;
        let number = |state: &State| {
            let number = count;
            count += u32::from(!state.is_inside() && !state.is_far());
            number
        };
        let number = states.iter().map(number).collect();
        Self { number, sets: UnionFind::new(4 * count as usize) }
    }

    fn at(&self, corner: u32) -> u32 {
        4 * self.number[corner as usize / 4] + corner % 4
    }

    pub(super) fn unite(&mut self, a: u32, b: u32) {
        self.sets.unite(self.at(a), self.at(b));
    }

    /// Replaces corners by the numbers of their sheets, from 0 in order of appearance.
    pub(super) fn number(mut self, owned: &mut Owned) {
        const NONE: u32 = u32::MAX;
        let mut names = vec![NONE; self.sets.members()];
        let mut count = 0;
        let shared = owned.shared.iter_mut().map(|side| &mut side.sheet);
        let Shelf { facet_sheets, edge_sheets, .. } = &mut owned.rows;
        for corner in facet_sheets.iter_mut().chain(edge_sheets).chain(shared) {
            let at = self.at(*corner);
            let name = &mut names[self.sets.find(at) as usize];
            if *name == NONE {
                *name = count;
                count += 1;
            }
            *corner = *name;
        }
        owned.sheets = count;
    }
}

impl Local<'_> {
    /// Around each owned vertex of an exterior facet, the cells on both sides are in one sector.
    pub(super) fn pass(&self, here: u32, there: u32, sheets: &mut Sheets) {
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

    /// An owned corner of an exterior cell on the side it has of a facet.
    pub(super) fn corner(&self, side: u32) -> u32 {
        let cell = self.cells[side as usize / 4];
        let owned = (1..4).map(|step| (side + step) % 4).find(|&k| self.owned(cell[k as usize]));
        side / 4 * 4 + owned.expect("an owned point on each facet that is asked about")
    }

    /// One side of a boundary facet is on one sheet; other blocks may know it too.
    pub(super) fn join_side(&self, side: u32, sheets: &mut Sheets, owned: &mut Owned) {
        let cell = self.cells[side as usize / 4];
        let mut places = [1, 2, 3].map(|step| (side as usize + step) % 4);
        let own = places.iter().filter(|&&k| self.owned(cell[k])).count();
        // Seen across from two owned points, and not known well here.
        if own == 0 {
            return;
        }
        let first = self.corner(side);
        for &k in places.iter().filter(|&&k| self.owned(cell[k])) {
            sheets.unite(first, side / 4 * 4 + k as u32);
        }
        if own == 3 {
            return;
        }
        places.sort_unstable_by_key(|&k| self.input(cell[k]));
        let [a, b, c] = places;
        let simplex = places.map(|k| self.input(cell[k]));
        let windings = self.block.windings(cell[a]);
        let side = u32::from(even(a, b, c));
        owned.shared.push(Side { simplex, side, sheet: first, windings });
    }
}
