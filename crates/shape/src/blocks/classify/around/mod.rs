//! One walk around each point, and the classes of the point and of its edges.

mod give;

use walpha_base::UnionFind;

use super::rows::Owned;
use super::{Boundary, Local, Sheets, Stars, State, even};
use crate::Class;
use give::{CellRow, EdgeRow, FacetRow};

/// Goes around one point after the other.
pub(super) struct Walker<'a> {
    local: &'a Local<'a>,
    states: &'a [State],
    stars: &'a Stars,
    boundary: &'a Boundary,
    sheets: &'a mut Sheets,
    owned: &'a mut Owned,
    /// Points united by edges.
    components: UnionFind,
    /// By vertex: 4·v + what the facets at its edge say ([`COVERED`], [`OPEN`]), if it is a neighbour of
    /// the point v that was last in hand when it was met.
    met: Vec<u32>,
    neighbours: Vec<u32>,
    /// How many there are.
    near: usize,
    cells: Vec<CellRow>,
    facets: Vec<FacetRow>,
    edges: Vec<EdgeRow>,
}

/// One of the facets at an edge is in the shape.
const COVERED: u32 = 1;
/// One of the facets at an edge is not interior.
const OPEN: u32 = 2;

impl<'a> Walker<'a> {
    pub(super) fn new(
        local: &'a Local<'a>,
        states: &'a [State],
        stars: &'a Stars,
        boundary: &'a Boundary,
        sheets: &'a mut Sheets,
        owned: &'a mut Owned,
    ) -> Self {
        let points = local.block.input.len();
        Self {
            local,
            states,
            stars,
            boundary,
            sheets,
            owned,
            components: UnionFind::new(points),
            // No vertex has the number that u32::MAX stands for.
            met: vec![u32::MAX; points],
            neighbours: Vec::new(),
            near: 0,
            cells: Vec::new(),
            facets: Vec::new(),
            edges: Vec::new(),
        }
    }

    /// The point's class, and the simplices it is the smallest vertex of.
    pub(super) fn visit(&mut self, v: u32) {
        self.owned.rows.begin();
        let star = self.stars.of(v);
        if star.is_empty() {
            self.owned.rows.vertices.push(None);
            return;
        }
        let covered = self.meet(v, star);
        self.give_edges(v, star);
        let class = if star.iter().all(|&at| self.states[at as usize / 4].is_inside()) {
            Class::Interior
        } else if covered {
            Class::Regular
        } else {
            self.lone_vertex(v, star)
        };
        self.owned.rows.vertices.push(Some(class));
    }

    /// Ends the rows of the last point; gives the components.
    pub(super) fn finish(self) -> UnionFind {
        self.owned.rows.begin();
        self.components
    }

    /// One walk around the point, nearly without branches, as these would be guessed wrong: its neighbours
    /// with what the facets say of the edges to them, the cells and the facets that it is the smallest
    /// vertex of. Says whether one of the facets around it is in the shape.
    fn meet(&mut self, v: u32, star: &[u32]) -> bool {
        let Self { local, states, met, neighbours, cells, facets, .. } = self;
        let input = &local.block.input[..];
        let smallest = input[v as usize];
        let most = star.len();
        if facets.len() < 3 * most {
            cells.resize(most, CellRow::default());
            facets.resize(3 * most, FacetRow::default());
            neighbours.resize(3 * most, 0);
        }
        let (mut covered, mut near, mut solid, mut flat) = (0, 0, 0, 0);
        for &at in star {
            let (cell, k) = (at / 4, at as usize % 4);
            let state = states[cell as usize];
            if state.is_infinite() {
                continue;
            }
            let corners = local.cells[cell as usize];
            let (p, q, r) = ((k + 1) % 4, (k + 2) % 4, (k + 3) % 4);
            let (a, b, c) = (corners[p], corners[q], corners[r]);
            let (x, y, z) = (input[a as usize], input[b as usize], input[c as usize]);
            let (in_shape, open) = (state.covered(), state.open());
            let (at_p, at_q, at_r) = (1 << (2 * p), 1 << (2 * q), 1 << (2 * r));
            covered |= in_shape & (at_p | at_q | at_r);
            // The facets at an edge are opposite the two other corners.
            for (u, facets) in [(a, at_q | at_r), (b, at_r | at_p), (c, at_p | at_q)] {
                let says = u32::from(in_shape & facets != 0) * COVERED
                    + u32::from(open & facets != 0) * OPEN;
                let met = &mut met[u as usize];
                let is_new = *met / 4 != v;
                let before = if is_new { 4 * v } else { *met };
                *met = before | says;
                neighbours[near] = u;
                near += usize::from(is_new);
            }
            for (opposite, (m, x), (n, y)) in
                [(p, (q, y), (r, z)), (q, (p, x), (r, z)), (r, (p, x), (q, y))]
            {
                let (m, low, n, high) = if x < y { (m, x, n, y) } else { (n, y, m, x) };
                let row = u64::from(low) << 32 | u64::from(high);
                let side = 4 * cell + opposite as u32;
                facets[flat] = FacetRow { row, side, clockwise: !even(k, m, n) };
                flat += usize::from(state.gives(opposite) && (smallest < low));
            }
            cells[solid] = CellRow::new(k, [x, y, z], state.is_inside());
            let wanted = state.is_inside() | local.exterior;
            solid += usize::from(wanted & (smallest < x.min(y).min(z)));
        }
        self.give_cells(solid);
        self.give_facets(flat);
        self.near = near;
        covered != 0
    }

    /// Whether an edge that no facet covers is singular; then a corner at its first end.
    fn lone_edge(&self, v: u32, u: u32, star: &[u32]) -> Option<u32> {
        let local = self.local;
        if !local.fits([v, u]) {
            return None;
        }
        let mut corner = None;
        for &at in star {
            let cell = local.cells[at as usize / 4];
            if !cell.contains(&u) {
                continue;
            }
            let others = cell.into_iter().filter(|&x| x != v && x != u && x != local.ghost);
            for x in others {
                if local.predicates.inside([v, u], x) {
                    return None;
                }
            }
            corner = Some(at);
        }
        corner
    }

    /// The class of a point that no facet of the shape touches.
    fn lone_vertex(&self, v: u32, star: &[u32]) -> Class {
        let mut refuted = false;
        for &neighbour in &self.neighbours[..self.near] {
            if self.lone_edge(v, neighbour, star).is_some() {
                return Class::Regular;
            }
            refuted |= self.local.predicates.inside([v], neighbour);
        }
        if !refuted && self.local.fits([v]) { Class::Singular } else { Class::Exterior }
    }
}
