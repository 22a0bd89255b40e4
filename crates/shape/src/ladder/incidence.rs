use rayon::prelude::*;

use super::along::{Along, rows, starts};
use crate::Complex;

/// The incidences of the simplices of a whole triangulation, by row.
#[derive(Debug)]
pub(super) struct Incidence {
    /// The facets, each sorted, in lexicographic order.
    pub facets: Vec<[u32; 3]>,
    /// The facet opposite each corner of each cell.
    pub cell_facets: Vec<[u32; 4]>,
    /// The cells on both sides of each facet; [`Incidence::OUTSIDE`] beyond the hull.
    pub facet_cells: Vec<[u32; 2]>,
    /// The edge opposite each corner of each facet.
    pub facet_edges: Vec<[u32; 3]>,
    /// The row of each point among the vertices; undefined for hidden points, and one past the last point.
    pub vertex_rows: Vec<u32>,
}

impl Incidence {
    /// Stands for the missing cell of a facet of the hull.
    pub(super) const OUTSIDE: u32 = u32::MAX;
}

/// The facets with ascending vertices, in lexicographic order. Only hull facets, which are oriented,
/// have theirs in another, and are among those with one smallest vertex.
pub(super) fn sorted_facets(whole: &Complex) -> Vec<[u32; 3]> {
    let mut facets: Vec<_> = whole.facets.rows().par_iter().copied().collect();
    facets.par_chunk_by_mut(|a, b| a[0] == b[0]).for_each(|near| {
        let mut turned = false;
        for [_, b, c] in near.iter_mut().filter(|[_, b, c]| b > c) {
            (*b, *c, turned) = (*c, *b, true);
        }
        if turned {
            near.sort_unstable();
        }
    });
    facets
}

/// An index of edges by their ends, and of facets by the edge of their two smaller vertices, and their largest vertex.
pub(super) struct Faces<'a> {
    edges: &'a [[u32; 2]],
    facets: &'a [[u32; 3]],
    /// The first edge of each vertex, and the end.
    of_vertices: &'a [u32],
    /// The first facet of each edge, and the end.
    of_edges: Vec<u32>,
}

impl<'a> Faces<'a> {
    /// O(n).
    pub(super) fn new(edges: &'a [[u32; 2]], facets: &'a [[u32; 3]], along: &'a Along) -> Self {
        let of_edges = starts(facets, edges.len(), |&[a, b, _], edge| [a, b] < edges[edge]);
        Self { edges, facets, of_vertices: &along.edges, of_edges }
    }

    /// The edge opposite each vertex of a facet. O(log d), where d is the degree of a vertex.
    pub(super) fn edges(&self, [a, b, c]: [u32; 3]) -> [u32; 3] {
        [self.edge(b, c), self.edge(a, c), self.edge(a, b)]
    }

    /// The facet opposite each vertex of a cell; of that, the last two may be exchanged. O(log d).
    pub(super) fn facets(&self, [a, b, c, d]: [u32; 4]) -> [u32; 4] {
        let (low, high) = (c.min(d), c.max(d));
        let [ab, al, bl] = [self.edge(a, b), self.edge(a, low), self.edge(b, low)];
        [(bl, high), (al, high), (ab, d), (ab, c)].map(|(edge, v)| self.facet(edge, v))
    }

    /// The edge between two vertices, the smaller first.
    fn edge(&self, a: u32, b: u32) -> u32 {
        let range = rows(self.of_vertices, a);
        range.start as u32 + index_of(&self.edges[range], b)
    }

    fn facet(&self, edge: u32, v: u32) -> u32 {
        let range = rows(&self.of_edges, edge);
        range.start as u32 + index_of(&self.facets[range], v)
    }
}

/// The index of the row with this last vertex, among rows whose last vertices ascend. There are nearly always few: then
/// counting is faster than bisection, whose branches are mispredicted.
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
