use walpha_base::parallel::prelude::*;

use super::CELLS;
use super::local::Local;
use super::records::Side;
use super::sheets::Sheets;
use super::state::{Kind, State};
use crate::Class;

/// The regular and singular facets, each as 4·cell + corner from both sides, starting with the cell that emits it. Ascending, in
/// chunks of [`CELLS`] cells. Replaces the adjacency of cells after facets are classified.
pub(super) struct Boundary(Vec<Vec<[u32; 2]>>);

impl Boundary {
    /// 4·cell + corner on the other side of a facet, from the side of the cell that emits it.
    pub(super) fn beyond(&self, side: u32) -> u32 {
        let facets = &self.0[side as usize / (4 * CELLS)];
        let found = facets.binary_search_by_key(&side, |facet| facet[0]);
        facets[found.expect("a facet on the boundary")][1]
    }
}

impl Local<'_> {
    pub(super) fn classify_cells(&self) -> Vec<Kind> {
        let at_infinity = self.at_infinity;
        let kind = |&cell: &[u32; 4]| {
            if !cell.iter().any(|&v| self.owned(v)) {
                Kind::Foreign
            } else if cell.contains(&at_infinity) {
                Kind::Infinite
            } else if self.fits(cell) {
                Kind::Inside
            } else {
                Kind::Outside
            }
        };
        self.cells.par_iter().with_min_len(CELLS).map(kind).collect()
    }

    /// Classifies each facet with an owned vertex, and unites the corners of exterior cells that it shows to be on one sheet.
    /// Also returns the sides of facets that other blocks share.
    pub(super) fn classify_facets(
        &self,
        neighbors: &[[u32; 4]],
        kinds: Vec<Kind>,
        sheets: &Sheets,
    ) -> (Vec<State>, Boundary, Vec<Side>) {
        // Start with each facet from its lower side, because neighbours may belong to another thread.
        let mut singular = vec![0; kinds.len()];
        let chunks = singular.par_chunks_mut(CELLS).enumerate().map(|(chunk, singular)| {
            let mut shared = Vec::new();
            for (cell, singular) in (chunk * CELLS..).zip(singular) {
                if kinds[cell] != Kind::Foreign {
                    let facets = (4 * cell as u32..).zip(neighbors[cell]);
                    *singular = self.unite_and_find_singular(facets, &kinds, sheets, &mut shared);
                }
            }
            shared
        });
        let shared = chunks.collect::<Vec<_>>().into_iter().flatten().collect();
        let mut states = vec![State::new(Kind::Foreign); kinds.len()];
        let chunks = states.par_chunks_mut(CELLS).enumerate().map(|(chunk, states)| {
            let mut boundary = Vec::new();
            for (cell, state) in (chunk * CELLS..).zip(states) {
                *state = self.state(cell, neighbors[cell], &kinds, &singular, &mut boundary);
            }
            boundary
        });
        let boundary = Boundary(chunks.collect());
        (states, boundary, shared)
    }

    /// Returns the singular facets of a cell as bits. `facets` are its facets as 4·cell + corner on both sides; only those for
    /// which the cell is the lower side count. Also unites the corners of exterior cells that the facets show to be on one sheet.
    fn unite_and_find_singular(
        &self,
        facets: impl Iterator<Item = (u32, u32)>,
        kinds: &[Kind],
        sheets: &Sheets,
        shared: &mut Vec<Side>,
    ) -> u8 {
        let mut singular = 0;
        for (here, there) in facets {
            let [kind, next] = [here, there].map(|side| kinds[side as usize / 4]);
            // No facet of a foreign cell has an owned vertex.
            if there < here || next == Kind::Foreign {
                continue;
            }
            let mut unite_side = |side| shared.extend(self.unite_side(side, sheets));
            match (kind == Kind::Inside, next == Kind::Inside) {
                (true, true) => {}
                (true, false) => unite_side(there),
                (false, true) => unite_side(here),
                (false, false) => {
                    if self.is_singular(here, there) {
                        singular |= 1 << (here % 4);
                        unite_side(here);
                        unite_side(there);
                    } else {
                        self.unite_across(here, there, sheets);
                    }
                }
            }
        }
        singular
    }

    /// The state of a cell with these sides across its facets, from the bits of singular facets at their lower sides.
    /// Notes the regular and singular facets that it emits.
    fn state(
        &self,
        cell: usize,
        across: [u32; 4],
        kinds: &[Kind],
        singular: &[u8],
        boundary: &mut Vec<[u32; 2]>,
    ) -> State {
        let kind = kinds[cell];
        let mut state = State::new(kind);
        if kind == Kind::Foreign {
            return state;
        }
        let mut emitted = 0;
        for (at, (here, there)) in (4 * cell as u32..).zip(across).enumerate() {
            let next = kinds[there as usize / 4];
            if next == Kind::Foreign {
                continue;
            }
            let lower = here.min(there);
            let class = match (kind == Kind::Inside, next == Kind::Inside) {
                (true, true) => Class::Interior,
                (false, false) if singular[lower as usize / 4] >> (lower % 4) & 1 == 0 => {
                    Class::Exterior
                }
                (false, false) => Class::Singular,
                _ => Class::Regular,
            };
            state.set_facet(at, class);
            // One of the two cells at a finite facet is finite.
            let emits = match (kind == Kind::Infinite, next == Kind::Infinite) {
                (false, false) => here < there,
                (infinite, _) => !infinite,
            };
            if emits && (class != Class::Exterior || self.exterior) {
                emitted |= 1 << at;
                if matches!(class, Class::Regular | Class::Singular) {
                    boundary.push([here, there]);
                }
            }
        }
        if kind != Kind::Infinite {
            let wanted = kind == Kind::Inside || self.exterior;
            state.emit(emitted, wanted, self.first_two(self.cells[cell]));
        }
        state
    }

    /// The corners of a cell at the two of its vertices that have the smallest input indices.
    #[inline(always)]
    fn first_two(&self, cell: [u32; 4]) -> [usize; 2] {
        let input = cell.map(|v| self.input(v));
        let by_input = |a: usize, b: usize| if input[b] < input[a] { [b, a] } else { [a, b] };
        let ([a, b], [c, d]) = (by_input(0, 1), by_input(2, 3));
        let [first, other] = by_input(a, c);
        let next = if first == a { b } else { d };
        [first, by_input(other, next)[0]]
    }

    /// Whether a facet between two cells that are not in the shape, 4·cell + corner on both sides, is in the shape.
    fn is_singular(&self, here: u32, there: u32) -> bool {
        let at_infinity = self.at_infinity;
        let facet = self.facet(here);
        if facet.contains(&at_infinity) || !self.fits(facet) {
            return false;
        }
        // In a regular triangulation, a smallest orthogonal sphere of a facet that contains any point contains one
        // of the two vertices opposite the facet.
        let apex = |side: u32| self.cells[side as usize / 4][side as usize % 4];
        ![here, there]
            .into_iter()
            .map(apex)
            .any(|v| v != at_infinity && self.predicates.inside(facet, v))
    }

    /// The vertices of a facet, by 4·cell + corner opposite.
    #[inline(always)]
    pub(super) fn facet(&self, side: u32) -> [u32; 3] {
        let (cell, opposite) = (self.cells[side as usize / 4], side as usize % 4);
        [cell[(opposite + 1) % 4], cell[(opposite + 2) % 4], cell[(opposite + 3) % 4]]
    }
}
