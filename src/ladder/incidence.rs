use rayon::prelude::*;

use crate::shape::Complex;

/// Which simplices of a whole triangulation border on which, by row.
pub(super) struct Incidence {
    /// The facets, each sorted, in lexicographic order.
    pub facets: Vec<[u32; 3]>,
    /// The facet opposite each corner of each cell.
    pub cell_facets: Vec<[u32; 4]>,
    /// The cells on both sides of each facet; [`Incidence::OUTSIDE`] beyond the hull.
    pub facet_cells: Vec<[u32; 2]>,
    /// The edge opposite each corner of each facet.
    pub facet_edges: Vec<[u32; 3]>,
    /// The row of each point among the vertices; meaningless for hidden points.
    pub vertex_rows: Vec<u32>,
}

impl Incidence {
    /// Where a hull facet has no cell.
    pub(super) const OUTSIDE: u32 = u32::MAX;

    /// Looks everything up. Expected O(n log n).
    pub(super) fn of(whole: &Complex, points: usize) -> Self {
        let mut facets = whole.facets.rows().to_vec();
        // Only hull facets, which are oriented, are not sorted.
        facets.par_iter_mut().for_each(|row| row.sort_unstable());
        facets.par_sort_unstable();
        let facet_rows = Rows::new(&facets, points);
        let edge_rows = Rows::new(whole.edges.rows(), points);
        let cell_facets: Vec<[u32; 4]> = (whole.cells.rows().par_iter())
            .map(|cell| {
                [0, 1, 2, 3].map(|opposite| {
                    let mut facet = [1, 2, 3].map(|step| cell[(opposite + step) % 4]);
                    facet.sort_unstable();
                    facet_rows.find(&facet)
                })
            })
            .collect();
        let facet_edges = (facets.par_iter())
            .map(|&[a, b, c]| [[b, c], [a, c], [a, b]].map(|edge| edge_rows.find(&edge)))
            .collect();
        let mut facet_cells = vec![[Self::OUTSIDE; 2]; facets.len()];
        for (cell, facets) in cell_facets.iter().enumerate() {
            for &facet in facets {
                let sides = &mut facet_cells[facet as usize];
                let side = usize::from(sides[0] != Self::OUTSIDE);
                sides[side] = cell as u32;
            }
        }
        let mut vertex_rows = vec![0; points];
        for (row, &[v]) in whole.vertices.rows().iter().enumerate() {
            vertex_rows[v as usize] = row as u32;
        }
        Self { facets, cell_facets, facet_cells, facet_edges, vertex_rows }
    }
}

/// Sorted rows, found by their first vertex and then by halving.
struct Rows<'a, const N: usize> {
    rows: &'a [[u32; N]],
    starts: Vec<u32>,
}

impl<'a, const N: usize> Rows<'a, N> {
    fn new(rows: &'a [[u32; N]], points: usize) -> Self {
        let mut starts = vec![0; points + 1];
        rows.iter().for_each(|row| starts[row[0] as usize + 1] += 1);
        for v in 0..points {
            starts[v + 1] += starts[v];
        }
        Self { rows, starts }
    }

    fn find(&self, row: &[u32; N]) -> u32 {
        let range = |v: usize| self.starts[v] as usize;
        let first = range(row[0] as usize);
        let near = &self.rows[first..range(row[0] as usize + 1)];
        let at = near.binary_search(row).expect("each face of a simplex is there");
        (first + at) as u32
    }
}
