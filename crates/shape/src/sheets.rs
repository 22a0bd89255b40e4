//! The sheets of a shape's boundary: the components of the boundary of a thin neighbourhood of the shape.
//!
//! Corners of exterior cells (infinite ones included) that meet at a point through an exterior facet are in one sector of
//! the space around that point; the corners on one side of a boundary facet, and those at both ends of a singular edge, are on
//! one sheet. One pass over the facets with a union-find over corners finds the sheets. A component with k voids has k + 1
//! sheets, so b2 = sheets − b0. This is local: a block unites only corners at its own points, and blocks agree on the
//! sheets that cross their borders by sides of facets. Of a whole triangulation that another program classified, the
//! sheets are found from their definition, on the finished complex, and the tests compare the two.

use walpha_base::UnionFind;
use walpha_base::parallel::prelude::*;
use walpha_complex::canonical::{smallest_even, sorted};

use super::complement::sides;
use super::{Class, Complex};

/// The sheets of a shape's boundary: the connected components of the boundary of a thin neighbourhood of the shape.
/// A component of the shape has one around it and one for each of its voids. Sheets are numbered from 0 in the order
/// of their first boundary facets, then of their first singular edges. The sheet of an isolated point has no number.
/// Its fields are public: this is plain data.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sheets {
    /// The sheet of each regular facet, in the order of the facets.
    pub regular: Vec<u32>,
    /// For each singular facet, in the order of the facets, the sheet from which its sorted row is seen turning clockwise, and
    /// the sheet on the other side.
    pub singular: Vec<[u32; 2]>,
    /// The sheet around each singular edge, in the order of the edges.
    pub edges: Vec<u32>,
    /// Number of numbered sheets.
    pub count: u32,
}

/// Stands for the absence of a number.
const UNNUMBERED: u32 = u32::MAX;

impl Sheets {
    /// The sheets of a shape within its *whole* triangulation in space, exterior simplices included, from their
    /// definition: two corners of exterior cells are on one sheet if they are at one vertex of the shape and their
    /// cells share an exterior facet there, or if they are at the two ends of an edge of the shape in one cell.
    /// O(n log n).
    pub(super) fn of_whole(whole: &Complex) -> Self {
        let mut outside = Outside::of(whole);
        let facets = outside.facets();
        let edges = outside.edges();
        let mut sheet = |corner: u32| outside.sets.find(corner);
        let facets: Vec<u32> = facets.into_iter().map(&mut sheet).collect();
        let edges: Vec<u32> = edges.into_iter().map(&mut sheet).collect();
        Self::numbered(whole, &facets, &edges)
    }

    /// Numbers sheets in the order of their first appearance, so that numbers do not depend on blocks. O(n). `facets` has one name for each regular facet and two for
    /// each singular one, in the order of the facets; `edges` has one for each singular edge.
    pub(super) fn numbered(complex: &Complex, facets: &[u32], edges: &[u32]) -> Self {
        let named = facets.iter().chain(edges);
        let mut numbers =
            vec![UNNUMBERED; named.clone().max().map_or(0, |&most| most as usize + 1)];
        let mut count = 0;
        let mut numbered = named.map(|&name| {
            let number = &mut numbers[name as usize];
            if *number == UNNUMBERED {
                *number = count;
                count += 1;
            }
            *number
        });
        let mut next = || numbered.next().expect("a name for each side of the boundary");
        let (mut regular, mut singular) = (Vec::new(), Vec::new());
        for class in complex.facets.classes() {
            match class {
                Class::Regular => regular.push(next()),
                Class::Singular => singular.push([next(), next()]),
                _ => {}
            }
        }
        let edges = numbered.collect();
        Self { regular, singular, edges, count }
    }

    /// Stands in files for the absence of a sheet.
    pub const NONE: i32 = -1;

    /// For each regular and then each singular facet, the sheet in front of it, from which its row is seen turning
    /// counter-clockwise, and the sheet behind it: [`Sheets::NONE`] where the shape is solid.
    pub fn sides(&self) -> impl Iterator<Item = [i32; 2]> + '_ {
        let regular = self.regular.iter().map(|&front| [front as i32, Self::NONE]);
        regular.chain(self.singular.iter().map(|&[behind, front]| [front as i32, behind as i32]))
    }
}

/// A union-find over the corners of exterior cells, 4·cell + corner; corners on one sheet are united. Beyond each facet
/// of the hull lies one more exterior cell, the infinite one, which has three corners here.
struct Outside<'a> {
    whole: &'a Complex,
    /// The facets of all cells as sorted rows, ascending, each with its cell; those of the hull occur once.
    sides: Vec<([u32; 3], u32)>,
    /// The facets of the hull.
    hull: Vec<[u32; 3]>,
    /// Whether each point is a vertex of the shape.
    vertices: Vec<bool>,
    sets: UnionFind,
}

impl<'a> Outside<'a> {
    fn of(whole: &'a Complex) -> Self {
        let sides = sides(whole, |_| true);
        let alone = sides.chunk_by(|a, b| a.0 == b.0).filter(|cells| cells.len() == 1);
        let hull: Vec<_> = alone.map(|cells| cells[0].0).collect();
        let points = whole.vertices.rows().last().map_or(0, |&[v]| v as usize + 1);
        let mut vertices = vec![false; points];
        for (&[v], class) in whole.vertices.iter() {
            vertices[v as usize] = class != Class::Exterior;
        }
        let sets = UnionFind::new(4 * (whole.cells.len() + hull.len()));
        Self { whole, sides, hull, vertices, sets }
    }

    /// The vertices of a cell.
    fn row(&self, cell: u32) -> &[u32] {
        let cells = self.whole.cells.rows();
        match (cell as usize).checked_sub(cells.len()) {
            None => &cells[cell as usize],
            Some(beyond) => &self.hull[beyond],
        }
    }

    /// The number of a cell's corner at a vertex.
    fn corner(&self, cell: u32, v: u32) -> u32 {
        let corner = self.row(cell).iter().position(|&corner| corner == v);
        4 * cell + corner.expect("a vertex of the cell") as u32
    }

    /// Unites the corners of two cells at those of the given common vertices that are in the shape.
    fn unite(&mut self, [one, other]: [u32; 2], vertices: &[u32]) {
        for &v in vertices {
            if self.vertices[v as usize] {
                let (a, b) = (self.corner(one, v), self.corner(other, v));
                self.sets.unite(a, b);
            }
        }
    }

    /// A corner on the outer side of each regular facet, and one on each side of each singular one, in the order of the
    /// facets: first the side from which its sorted row turns clockwise. Unites corners across exterior facets.
    fn facets(&mut self) -> Vec<u32> {
        let (cells, facets) = (&self.whole.cells, &self.whole.facets);
        // Facets as sorted rows, ascending like `sides`; regular facets need not be listed in this order.
        let mut ascending: Vec<([u32; 3], usize)> = Vec::with_capacity(facets.len());
        ascending.extend(facets.rows().iter().enumerate().map(|(at, &row)| (sorted(row), at)));
        ascending.par_sort_unstable();
        let mut seen = vec![[UNNUMBERED; 2]; facets.len()];
        let mut beyond = cells.len() as u32..;
        let sides = std::mem::take(&mut self.sides);
        let groups = sides.chunk_by(|a, b| a.0 == b.0);
        for (group, (facet, at)) in groups.zip(ascending) {
            let one = group[0].1;
            let other = group.get(1).map(|side| side.1).or_else(|| beyond.next());
            let pair = [one, other.expect("numbers do not end")];
            match facets.classes()[at] {
                Class::Exterior => self.unite(pair, &facet),
                Class::Interior => {}
                Class::Regular => {
                    let inside = cells.classes()[one as usize] == Class::Interior;
                    seen[at][0] = self.corner(pair[usize::from(inside)], facet[0]);
                }
                Class::Singular => {
                    let [a, b] = pair.map(|cell| self.corner(cell, facet[0]));
                    seen[at] =
                        if is_first(facet, cells.rows()[one as usize]) { [b, a] } else { [a, b] };
                }
            }
        }
        let seen = seen.into_flattened();
        seen.into_iter().filter(|&corner| corner != UNNUMBERED).collect()
    }

    /// A corner at each singular edge, in their order. Unites corners along edges of the shape, and those of infinite
    /// cells, which share infinite facets.
    fn edges(&mut self) -> Vec<u32> {
        let (cells, edges) = (&self.whole.cells, &self.whole.edges);
        let exterior = cells.classes().iter().map(|&class| class == Class::Exterior);
        let exterior = (0..).zip(exterior).filter(|(_, is)| *is).map(|(cell, _)| cell);
        let beyond = (cells.len() as u32..).take(self.hull.len());
        let mut seen = vec![UNNUMBERED; edges.len()];
        for cell in exterior.chain(beyond.clone()) {
            let row = self.row(cell).to_vec();
            for (i, &a) in row.iter().enumerate() {
                for &b in &row[i + 1..] {
                    let edge =
                        edges.rows().binary_search(&sorted([a, b])).expect("a face of a cell");
                    let class = edges.classes()[edge];
                    if class != Class::Exterior {
                        let corner = self.corner(cell, a);
                        let other = self.corner(cell, b);
                        self.sets.unite(corner, other);
                        seen[edge] = if class == Class::Singular { corner } else { UNNUMBERED };
                    }
                }
            }
        }
        let of_facet = |(&[a, b, c], cell): (&[u32; 3], u32)| {
            [[a, b], [a, c], [b, c]].map(|edge| (edge, cell))
        };
        let mut around: Vec<([u32; 2], u32)> =
            self.hull.iter().zip(beyond).flat_map(of_facet).collect();
        around.sort_unstable();
        for pair in around.chunk_by(|a, b| a.0 == b.0) {
            self.unite([pair[0].1, pair[1].1], &pair[0].0);
        }
        seen.into_iter().filter(|&corner| corner != UNNUMBERED).collect()
    }
}

/// Whether the sorted vertices of a facet of a positively oriented cell turn counter-clockwise seen from inside the
/// cell.
fn is_first(facet: [u32; 3], cell: [u32; 4]) -> bool {
    let [a, b, c] = facet;
    let d = cell.into_iter().find(|v| !facet.contains(v)).expect("a fourth corner");
    smallest_even([a, b, c, d]) == smallest_even(cell)
}
