use rayon::prelude::*;

use crate::Complex;

/// The incidences of the simplices of a whole triangulation, by row.
pub(super) struct Incidence {
    /// The facets, each sorted, in lexicographic order.
    pub facets: Vec<[u32; 3]>,
    /// The facet opposite each corner of each cell.
    pub cell_facets: Vec<[u32; 4]>,
    /// The cells on both sides of each facet; [`Incidence::OUTSIDE`] beyond the hull.
    pub facet_cells: Vec<[u32; 2]>,
    /// The edge opposite each corner of each facet.
    pub facet_edges: Vec<[u32; 3]>,
    /// The row of each point among the vertices; undefined for hidden points.
    pub vertex_rows: Vec<u32>,
}

impl Incidence {
    /// Stands for the missing cell of a facet of the hull.
    pub(super) const OUTSIDE: u32 = u32::MAX;

    /// Computes all incidences. Expected O(n log d), where d is the degree of a vertex.
    pub(super) fn of(whole: &Complex, points: usize) -> Self {
        let facets = sorted_facets(whole);
        let edges = Edges::new(whole.edges.rows(), points);
        let facet_edges: Vec<[u32; 3]> = (facets.par_iter())
            .map(|&[a, b, c]| [edges.find(b, c), edges.find(a, c), edges.find(a, b)])
            .collect();
        let on_edges = OnEdges::new(&facets, &facet_edges, whole.edges.len());
        let cell_facets: Vec<[u32; 4]> = (whole.cells.rows().par_iter())
            .map(|&[a, b, c, d]| {
                // The last two may be exchanged.
                let (low, high) = (c.min(d), c.max(d));
                let [ab, al, bl] = [edges.find(a, b), edges.find(a, low), edges.find(b, low)];
                [(bl, high), (al, high), (ab, d), (ab, c)].map(|(edge, v)| on_edges.find(edge, v))
            })
            .collect();
        let mut facet_cells = vec![[Self::OUTSIDE; 2]; facets.len()];
        for (cell, facets) in (0..).zip(&cell_facets) {
            for &facet in facets {
                let sides = &mut facet_cells[facet as usize];
                let side = usize::from(sides[0] != Self::OUTSIDE);
                sides[side] = cell;
            }
        }
        let mut vertex_rows = vec![0; points];
        for (row, &[v]) in (0..).zip(whole.vertices.rows()) {
            vertex_rows[v as usize] = row;
        }
        Self { facets, cell_facets, facet_cells, facet_edges, vertex_rows }
    }
}

/// The facets with ascending vertices, in lexicographic order. Only hull facets, which are oriented,
/// have theirs in another, and are among those with one smallest vertex.
fn sorted_facets(whole: &Complex) -> Vec<[u32; 3]> {
    let mut facets = whole.facets.rows().to_vec();
    for near in facets.chunk_by_mut(|a, b| a[0] == b[0]) {
        let mut turned = false;
        for [_, b, c] in near.iter_mut().filter(|[_, b, c]| b > c) {
            (*b, *c, turned) = (*c, *b, true);
        }
        if turned {
            near.sort_unstable();
        }
    }
    facets
}

/// An index of edges by their ends.
struct Edges<'a> {
    rows: &'a [[u32; 2]],
    /// The first row of each vertex, and the end.
    starts: Vec<u32>,
}

impl<'a> Edges<'a> {
    fn new(rows: &'a [[u32; 2]], points: usize) -> Self {
        Self { rows, starts: starts(rows.iter().map(|row| row[0]), points) }
    }

    /// The edge between two vertices, the smaller first.
    fn find(&self, a: u32, b: u32) -> u32 {
        let [first, end] = [a, a + 1].map(|v| self.starts[v as usize]);
        first + index_of(&self.rows[first as usize..end as usize], b)
    }
}

/// An index of facets by the edge of their two smaller vertices, and their largest vertex.
struct OnEdges<'a> {
    facets: &'a [[u32; 3]],
    /// The first row of each edge, and the end.
    starts: Vec<u32>,
}

impl<'a> OnEdges<'a> {
    fn new(facets: &'a [[u32; 3]], facet_edges: &[[u32; 3]], edges: usize) -> Self {
        Self { facets, starts: starts(facet_edges.iter().map(|edges| edges[2]), edges) }
    }

    fn find(&self, edge: u32, v: u32) -> u32 {
        let [first, end] = [edge, edge + 1].map(|edge| self.starts[edge as usize]);
        first + index_of(&self.facets[first as usize..end as usize], v)
    }
}

/// Where the rows of each group start, and where the last ones end.
fn starts(groups: impl Iterator<Item = u32>, count: usize) -> Vec<u32> {
    let mut starts = vec![0; count + 1];
    groups.for_each(|group| starts[group as usize + 1] += 1);
    for group in 0..count {
        starts[group + 1] += starts[group];
    }
    starts
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
