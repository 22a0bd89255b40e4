//! Which simplices of a complex are faces of which, by row. Rows are sorted, so that a few comparisons find a face, and nothing is
//! hashed.

use std::ops::Range;

use walpha_base::parallel::FEW;
use walpha_base::parallel::prelude::*;

use crate::Complex;
use crate::along::{Along, Table, rows, starts};

/// The facets with ascending vertices, in lexicographic order. Only hull facets, which are oriented,
/// have theirs in another, and are among those with one smallest vertex.
pub(crate) fn sorted_facets(whole: &Complex) -> Vec<[u32; 3]> {
    let mut facets: Vec<_> = whole.facets.rows().par_iter().coarse().copied().collect();
    let is_near = |a: &[u32; 3], b: &[u32; 3]| a[0] == b[0];
    let sort = |near: &mut [[u32; 3]]| {
        let mut turned = false;
        for [_, b, c] in near.iter_mut().filter(|[_, b, c]| b > c) {
            (*b, *c, turned) = (*c, *b, true);
        }
        if turned {
            near.sort_unstable();
        }
    };
    if facets.len() > FEW {
        facets.par_chunk_by_mut(is_near).for_each(sort);
    } else {
        facets.chunk_by_mut(is_near).for_each(sort);
    }
    facets
}

/// An index of edges by their ends.
#[derive(Clone, Copy)]
struct Edges<'a> {
    rows: &'a [[u32; 2]],
    /// The first edge of each vertex, and the end.
    of_vertices: &'a [u32],
}

impl Edges<'_> {
    /// The edge between two vertices, the smaller first.
    #[inline]
    fn row(self, a: u32, b: u32) -> u32 {
        let range = rows(self.of_vertices, a);
        range.start as u32 + index_of(&self.rows[range], b)
    }

    /// The edge opposite each vertex of a facet. O(log d), where d is the degree of a vertex.
    fn of_facet(self, [a, b, c]: [u32; 3]) -> [u32; 3] {
        [self.row(b, c), self.row(a, c), self.row(a, b)]
    }
}

/// An index of edges by their ends, and of facets by the edge of their two smaller vertices, and their largest vertex.
pub(crate) struct Faces<'a> {
    edges: Edges<'a>,
    facets: &'a [[u32; 3]],
    /// The first facet of each edge, and the end.
    of_edges: Vec<u32>,
}

impl<'a> Faces<'a> {
    /// O(n).
    pub(crate) fn new(edges: &'a [[u32; 2]], facets: &'a [[u32; 3]], along: &'a Along) -> Self {
        let of_edges = starts(facets, edges.len(), |&[a, b, _], edge| [a, b] < edges[edge]);
        Self { edges: Edges { rows: edges, of_vertices: &along.edges }, facets, of_edges }
    }

    /// The edge opposite each vertex of a facet. O(log d), where d is the degree of a vertex.
    pub(crate) fn edges(&self, facet: [u32; 3]) -> [u32; 3] {
        self.edges.of_facet(facet)
    }

    /// The facet opposite each vertex of a cell; of that, the last two may be exchanged. O(log d).
    pub(crate) fn facets(&self, [a, b, c, d]: [u32; 4]) -> [u32; 4] {
        let (low, high) = (c.min(d), c.max(d));
        let row = |a, b| self.edges.row(a, b);
        let [ab, al, bl] = [row(a, b), row(a, low), row(b, low)];
        [(bl, high), (al, high), (ab, d), (ab, c)].map(|(edge, v)| self.facet(edge, v))
    }

    fn facet(&self, edge: u32, v: u32) -> u32 {
        let range = rows(&self.of_edges, edge);
        range.start as u32 + index_of(&self.facets[range], v)
    }
}

/// The index of the row with this last vertex, among rows whose last vertices ascend. There are nearly always few: then
/// counting is faster than bisection, whose branches are mispredicted.
#[inline]
fn index_of<const N: usize>(rows: &[[u32; N]], last: u32) -> u32 {
    // Up to this many rows are counted.
    const FEW: usize = 32;
    let at = if rows.len() <= FEW {
        rows.iter().map(|row| usize::from(row[N - 1] < last)).sum()
    } else {
        rows.partition_point(|row| row[N - 1] < last)
    };
    assert_eq!(rows[at][N - 1], last, "each face of a simplex is there");
    at as u32
}

/// On which side of the facet opposite each corner a cell lies: its corners are positively oriented, and those of the facet
/// ascend. Two cells at a facet are on different sides, so that each is written to a place of its own.
pub(crate) fn sides([_, _, c, d]: [u32; 4]) -> [usize; 4] {
    // An exchange of two corners changes the side: (a, b, c, d) is on side 0 of (a, b, c), so (a, b, d, c) is on
    // side 1 of (a, b, d); (b, c, d, a) takes three exchanges and (a, c, d, b) two, and one more where c > d.
    if c < d { [1, 0, 1, 0] } else { [0, 1, 1, 0] }
}

/// The facets of a complex and what is on both sides of each, for visits along a Hilbert curve.
#[derive(Debug)]
pub struct FacetSides {
    along: Along,
    facets: Vec<[u32; 3]>,
    sides: Vec<[u32; 2]>,
}

impl FacetSides {
    /// Stands for a side without a cell.
    pub const OPEN: u32 = u32::MAX;

    /// Finds, on both sides of each facet, the vertex opposite the facet in the cell there. All faces of all simplices must be listed.
    /// Expected O(n log d), where d is the degree of a vertex.
    pub fn apexes(complex: &Complex, positions: &[[f64; 3]]) -> Self {
        Self::new(complex, positions, |row| complex.cells.rows()[row])
    }

    /// Finds the cells, by row, on both sides of each facet. All faces of all simplices must be listed. Expected O(n log d).
    pub fn cells(complex: &Complex, positions: &[[f64; 3]]) -> Self {
        Self::new(complex, positions, |row| [row as u32; 4])
    }

    /// Writes an element of each cell, by row, to each of its facets, in the order of the corners opposite them.
    fn new(
        complex: &Complex,
        positions: &[[f64; 3]],
        elements: impl Fn(usize) -> [u32; 4] + Sync,
    ) -> Self {
        let along = Along::new(complex, positions);
        let facets = sorted_facets(complex);
        let faces = Faces::new(complex.edges.rows(), &facets, &along);
        let table = Table::new(facets.len(), Self::OPEN);
        along.each(&along.cells, |row| {
            let cell = complex.cells.rows()[row];
            let places = faces.facets(cell).into_iter().zip(sides(cell));
            for ((facet, side), element) in places.zip(elements(row)) {
                table.write_at(facet as usize, side, element);
            }
        });
        drop(faces);
        Self { along, facets, sides: table.finished() }
    }

    /// Groups of vertices that are close on the curve. Each facet belongs to its smallest vertex.
    pub fn groups(&self, vertices: usize) -> impl IndexedParallelIterator<Item = &[u32]> {
        self.along.order.par_chunks(vertices)
    }

    /// The facets of a vertex, by row.
    pub fn facets_of(&self, vertex: u32) -> Range<usize> {
        rows(&self.along.facets, vertex)
    }

    /// All facets, sorted, each with ascending vertices.
    pub fn facets(&self) -> &[[u32; 3]] {
        &self.facets
    }

    /// What is on the two sides of a facet; [`Self::OPEN`] where there is no cell. The cell on the first side is positively oriented with
    /// its apex last.
    pub fn sides(&self, row: usize) -> [u32; 2] {
        self.sides[row]
    }

    /// The facets of a vertex, each with the edge opposite each of its vertices; facets by row here, edges by row in the complex.
    /// O(log d) each.
    pub fn facets_and_edges<'a>(
        &'a self,
        complex: &'a Complex,
        vertex: u32,
    ) -> impl Iterator<Item = (usize, [u32; 3])> + 'a {
        let edges = Edges { rows: complex.edges.rows(), of_vertices: &self.along.edges };
        // Facets with a common edge to their second vertex follow each other.
        let mut last = (vertex, 0);
        self.facets_of(vertex).map(move |row| {
            let [a, b, c] = self.facets[row];
            if b != last.0 {
                last = (b, edges.row(a, b));
            }
            (row, [edges.row(b, c), edges.row(a, c), last.1])
        })
    }

    /// The row of an edge among those of the complex, if it is there. Its ends ascend. O(log d).
    pub fn find_edge(&self, complex: &Complex, edge: [u32; 2]) -> Option<usize> {
        let range = rows(&self.along.edges, edge[0]);
        let at = complex.edges.rows()[range.clone()].binary_search(&edge).ok()?;
        Some(range.start + at)
    }

    /// The row of a facet, if it is there. Its vertices ascend. O(log d).
    pub fn find_facet(&self, facet: [u32; 3]) -> Option<usize> {
        let range = self.facets_of(facet[0]);
        let at = self.facets[range.clone()].binary_search(&facet).ok()?;
        Some(range.start + at)
    }
}
