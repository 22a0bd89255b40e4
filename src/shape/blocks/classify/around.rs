use super::rows::{Owned, Side};
use super::{Local, Sheets, Stars, State, even};
use crate::shape::{Class, UnionFind};

/// Goes around one point after the other.
pub(super) struct Walker<'a> {
    local: &'a Local<'a>,
    states: &'a [State],
    stars: &'a Stars,
    sheets: &'a mut Sheets,
    owned: &'a mut Owned,
    /// Points united by edges.
    components: UnionFind,
    /// By vertex: its place among the neighbours of the point in hand.
    places: Vec<u32>,
    neighbours: Vec<Neighbour>,
    cells: Vec<([u32; 3], Class)>,
    facets: Vec<FacetRow>,
    edges: Vec<EdgeRow>,
}

/// A neighbour of the point in hand, with what the facets at their edge say.
struct Neighbour {
    to: u32,
    /// Whether one of the facets is in the shape, whether one is not interior.
    covered: bool,
    open: bool,
}

/// A facet that the point in hand is the smallest vertex of.
struct FacetRow {
    /// The two other vertices.
    row: [u32; 2],
    /// Whether the point and these turn clockwise seen from the cell's fourth corner.
    clockwise: bool,
    /// 4·cell + corner opposite.
    side: u32,
}

/// An edge that the point in hand is the smallest vertex of.
struct EdgeRow {
    to: u32,
    class: Class,
    /// Of a singular edge: a corner at the point in hand.
    corner: u32,
}

const NOWHERE: u32 = u32::MAX;

impl<'a> Walker<'a> {
    pub fn new(
        local: &'a Local<'a>,
        states: &'a [State],
        stars: &'a Stars,
        sheets: &'a mut Sheets,
        owned: &'a mut Owned,
    ) -> Self {
        let points = local.block.input.len();
        Self {
            local,
            states,
            stars,
            sheets,
            owned,
            components: UnionFind::new(points),
            places: vec![NOWHERE; points],
            neighbours: Vec::new(),
            cells: Vec::new(),
            facets: Vec::new(),
            edges: Vec::new(),
        }
    }

    /// The point's class, and the simplices it is the smallest vertex of.
    pub fn visit(&mut self, v: u32) {
        self.owned.begin();
        let star = self.stars.of(v);
        if star.is_empty() {
            self.owned.vertices.push(None);
            return;
        }
        let covered = self.meet(v, star);
        self.give_cells();
        self.give_facets();
        self.give_edges(v, star);
        let class = if star.iter().all(|&at| self.states[at as usize / 4].is_inside()) {
            Class::Interior
        } else if covered {
            Class::Regular
        } else {
            self.lone_vertex(v, star)
        };
        self.owned.vertices.push(Some(class));
        for neighbour in self.neighbours.drain(..) {
            self.places[neighbour.to as usize] = NOWHERE;
        }
    }

    /// Ends the rows of the last point; gives the components.
    pub fn finish(self) -> UnionFind {
        self.owned.begin();
        self.components
    }

    /// One walk around the point: its neighbours with what the facets say of the edges to them, the cells
    /// and the facets that it is the smallest vertex of. Says whether one of the facets around it is
    /// in the shape.
    fn meet(&mut self, v: u32, star: &[u32]) -> bool {
        let smallest = self.local.input(v);
        let mut covered = 0;
        for &at in star {
            let (cell, k) = (at / 4, at as usize % 4);
            let state = self.states[cell as usize];
            if state.is_infinite() {
                continue;
            }
            let corners = self.local.mesh.cells()[cell as usize];
            let places = [(k + 1) % 4, (k + 2) % 4, (k + 3) % 4];
            let others = places.map(|place| corners[place]);
            let ranks = others.map(|u| self.local.input(u));
            let opposite = places.map(|place| 1 << (2 * place));
            let (in_shape, open) = (state.covered(), state.open());
            covered |= in_shape & (opposite[0] | opposite[1] | opposite[2]);
            for j in 0..3 {
                // The facets at the edge are opposite the two other corners.
                let facets = opposite[(j + 1) % 3] | opposite[(j + 2) % 3];
                let neighbour = self.neighbour(others[j]);
                neighbour.covered |= in_shape & facets != 0;
                neighbour.open |= open & facets != 0;
                let (b, d) = ((j + 1) % 3, (j + 2) % 3);
                if state.gives(places[j]) && smallest < ranks[b].min(ranks[d]) {
                    let (b, d) = if ranks[b] < ranks[d] { (b, d) } else { (d, b) };
                    let clockwise = !even(k, places[b], places[d]);
                    let side = 4 * cell + places[j] as u32;
                    self.facets.push(FacetRow { row: [ranks[b], ranks[d]], clockwise, side });
                }
            }
            if smallest < ranks[0].min(ranks[1]).min(ranks[2])
                && (state.is_inside() || self.local.exterior)
            {
                self.cells.push(cell_row(k, ranks, state));
            }
        }
        covered != 0
    }

    fn neighbour(&mut self, u: u32) -> &mut Neighbour {
        let place = &mut self.places[u as usize];
        if *place == NOWHERE {
            *place = self.neighbours.len() as u32;
            self.neighbours.push(Neighbour { to: u, covered: false, open: false });
        }
        &mut self.neighbours[*place as usize]
    }

    fn give_cells(&mut self) {
        self.cells.sort_unstable_by_key(|cell| cell.0);
        for (row, class) in self.cells.drain(..) {
            self.owned.cells.push(row, class);
        }
    }

    fn give_facets(&mut self) {
        let class = |facet: &FacetRow| {
            let cell = self.states[facet.side as usize / 4];
            (cell.facet(facet.side as usize % 4), cell.is_inside())
        };
        for facet in &mut self.facets {
            // A regular facet turns counter-clockwise seen from outside.
            if class(facet) == (Class::Regular, !facet.clockwise) {
                facet.row.swap(0, 1);
            }
        }
        self.facets.sort_unstable_by_key(|facet| facet.row);
        for facet in &self.facets {
            let (class, inside) = class(facet);
            self.owned.facets.push(facet.row, class);
            let beyond =
                || self.local.mesh.beside()[facet.side as usize / 4][facet.side as usize % 4];
            match class {
                Class::Regular => {
                    let outside = if inside { beyond() } else { facet.side };
                    self.owned.facet_sheets.push(self.local.corner(outside));
                }
                Class::Singular => {
                    let mut sides = [facet.side, beyond()].map(|side| self.local.corner(side));
                    if !facet.clockwise {
                        sides.swap(0, 1);
                    }
                    self.owned.facet_sheets.extend(sides);
                }
                Class::Exterior | Class::Interior => {}
            }
        }
        self.facets.clear();
    }

    fn give_edges(&mut self, v: u32, star: &[u32]) {
        let smallest = self.local.input(v);
        for neighbour in &self.neighbours {
            let to = self.local.input(neighbour.to);
            // An edge between two blocks is joined to its sheet at both ends.
            if to < smallest && self.local.owned(neighbour.to) {
                continue;
            }
            let mut corner = NOWHERE;
            let class = if !neighbour.open {
                Class::Interior
            } else if neighbour.covered {
                Class::Regular
            } else if let Some(at) = self.lone_edge(v, neighbour.to, star) {
                corner = at;
                Class::Singular
            } else {
                Class::Exterior
            };
            if class == Class::Singular {
                join_ends(self.local, self.sheets, self.owned, [v, neighbour.to], corner);
            }
            if to > smallest && (class != Class::Exterior || self.local.exterior) {
                self.edges.push(EdgeRow { to, class, corner });
                if class != Class::Exterior {
                    self.components.unite(v, neighbour.to);
                }
            }
        }
        self.edges.sort_unstable_by_key(|edge| edge.to);
        for EdgeRow { to, class, corner } in self.edges.drain(..) {
            self.owned.edges.push([to], class);
            if class == Class::Singular {
                self.owned.edge_sheets.push(corner);
            }
        }
    }

    /// Whether an edge that no facet covers is singular; then a corner at its first end.
    fn lone_edge(&self, v: u32, u: u32, star: &[u32]) -> Option<u32> {
        let local = self.local;
        if !local.fits([v, u]) {
            return None;
        }
        let mut corner = None;
        for &at in star {
            let cell = local.mesh.cells()[at as usize / 4];
            if !cell.contains(&u) {
                continue;
            }
            let others = cell.into_iter().filter(|&x| x != v && x != u && x != local.mesh.ghost());
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
        for neighbour in &self.neighbours {
            if self.lone_edge(v, neighbour.to, star).is_some() {
                return Class::Regular;
            }
            refuted |= self.local.predicates.inside([v], neighbour.to);
        }
        if !refuted && self.local.fits([v]) { Class::Singular } else { Class::Exterior }
    }
}

/// A cell without its smallest vertex, at place `k`, in the order that makes it positively oriented.
#[inline(always)]
fn cell_row(k: usize, mut row: [u32; 3], state: State) -> ([u32; 3], Class) {
    // Rotating a row of four is odd, and so is each exchange.
    let mut odd = k % 2 == 1;
    for (a, b) in [(0, 1), (1, 2), (0, 1)] {
        if row[a] > row[b] {
            row.swap(a, b);
            odd = !odd;
        }
    }
    if odd {
        row.swap(1, 2);
    }
    (row, if state.is_inside() { Class::Interior } else { Class::Exterior })
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
        let cell = local.mesh.cells()[corner as usize / 4];
        let place = cell.iter().position(|&w| w == u).expect("a cell at the edge");
        sheets.unite(corner, corner / 4 * 4 + place as u32);
    } else {
        let (a, b) = (local.input(v), local.input(u));
        let (low, high) = (a.min(b), a.max(b));
        owned.shared.push(Side { simplex: [low, high, high], side: 0, sheet: corner });
    }
}
