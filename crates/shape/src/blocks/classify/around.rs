//! One pass over the star of each point: the classes of the point and of its edges, and the rows of the simplices whose
//! smallest vertex it is.

use walpha_base::UnionFind;

use super::cells::Boundary;
use super::local::{Local, even};
use super::rows::{Long, Owned, Side};
use super::sheets::Sheets;
use super::state::State;
use crate::Class;

/// The star of each owned vertex: its cells, as 4·cell + the corner that is the vertex.
pub(super) struct Stars {
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl Stars {
    /// The stars of the vertices below `own`. O(cells).
    pub(super) fn new(cells: &[[u32; 4]], own: u32, states: &[State]) -> Self {
        let near = || {
            let all = (0u32..).step_by(4).zip(cells).zip(states);
            all.filter(|(_, state)| !state.is_foreign()).map(|(cell, _)| cell)
        };
        // `starts[v + 1]` is where the next corner of v is written; once all are, it is where the star of v ends.
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

/// Visits one own point after the other.
pub(super) struct Walker<'a> {
    local: &'a Local<'a>,
    states: &'a [State],
    stars: &'a Stars,
    boundary: &'a Boundary,
    sheets: &'a mut Sheets,
    owned: &'a mut Owned,
    /// The points, united along edges of the shape.
    components: UnionFind,
    /// By vertex u: 4·v + flags of the facets at the edge uv ([`COVERED`], [`OPEN`]), where v is the last point visited
    /// that has u as a neighbour.
    edge_flags: Vec<u32>,
    /// The neighbours of the point visited, followed by unused elements.
    neighbours: Vec<u32>,
    /// The number of its neighbours.
    degree: usize,
    /// Rows of the point visited, followed by unused elements.
    cells: Vec<CellRow>,
    facets: Vec<FacetRow>,
    edges: Vec<EdgeRow>,
}

/// Flag of an edge: one of its facets is in the shape.
const COVERED: u32 = 1;
/// Flag of an edge: one of its facets is not interior.
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
            // u32::MAX / 4 is no vertex.
            edge_flags: vec![u32::MAX; points],
            neighbours: Vec::new(),
            degree: 0,
            cells: Vec::new(),
            facets: Vec::new(),
            edges: Vec::new(),
        }
    }

    /// Emits the point's class, and the simplices whose smallest vertex it is.
    pub(super) fn visit(&mut self, v: u32) {
        self.owned.rows.begin();
        let star = self.stars.of(v);
        if star.is_empty() {
            self.owned.rows.vertices.push(None);
            return;
        }
        let covered = self.walk_star(v, star);
        self.emit_edges(v, star);
        let class = if star.iter().all(|&at| self.states[at as usize / 4].is_inside()) {
            Class::Interior
        } else if covered {
            Class::Regular
        } else {
            self.dangling_vertex(v, star)
        };
        self.owned.rows.vertices.push(Some(class));
    }

    /// Ends the rows of the last point, and returns the components.
    pub(super) fn finish(self) -> UnionFind {
        self.owned.rows.begin();
        self.components
    }

    /// One pass over the star of a point: its neighbours with the flags of the edges to them, and the cells and
    /// facets whose smallest vertex it is. Nearly without branches, which would be mispredicted. Returns whether a
    /// facet at the point is in the shape.
    ///
    /// In each cell of the star, v is corner k, and p, q, r are the other corners k + 1, k + 2, k + 3 modulo 4. The
    /// vertices there are a, b, c, with input indices x, y, z:
    ///
    /// ```text
    ///              v (k)             edge   facets at it     which are opposite
    ///             /|\                va     vab and vac      r and q
    ///            / | \               vb     vbc and vab      p and r
    ///           /  |  \              vc     vac and vbc      q and p
    ///          /   |   \
    ///    a (p)·····|·····c (r)       facet  opposite to it   other vertices (by input index)
    ///          \   |   /             vbc    p                y, z
    ///           \  |  /              vac    q                x, z
    ///            \ | /               vab    r                x, y
    ///              b (q)
    /// ```
    ///
    /// An edge at v is met once in each cell around it, so its flags accumulate over the star: after the pass they
    /// cover all of its facets. A facet at v is met from its two cells, and emitted from the one that
    /// [`State::emits`] names. A cell at v is met once. Facets and cells are emitted at their smallest vertex only.
    fn walk_star(&mut self, v: u32, star: &[u32]) -> bool {
        let Self { local, states, edge_flags, neighbours, cells, facets, .. } = self;
        let input = &local.block.input[..];
        let smallest = input[v as usize];
        let size = star.len();
        if facets.len() < 3 * size {
            cells.resize(size, CellRow::default());
            facets.resize(3 * size, FacetRow::default());
            neighbours.resize(3 * size, 0);
        }
        let (mut covered, mut degree, mut cell_count, mut facet_count) = (0, 0, 0, 0);
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
                let flags = u32::from(in_shape & facets != 0) * COVERED
                    + u32::from(open & facets != 0) * OPEN;
                let edge = &mut edge_flags[u as usize];
                let is_new = *edge / 4 != v;
                let before = if is_new { 4 * v } else { *edge };
                *edge = before | flags;
                neighbours[degree] = u;
                degree += usize::from(is_new);
            }
            for (opposite, (m, x), (n, y)) in
                [(p, (q, y), (r, z)), (q, (p, x), (r, z)), (r, (p, x), (q, y))]
            {
                let (m, low, n, high) = if x < y { (m, x, n, y) } else { (n, y, m, x) };
                let row = u64::from(low) << 32 | u64::from(high);
                let side = 4 * cell + opposite as u32;
                facets[facet_count] = FacetRow { row, side, clockwise: !even(k, m, n) };
                facet_count += usize::from(state.emits(opposite) && (smallest < low));
            }
            cells[cell_count] = CellRow::new(k, [x, y, z], state.is_inside());
            let wanted = state.is_inside() | local.exterior;
            cell_count += usize::from(wanted & (smallest < x.min(y).min(z)));
        }
        self.emit_cells(cell_count);
        self.emit_facets(facet_count);
        self.degree = degree;
        covered != 0
    }

    /// Whether an edge without a facet in the shape is singular: a corner 4·cell + corner at its first end, if so.
    fn dangling_edge(&self, v: u32, u: u32, star: &[u32]) -> Option<u32> {
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

    /// The class of a point without a facet in the shape.
    fn dangling_vertex(&self, v: u32, star: &[u32]) -> Class {
        let mut refuted = false;
        for &neighbour in &self.neighbours[..self.degree] {
            if self.dangling_edge(v, neighbour, star).is_some() {
                return Class::Regular;
            }
            refuted |= self.local.predicates.inside([v], neighbour);
        }
        if !refuted && self.local.fits([v]) { Class::Singular } else { Class::Exterior }
    }
}

/// A cell whose smallest vertex is the point visited. Rows sort by their vertices.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct CellRow {
    /// The three other vertices, by input index, in the order that makes the cell positively oriented; the first
    /// two in one number, the first in its upper half.
    first_two: u64,
    third: u32,
    inside: bool,
}

/// A facet whose smallest vertex is the point visited.
#[derive(Clone, Copy, Default)]
struct FacetRow {
    /// The two other vertices, by input index, in one number, the first in its upper half.
    pub row: u64,
    /// 4·cell + corner opposite.
    pub side: u32,
    /// Whether the point and these turn clockwise seen from the cell's fourth corner.
    pub clockwise: bool,
}

/// An edge whose smallest vertex is the point visited.
struct EdgeRow {
    to: u32,
    class: Class,
    /// Of a singular edge: 4·cell + corner at the point visited; else [`NO_CORNER`].
    corner: u32,
}

/// Stands for the absence of a corner.
const NO_CORNER: u32 = u32::MAX;

impl CellRow {
    /// A cell whose smallest vertex is corner `k`; the others are those that follow it cyclically.
    #[inline(always)]
    fn new(k: usize, [mut a, mut b, mut c]: [u32; 3], inside: bool) -> Self {
        // Rotating a row of four by one is an odd permutation, and so is each exchange.
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
    /// Emits the cells, sorted.
    fn emit_cells(&mut self, count: usize) {
        let rows = &mut self.owned.rows;
        let cells = &mut self.cells[..count];
        cells.sort_unstable();
        for cell in cells {
            let class = if cell.inside { Class::Interior } else { Class::Exterior };
            let [first, second] = pair(cell.first_two);
            rows.cells.push([first, second, cell.third], class);
        }
    }

    /// Emits the facets, sorted, with corners on their sheets.
    fn emit_facets(&mut self, count: usize) {
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
                rows.facet_sheets.push(self.local.owned_corner(outside));
            } else {
                let sides = [self.local.owned_corner(facet.side), self.local.owned_corner(beyond)];
                let [front, back] = if facet.clockwise { sides } else { [sides[1], sides[0]] };
                rows.facet_sheets.extend([front, back]);
            }
        }
    }

    /// Classifies the edges at a point, and emits those whose smallest vertex it is, sorted.
    fn emit_edges(&mut self, v: u32, star: &[u32]) {
        let smallest = self.local.input(v);
        for &neighbour in &self.neighbours[..self.degree] {
            let to = self.local.input(neighbour);
            // Edges between two blocks are visited from both ends, as each block unites its own corners only.
            if to < smallest && self.local.owned(neighbour) {
                continue;
            }
            let flags = self.edge_flags[neighbour as usize];
            let mut corner = NO_CORNER;
            let class = if flags & OPEN == 0 {
                Class::Interior
            } else if flags & COVERED != 0 {
                Class::Regular
            } else if let Some(at) = self.dangling_edge(v, neighbour, star) {
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
                unite_ends(self.local, self.sheets, self.owned, [v, neighbour], corner);
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

/// The two vertices packed in one number.
#[inline(always)]
fn pair(row: u64) -> [u32; 2] {
    [(row >> 32) as u32, row as u32]
}

/// Unites the corners at both ends of a singular edge, as the space around it is connected. Where the other end is
/// another block's, the edge is noted for the merge.
fn unite_ends(
    local: &Local<'_>,
    sheets: &mut Sheets,
    owned: &mut Owned,
    [v, u]: [u32; 2],
    corner: u32,
) {
    if local.owned(u) {
        let cell = local.cells[corner as usize / 4];
        let other = cell.iter().position(|&w| w == u).expect("a cell at the edge");
        sheets.unite(corner, corner / 4 * 4 + other as u32);
    } else {
        let ends = if local.input(v) < local.input(u) { [v, u] } else { [u, v] };
        let [low, high] = ends.map(|end| local.input(end));
        let windings = local.block.windings(ends[0]);
        owned.shared.push(Side { simplex: [low, high, high], side: 0, sheet: corner, windings });
    }
}
