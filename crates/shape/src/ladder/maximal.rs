//! Maximal simplices: cells or, where points span no volume, triangles, edges, or one vertex.

use super::incidence::Incidence;
use super::{Filtration, Levels, Span};

/// Two maximal simplices with a common face of one dimension less.
type AdjacentPair = [u32; 2];

impl Levels<'_> {
    /// The first level of each maximal simplex, by row. Maximal simplices are cells or, where points span no volume,
    /// triangles, edges, or one vertex.
    pub(super) fn firsts_of_maximal(&self) -> Vec<u32> {
        let firsts = |spans: &[Span]| spans.iter().map(|span| span.first).collect();
        match self.filtration.dimension() {
            3 => self.cells.clone(),
            2 => firsts(&self.facets),
            1 => firsts(&self.edges),
            _ => firsts(&self.vertices),
        }
    }
}

impl Filtration {
    /// The dimension of what the points span.
    pub(super) fn dimension(&self) -> usize {
        let complex = self.whole.complex();
        let counts = [complex.edges.len(), complex.facets.len(), complex.cells.len()];
        counts.iter().rposition(|&count| count > 0).map_or(0, |below| below + 1)
    }

    /// The vertices of a maximal simplex.
    pub(super) fn maximal_simplex(&self, row: usize) -> &[u32] {
        let complex = self.whole.complex();
        match self.dimension() {
            3 => &complex.cells.rows()[row],
            2 => &self.incidence.facets[row],
            1 => &complex.edges.rows()[row],
            _ => &complex.vertices.rows()[row],
        }
    }

    /// All pairs of maximal simplices with a common face of one dimension less. O(n).
    pub(super) fn adjacent_pairs(&self) -> Vec<AdjacentPair> {
        let complex = self.whole.complex();
        let incidence = &self.incidence;
        let mut sides = match self.dimension() {
            3 => incidence.facet_cells.clone(),
            2 => cofaces(complex.edges.len(), incidence.facet_edges.iter().map(|edges| &edges[..])),
            1 => {
                let ends: Vec<[u32; 2]> = (complex.edges.rows().iter())
                    .map(|edge| edge.map(|v| incidence.vertex_rows[v as usize]))
                    .collect();
                cofaces(complex.vertices.len(), ends.iter().map(|ends| &ends[..]))
            }
            _ => Vec::new(),
        };
        sides.retain(|sides| sides[1] != Incidence::OUTSIDE);
        sides
    }
}

/// The two cofaces of each face, by row; [`Incidence::OUTSIDE`] for those missing.
fn cofaces<'a>(faces: usize, of: impl Iterator<Item = &'a [u32]>) -> Vec<AdjacentPair> {
    let mut sides = vec![[Incidence::OUTSIDE; 2]; faces];
    for (row, its) in (0..).zip(of) {
        for &face in its {
            let [first, second] = &mut sides[face as usize];
            *(if *first == Incidence::OUTSIDE { first } else { second }) = row;
        }
    }
    sides
}
