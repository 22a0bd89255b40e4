use super::{Local, Owned, Sheets};
use crate::Class;

/// What is known of a cell: the classes of its facets, two bits each, three flags, and which of its
/// facets it gives out, a bit each.
#[derive(Clone, Copy, Default)]
pub(super) struct State(u16);

impl State {
    const INSIDE: u16 = 0x100;
    const INFINITE: u16 = 0x200;
    const FAR: u16 = 0x400;
    const GIVES: usize = 12;

    #[inline(always)]
    pub(super) fn is_inside(self) -> bool {
        self.0 & Self::INSIDE != 0
    }

    #[inline(always)]
    pub(super) fn is_infinite(self) -> bool {
        self.0 & Self::INFINITE != 0
    }

    /// Whether none of its corners is the block's own, so that it does not matter.
    #[inline(always)]
    pub(super) fn is_far(self) -> bool {
        self.0 & Self::FAR != 0
    }

    /// The class of the facet opposite a corner.
    #[inline(always)]
    pub(super) fn facet(self, opposite: usize) -> Class {
        Class::ALL[usize::from(self.0 >> (2 * opposite) & 3)]
    }

    /// Bits 2·opposite for the facets that are in the shape.
    #[inline(always)]
    pub(super) fn covered(self) -> u16 {
        (self.0 | self.0 >> 1) & 0x55
    }

    /// Bits 2·opposite for the facets that are not interior.
    #[inline(always)]
    pub(super) fn open(self) -> u16 {
        (self.0 >> 1 | !self.0) & 0x55
    }

    /// Whether it is this cell, of the two beside a facet, whose row the facet becomes.
    #[inline(always)]
    pub(super) fn gives(self, opposite: usize) -> bool {
        self.0 >> (Self::GIVES + opposite) & 1 != 0
    }

    /// How many rows it gives out.
    pub(super) fn given(self) -> usize {
        (self.0 >> Self::GIVES).count_ones() as usize
    }

    fn set_facet(&mut self, opposite: usize, class: Class) {
        self.0 |= (class as u16) << (2 * opposite);
    }

    fn set_gives(&mut self, opposite: usize) {
        self.0 |= 1 << (Self::GIVES + opposite);
    }
}

/// Both sides of the facets on the boundary, each 4·cell + corner, that of the cell that gives the facet
/// out first; ascending. All that is still asked of neighbours after the facets are classified.
#[derive(Default)]
pub(super) struct Boundary(Vec<(u32, u32)>);

impl Boundary {
    /// The other side of a facet that is given out.
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
                State(State::FAR)
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

    /// Classifies each facet that has an owned corner, and unites what it says of the outside.
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
            if state.is_far() {
                continue;
            }
            let across = neighbors[cell as usize];
            for (here, there) in (4 * cell..).zip(across) {
                let next = states[there as usize / 4];
                // Each pair once. No facet of a cell that is far has an owned corner.
                if there < here || next.is_far() {
                    continue;
                }
                let class = match (state.is_inside(), next.is_inside()) {
                    (true, true) => Class::Interior,
                    (false, false) => self.classify_lone_facet(here, there),
                    _ => Class::Regular,
                };
                states[cell as usize].set_facet(here as usize % 4, class);
                states[there as usize / 4].set_facet(there as usize % 4, class);
                if class != Class::Exterior || self.exterior {
                    // One of the two cells at a finite facet is finite.
                    let (giver, other) =
                        if state.is_infinite() { (there, here) } else { (here, there) };
                    states[giver as usize / 4].set_gives(giver as usize % 4);
                    if matches!(class, Class::Regular | Class::Singular) {
                        boundary.0.push((giver, other));
                    }
                }
                match class {
                    Class::Interior => {}
                    Class::Exterior => self.pass(here, there, sheets),
                    Class::Regular | Class::Singular => {
                        for (side, state) in [(here, state), (there, next)] {
                            if !state.is_inside() {
                                self.join_side(side, sheets, owned);
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
    fn classify_lone_facet(&self, here: u32, there: u32) -> Class {
        let ghost = self.ghost;
        let facet = self.facet(here);
        if facet.contains(&ghost) || !self.fits(facet) {
            return Class::Exterior;
        }
        // In a regular triangulation a sphere that holds a point holds one of the two beside it.
        let apex = |side: u32| self.cells[side as usize / 4][side as usize % 4];
        let held = [here, there]
            .into_iter()
            .map(apex)
            .any(|v| v != ghost && self.predicates.inside(facet, v));
        if held { Class::Exterior } else { Class::Singular }
    }

    /// The corners of a facet, of 4·cell + corner opposite.
    #[inline(always)]
    pub(super) fn facet(&self, side: u32) -> [u32; 3] {
        let (cell, opposite) = (self.cells[side as usize / 4], side as usize % 4);
        [cell[(opposite + 1) % 4], cell[(opposite + 2) % 4], cell[(opposite + 3) % 4]]
    }
}
