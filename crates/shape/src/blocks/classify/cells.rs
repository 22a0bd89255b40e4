use super::local::Local;
use super::rows::Owned;
use super::sheets::Sheets;
use super::state::State;
use crate::Class;

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
