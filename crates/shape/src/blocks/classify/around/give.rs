//! The simplices that the point in hand is the smallest vertex of, given as rows in order.

use super::super::rows::{Long, Owned, Side};
use super::super::{Local, Sheets};
use super::{COVERED, OPEN, Walker};
use crate::Class;

/// A cell that the point in hand is the smallest vertex of.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct CellRow {
    /// The three other vertices in the order that makes it positively oriented, two in one number.
    first_two: u64,
    third: u32,
    inside: bool,
}

/// A facet that the point in hand is the smallest vertex of.
#[derive(Clone, Copy, Default)]
pub(super) struct FacetRow {
    /// The two other vertices in one number.
    pub row: u64,
    /// 4·cell + corner opposite.
    pub side: u32,
    /// Whether the point and these turn clockwise seen from the cell's fourth corner.
    pub clockwise: bool,
}

/// An edge that the point in hand is the smallest vertex of.
pub(super) struct EdgeRow {
    to: u32,
    class: Class,
    /// Of a singular edge: a corner at the point in hand.
    corner: u32,
}

const NOWHERE: u32 = u32::MAX;

impl CellRow {
    /// A cell without its smallest vertex, which is at place `k`; the others follow it.
    #[inline(always)]
    pub(super) fn new(k: usize, [mut a, mut b, mut c]: [u32; 3], inside: bool) -> Self {
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
    pub(super) fn give_cells(&mut self, count: usize) {
        let rows = &mut self.owned.rows;
        let cells = &mut self.cells[..count];
        cells.sort_unstable();
        for cell in cells {
            let class = if cell.inside { Class::Interior } else { Class::Exterior };
            let [first, second] = pair(cell.first_two);
            rows.cells.push([first, second, cell.third], class);
        }
    }

    pub(super) fn give_facets(&mut self, count: usize) {
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

    pub(super) fn give_edges(&mut self, v: u32, star: &[u32]) {
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
