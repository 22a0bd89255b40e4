//! One walk around each point, and the classes of the point and of its edges.

use walpha_base::UnionFind;

use super::rows::{Long, Owned, Side};
use super::{Boundary, Local, Sheets, State, even};
use crate::Class;

/// The cells around each owned vertex, as 4·cell + the vertex's place in it.
pub(super) struct Stars {
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl Stars {
    /// Looks for the vertices below `own`. O(cells).
    pub(super) fn new(cells: &[[u32; 4]], own: u32, states: &[State]) -> Self {
        let near = || {
            let all = (0u32..).step_by(4).zip(cells).zip(states);
            all.filter(|(_, state)| !state.is_far()).map(|(cell, _)| cell)
        };
        // Where the star of a vertex ends, kept one further on; then, as stars fill, where it begins.
        let mut starts = vec![0; own as usize + 2];
        for v in near().flat_map(|(_, cell)| cell).filter(|&&v| v < own) {
            starts[*v as usize + 2] += 1;
        }
        for v in 2..starts.len() {
            starts[v] += starts[v - 1];
        }
        let mut corners = vec![0; starts[own as usize + 1] as usize];
        for (first, cell) in near() {
            for (corner, &v) in (first..).zip(cell) {
                if v < own {
                    let at = &mut starts[v as usize + 1];
                    corners[*at as usize] = corner;
                    *at += 1;
                }
            }
        }
        Self { starts, corners }
    }

    /// The star of a vertex, ascending; empty if the point is hidden.
    pub(super) fn of(&self, v: u32) -> &[u32] {
        let v = v as usize;
        &self.corners[self.starts[v] as usize..self.starts[v + 1] as usize]
    }
}

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

/// A cell that the point in hand is the smallest vertex of.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct CellRow {
    /// The three other vertices in the order that makes it positively oriented, two in one number.
    first_two: u64,
    third: u32,
    inside: bool,
}

/// A facet that the point in hand is the smallest vertex of.
#[derive(Clone, Copy, Default)]
struct FacetRow {
    /// The two other vertices in one number.
    pub row: u64,
    /// 4·cell + corner opposite.
    pub side: u32,
    /// Whether the point and these turn clockwise seen from the cell's fourth corner.
    pub clockwise: bool,
}

/// An edge that the point in hand is the smallest vertex of.
struct EdgeRow {
    to: u32,
    class: Class,
    /// Of a singular edge: a corner at the point in hand.
    corner: u32,
}

const NOWHERE: u32 = u32::MAX;

impl CellRow {
    /// A cell without its smallest vertex, which is at place `k`; the others follow it.
    #[inline(always)]
    fn new(k: usize, [mut a, mut b, mut c]: [u32; 3], inside: bool) -> Self {
        // Rotating a row of four is odd, and so is each exchange.
        let mut odd = k % 2 == 1;
        let mut order = |x: &mut u32, y: &mut u32| {
            odd ^= *x > *y;
            (*x, *y) = ((*x).min(*y), (*x).max(*y));
        };
        order(&mut a, &mut b);
        order(&mut b, &mut c);
        order(&mut a, &mut b);
        let (second, third) = if odd { (c, b) } else { (b, c) };
        Self { first_two: u64::from(a) << 32 | u64::from(second), third, inside }
    }
}

impl Walker<'_> {
    fn give_cells(&mut self, count: usize) {
        let rows = &mut self.owned.rows;
        let cells = &mut self.cells[..count];
        cells.sort_unstable();
        for cell in cells {
            let class = if cell.inside { Class::Interior } else { Class::Exterior };
            let [first, second] = pair(cell.first_two);
            rows.cells.push([first, second, cell.third], class);
        }
    }

    fn give_facets(&mut self, count: usize) {
        let facets = &mut self.facets[..count];
        for facet in &mut *facets {
            let state = self.states[facet.side as usize / 4];
            let class = state.facet(facet.side as usize % 4);
            // A regular facet turns counter-clockwise seen from outside.
            if class == Class::Regular && facet.clockwise != state.is_inside() {
                facet.row = facet.row.rotate_left(32);
            }
        }
        facets.sort_unstable_by_key(|facet| facet.row);
        let rows = &mut self.owned.rows;
        for facet in facets {
            let state = self.states[facet.side as usize / 4];
            let class = state.facet(facet.side as usize % 4);
            rows.facets.push(pair(facet.row), class);
            if matches!(class, Class::Exterior | Class::Interior) {
                continue;
            }
            let beyond = self.boundary.beyond(facet.side);
            if class == Class::Regular {
                let outside = if state.is_inside() { beyond } else { facet.side };
                rows.facet_sheets.push(self.local.corner(outside));
            } else {
                let sides = [self.local.corner(facet.side), self.local.corner(beyond)];
                let [front, back] = if facet.clockwise { sides } else { [sides[1], sides[0]] };
                rows.facet_sheets.extend([front, back]);
            }
        }
    }

    fn give_edges(&mut self, v: u32, star: &[u32]) {
        let smallest = self.local.input(v);
        for &neighbour in &self.neighbours[..self.near] {
            let to = self.local.input(neighbour);
            // An edge between two blocks is joined to its sheet at both ends.
            if to < smallest && self.local.owned(neighbour) {
                continue;
            }
            let says = self.met[neighbour as usize];
            let mut corner = NOWHERE;
            let class = if says & OPEN == 0 {
                Class::Interior
            } else if says & COVERED != 0 {
                Class::Regular
            } else if let Some(at) = self.lone_edge(v, neighbour, star) {
                corner = at;
                Class::Singular
            } else {
                Class::Exterior
            };
            if (class != Class::Exterior || self.local.exterior)
                && self.local.is_long([v, neighbour])
            {
                let ends = [v, neighbour].map(|v| self.local.block.positions[v as usize]);
                self.owned.long = Some(Long { edge: [smallest, to], ends });
            }
            if class == Class::Singular {
                join_ends(self.local, self.sheets, self.owned, [v, neighbour], corner);
            }
            if to > smallest && (class != Class::Exterior || self.local.exterior) {
                self.edges.push(EdgeRow { to, class, corner });
            }
            if class != Class::Exterior {
                self.components.unite(v, neighbour);
                if !self.local.owned(neighbour) {
                    self.owned.border.extend([to, smallest]);
                }
            }
        }
        self.edges.sort_unstable_by_key(|edge| edge.to);
        let rows = &mut self.owned.rows;
        for EdgeRow { to, class, corner } in self.edges.drain(..) {
            rows.edges.push([to], class);
            if class == Class::Singular {
                rows.edge_sheets.push(corner);
            }
        }
    }
}

/// Two vertices out of one number.
#[inline(always)]
fn pair(row: u64) -> [u32; 2] {
    [(row >> 32) as u32, row as u32]
}

/// The space around a singular edge is one piece, from end to end.
fn join_ends(
    local: &Local<'_>,
    sheets: &mut Sheets,
    owned: &mut Owned,
    [v, u]: [u32; 2],
    corner: u32,
) {
    if local.owned(u) {
        let cell = local.cells[corner as usize / 4];
        let place = cell.iter().position(|&w| w == u).expect("a cell at the edge");
        sheets.unite(corner, corner / 4 * 4 + place as u32);
    } else {
        let ends = if local.input(v) < local.input(u) { [v, u] } else { [u, v] };
        let [low, high] = ends.map(|end| local.input(end));
        let windings = local.block.windings(ends[0]);
        owned.shared.push(Side { simplex: [low, high, high], side: 0, sheet: corner, windings });
    }
}
