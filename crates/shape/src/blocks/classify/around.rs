//! One pass over the star of each point: the classes of the point and of its edges, and the rows of the simplices whose
//! smallest vertex it is.

use walpha_base::UnionFind;

use super::cells::Boundary;
use super::local::{Local, even};
use super::records::{Buckets, Draft, Long, Records, Side};
use super::sheets::Sheets;
use super::stars::{RangeStars, Stars};
use super::state::State;
use crate::Class;

/// Walks around one own point after the other.
pub(super) struct Walker<'a> {
    pub local: &'a Local<'a>,
    pub states: &'a [State],
    pub boundary: &'a Boundary,
    pub sheets: &'a Sheets,
    /// The points, united along edges of the shape.
    pub components: &'a UnionFind,
    pub buckets: Buckets,
}

/// The results of walking around the points of a range.
#[derive(Default)]
pub(super) struct Walked {
    /// One element for each bucket.
    pub records: Vec<Records>,
    pub shared: Vec<Side>,
    pub border: Vec<u32>,
    pub long: Option<Long>,
}

/// The memory of a thread, used again for the next range.
pub(super) struct Worker {
    stars: RangeStars,
    /// For each vertex u: 4·v + flags of the facets at the edge uv ([`COVERED`], [`OPEN`]), where v is the last visited point
    /// that has u as a neighbour.
    edge_flags: Vec<u32>,
    /// The neighbours of the visited point, followed by unused elements.
    neighbours: Vec<u32>,
    /// The number of its neighbours.
    degree: usize,
    /// Rows of the visited point, followed by unused elements.
    cells: Vec<u128>,
    facets: Vec<FacetRow>,
    edges: Vec<EdgeRow>,
    draft: Draft,
    /// One element for each bucket.
    records: Vec<Records>,
}

impl Worker {
    pub(super) fn new(points: usize, buckets: Buckets) -> Self {
        Self {
            stars: RangeStars::default(),
            // u32::MAX / 4 is not a vertex.
            edge_flags: vec![u32::MAX; points],
            neighbours: Vec::new(),
            degree: 0,
            cells: Vec::new(),
            facets: Vec::new(),
            edges: Vec::new(),
            draft: Draft::default(),
            records: vec![Records::default(); buckets.count],
        }
    }
}

impl Walked {
    pub(super) fn points(&self) -> usize {
        self.records.iter().map(|records| records.points.len()).sum()
    }
}

/// Flag of an edge: one of its facets is in the shape.
const COVERED: u32 = 1;
/// Flag of an edge: one of its facets is not interior.
const OPEN: u32 = 2;

impl Walker<'_> {
    /// The classes of the points of a range, and the simplices whose smallest vertices they are.
    pub(super) fn walk(&self, stars: &Stars, range: usize, worker: &mut Worker) -> Walked {
        let mut walked = Walked::default();
        let mut around = std::mem::take(&mut worker.stars);
        for v in stars.sort(range, &mut around) {
            let class = self.visit(v, around.of(v), worker, &mut walked);
            let bucket = self.buckets.at(self.local.input(v));
            worker.records[bucket].push(class, &mut worker.draft);
        }
        worker.stars = around;
        // A copy, because lists that have grown have memory to spare.
        walked.records = worker.records.clone();
        worker.records.iter_mut().for_each(Records::clear);
        walked
    }

    /// Finds the point's class, and the simplices whose smallest vertex it is.
    fn visit(
        &self,
        v: u32,
        star: &[u32],
        worker: &mut Worker,
        walked: &mut Walked,
    ) -> Option<Class> {
        if star.is_empty() {
            return None;
        }
        let covered = self.walk_star(v, star, worker);
        self.emit_edges(v, star, worker, walked);
        Some(if star.iter().all(|&at| self.states[at as usize / 4].is_inside()) {
            Class::Interior
        } else if covered {
            Class::Regular
        } else {
            self.dangling_vertex(v, star, &worker.neighbours[..worker.degree])
        })
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
    fn walk_star(&self, v: u32, star: &[u32], worker: &mut Worker) -> bool {
        let Self { local, states, .. } = self;
        let Worker { edge_flags, neighbours, cells, facets, draft, .. } = &mut *worker;
        let input = &local.block.input[..];
        let size = star.len();
        if facets.len() < 3 * size {
            cells.resize(size, 0);
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
            let mut emitted = state.emitted(k);
            while emitted != 0 {
                let at = emitted.trailing_zeros() as usize;
                emitted &= emitted - 1;
                if at == k {
                    cells[cell_count] = cell_row(k, [x, y, z], state.is_inside());
                    cell_count += 1;
                    continue;
                }
                let (m, x, n, y) = match at {
                    at if at == p => (q, y, r, z),
                    at if at == q => (p, x, r, z),
                    _ => (p, x, q, y),
                };
                let (m, low, n, high) = if x < y { (m, x, n, y) } else { (n, y, m, x) };
                let row = u64::from(low) << 32 | u64::from(high);
                let side = 4 * cell + at as u32;
                facets[facet_count] = FacetRow { row, side, clockwise: !even(k, m, n) };
                facet_count += 1;
            }
        }
        emit_cells(&mut cells[..cell_count], draft);
        self.emit_facets(&mut facets[..facet_count], draft);
        worker.degree = degree;
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
            let others = cell.into_iter().filter(|&x| x != v && x != u && x != local.at_infinity);
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
    fn dangling_vertex(&self, v: u32, star: &[u32], neighbours: &[u32]) -> Class {
        let mut refuted = false;
        for &neighbour in neighbours {
            if self.dangling_edge(v, neighbour, star).is_some() {
                return Class::Regular;
            }
            refuted |= self.local.predicates.inside([v], neighbour);
        }
        if !refuted && self.local.fits([v]) { Class::Singular } else { Class::Exterior }
    }
}

/// A facet whose smallest vertex is the visited point.
#[derive(Clone, Copy, Default)]
struct FacetRow {
    /// The two other vertices, by input index, in one number, the first in its upper half.
    pub row: u64,
    /// 4·cell + corner opposite.
    pub side: u32,
    /// Whether the point and these turn clockwise, as seen from the cell's fourth corner.
    pub clockwise: bool,
}

/// An edge whose smallest vertex is the visited point.
struct EdgeRow {
    to: u32,
    class: Class,
    /// For a singular edge: 4·cell + corner at the visited point.
    corner: Option<u32>,
}

/// A cell whose smallest vertex, corner `k`, is the point visited, in one number: the three other vertices, which
/// follow it cyclically, by input index, in the order that makes the cell positively oriented, from the upper bits
/// down; then whether it is in the shape.
#[inline(always)]
fn cell_row(k: usize, [mut a, mut b, mut c]: [u32; 3], inside: bool) -> u128 {
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
    u128::from(a) << 96 | u128::from(second) << 64 | u128::from(third) << 32 | u128::from(inside)
}

/// Emits cells, sorted.
fn emit_cells(cells: &mut [u128], draft: &mut Draft) {
    cells.sort_unstable();
    for &mut row in cells {
        let class = if row & 1 == 1 { Class::Interior } else { Class::Exterior };
        draft.cell([96, 64, 32].map(|shift| (row >> shift) as u32), class);
    }
}

impl Walker<'_> {
    /// Emits facets, sorted, with corners on their sheets.
    fn emit_facets(&self, facets: &mut [FacetRow], draft: &mut Draft) {
        for facet in &mut *facets {
            let state = self.states[facet.side as usize / 4];
            let class = state.facet(facet.side as usize % 4);
            // A regular facet turns counter-clockwise seen from outside.
            if class == Class::Regular && facet.clockwise != state.is_inside() {
                facet.row = facet.row.rotate_left(32);
            }
        }
        facets.sort_unstable_by_key(|facet| facet.row);
        for facet in facets {
            let state = self.states[facet.side as usize / 4];
            let class = state.facet(facet.side as usize % 4);
            let row = pair(facet.row);
            if matches!(class, Class::Exterior | Class::Interior) {
                draft.facet(row, class, &[]);
                continue;
            }
            let beyond = self.boundary.beyond(facet.side);
            if class == Class::Regular {
                let outside = if state.is_inside() { beyond } else { facet.side };
                draft.facet(row, class, &[self.local.owned_corner(outside)]);
            } else {
                let mut sides = [facet.side, beyond].map(|side| self.local.owned_corner(side));
                if !facet.clockwise {
                    sides.reverse();
                }
                draft.facet(row, class, &sides);
            }
        }
    }

    /// Classifies the edges at a point, and emits those whose smallest vertex it is, sorted.
    fn emit_edges(&self, v: u32, star: &[u32], worker: &mut Worker, walked: &mut Walked) {
        let smallest = self.local.input(v);
        for &neighbour in &worker.neighbours[..worker.degree] {
            let to = self.local.input(neighbour);
            // Edges between two blocks are visited from both ends, because each block unites only its own corners.
            if to < smallest && self.local.owned(neighbour) {
                continue;
            }
            let flags = worker.edge_flags[neighbour as usize];
            let (class, corner) = if flags & OPEN == 0 {
                (Class::Interior, None)
            } else if flags & COVERED != 0 {
                (Class::Regular, None)
            } else {
                match self.dangling_edge(v, neighbour, star) {
                    None => (Class::Exterior, None),
                    corner => (Class::Singular, corner),
                }
            };
            if (class != Class::Exterior || self.local.exterior)
                && self.local.is_long([v, neighbour])
            {
                let ends = [v, neighbour].map(|v| self.local.block.positions[v as usize]);
                let long = Long { edge: [smallest, to], ends };
                walked.long = walked.long.into_iter().chain([long]).min_by_key(|long| long.edge);
            }
            if let Some(corner) = corner {
                walked.shared.extend(self.unite_ends([v, neighbour], corner));
            }
            if to > smallest && (class != Class::Exterior || self.local.exterior) {
                worker.edges.push(EdgeRow { to, class, corner });
            }
            if class != Class::Exterior {
                self.components.unite(v, neighbour);
                if !self.local.owned(neighbour) {
                    walked.border.extend([to, smallest]);
                }
            }
        }
        worker.edges.sort_unstable_by_key(|edge| edge.to);
        for EdgeRow { to, class, corner } in worker.edges.drain(..) {
            worker.draft.edge(to, class, corner);
        }
    }

    /// Unites the corners at both ends of a singular edge, because the space around it is connected. If the other end belongs to
    /// another block, returns the edge for the merge.
    fn unite_ends(&self, [v, u]: [u32; 2], corner: u32) -> Option<Side> {
        let local = self.local;
        if local.owned(u) {
            let cell = local.cells[corner as usize / 4];
            let other = cell.iter().position(|&w| w == u).expect("a cell at the edge");
            self.sheets.unite(corner, corner / 4 * 4 + other as u32);
            return None;
        }
        let ends = if local.input(v) < local.input(u) { [v, u] } else { [u, v] };
        let [low, high] = ends.map(|end| local.input(end));
        let windings = local.block.windings(ends[0]);
        Some(Side { simplex: [low, high, high], side: 0, sheet: corner, windings })
    }
}

/// The two vertices packed in one number.
#[inline(always)]
fn pair(row: u64) -> [u32; 2] {
    [(row >> 32) as u32, row as u32]
}
