use super::{Local, Owned, Sheets};
use crate::Class;

/// The state of a cell in 16 bits: the class of the facet opposite each corner (bits 2·corner and 2·corner + 1),
/// three flags, and whether each facet is emitted from this cell (bits 12 + corner).
#[derive(Clone, Copy, Default)]
pub(super) struct State(u16);

impl State {
    /// The lower bits of the classes of all facets.
    const LOW_BITS: u16 = 0b0101_0101;
    const INSIDE: u16 = 0x100;
    const INFINITE: u16 = 0x200;
    const FOREIGN: u16 = 0x400;
    const EMITS: usize = 12;

    #[inline(always)]
    pub(super) fn is_inside(self) -> bool {
        self.0 & Self::INSIDE != 0
    }

    #[inline(always)]
    pub(super) fn is_infinite(self) -> bool {
        self.0 & Self::INFINITE != 0
    }

    /// Whether none of its corners is the block's own, so that the block needs nothing of it.
    #[inline(always)]
    pub(super) fn is_foreign(self) -> bool {
        self.0 & Self::FOREIGN != 0
    }

    /// The class of the facet opposite a corner.
    #[inline(always)]
    pub(super) fn facet(self, opposite: usize) -> Class {
        Class::ALL[usize::from(self.0 >> (2 * opposite) & 3)]
    }

    /// Bits 2·opposite for the facets that are in the shape.
    #[inline(always)]
    pub(super) fn covered(self) -> u16 {
        (self.0 | self.0 >> 1) & Self::LOW_BITS
    }

    /// Bits 2·opposite for the facets that are not interior.
    #[inline(always)]
    pub(super) fn open(self) -> u16 {
        (self.0 >> 1 | !self.0) & Self::LOW_BITS
    }

    /// Whether a facet is emitted from this one of its two cells.
    #[inline(always)]
    pub(super) fn emits(self, opposite: usize) -> bool {
        self.0 >> (Self::EMITS + opposite) & 1 != 0
    }

    /// Number of facets emitted from this cell.
    pub(super) fn emitted(self) -> usize {
        (self.0 >> Self::EMITS).count_ones() as usize
    }

    fn set_facet(&mut self, opposite: usize, class: Class) {
        self.0 |= (class as u16) << (2 * opposite);
    }

    fn set_emits(&mut self, opposite: usize) {
        self.0 |= 1 << (Self::EMITS + opposite);
    }
}

/// The regular and singular facets, each as 4·cell + corner from both sides: first that of the cell that it is
/// emitted from. Ascending. Replaces the adjacency of cells once facets are classified.
#[derive(Default)]
pub(super) struct Boundary(Vec<(u32, u32)>);

impl Boundary {
    /// 4·cell + corner on the other side of a facet, by that of the cell that it is emitted from.
    pub(super) fn beyond(&self, side: u32) -> u32 {
        let found = self.0.binary_search_by_key(&side, |facet| facet.0);
        self.0[found.expect("a facet on the boundary")].1
    }
}

impl Local<'_> {
    pub(super) fn classify_cells(&self) -> Vec<State> {
        let ghost = self.ghost;
        let state = |&cell: &[u32; 4]| {
            if !cell.iter().any(|&v| self.owned(v)) {
                State(State::FOREIGN)
            } else if cell.contains(&ghost) {
                State(State::INFINITE)
            } else if self.fits(cell) {
                State(State::INSIDE)
            } else {
                State(0)
            }
        };
        self.cells.iter().map(state).collect()
    }

    /// Classifies each facet with an owned vertex, and unites the corners of exterior cells that it shows to be on
    /// one sheet.
    pub(super) fn classify_facets(
        &self,
        neighbors: &[[u32; 4]],
        states: &mut [State],
        sheets: &mut Sheets,
        owned: &mut Owned,
    ) -> Boundary {
        let mut boundary = Boundary::default();
        for cell in 0..states.len() as u32 {
            let state = states[cell as usize];
            if state.is_foreign() {
                continue;
            }
            let across = neighbors[cell as usize];
            for (here, there) in (4 * cell..).zip(across) {
                let next = states[there as usize / 4];
                // Each pair once. No facet of a foreign cell has an owned vertex.
                if there < here || next.is_foreign() {
                    continue;
                }
                let class = match (state.is_inside(), next.is_inside()) {
                    (true, true) => Class::Interior,
                    (false, false) => self.classify_dangling_facet(here, there),
                    _ => Class::Regular,
                };
                states[cell as usize].set_facet(here as usize % 4, class);
                states[there as usize / 4].set_facet(there as usize % 4, class);
                if class != Class::Exterior || self.exterior {
                    // One of the two cells at a finite facet is finite.
                    let (emitter, other) =
                        if state.is_infinite() { (there, here) } else { (here, there) };
                    states[emitter as usize / 4].set_emits(emitter as usize % 4);
                    if matches!(class, Class::Regular | Class::Singular) {
                        boundary.0.push((emitter, other));
                    }
                }
                match class {
                    Class::Interior => {}
                    Class::Exterior => self.unite_across(here, there, sheets),
                    Class::Regular | Class::Singular => {
                        for (side, state) in [(here, state), (there, next)] {
                            if !state.is_inside() {
                                self.unite_side(side, sheets, owned);
                            }
                        }
                    }
                }
            }
        }
        boundary.0.sort_unstable();
        boundary
    }

    /// A facet between two cells that are not in the shape: 4·cell + corner on both sides.
    fn classify_dangling_facet(&self, here: u32, there: u32) -> Class {
        let ghost = self.ghost;
        let facet = self.facet(here);
        if facet.contains(&ghost) || !self.fits(facet) {
            return Class::Exterior;
        }
        // In a regular triangulation, a smallest orthogonal sphere of a facet that contains any point contains one
        // of the two vertices opposite the facet.
        let apex = |side: u32| self.cells[side as usize / 4][side as usize % 4];
        let contains_apex = [here, there]
            .into_iter()
            .map(apex)
            .any(|v| v != ghost && self.predicates.inside(facet, v));
        if contains_apex { Class::Exterior } else { Class::Singular }
    }

    /// The vertices of a facet, by 4·cell + corner opposite.
    #[inline(always)]
    pub(super) fn facet(&self, side: u32) -> [u32; 3] {
        let (cell, opposite) = (self.cells[side as usize / 4], side as usize % 4);
        [cell[(opposite + 1) % 4], cell[(opposite + 2) % 4], cell[(opposite + 3) % 4]]
    }
}
