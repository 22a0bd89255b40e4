//! The values from which on each simplex is in the shape, a face of another simplex of it, and off its boundary.

use super::values::{ATTACHED, NEVER, Ranks};
use crate::certify::structure::Structure;

/// Ranks of values; [`NEVER`] where there is none.
#[derive(Clone, Copy)]
pub(super) struct Span {
    pub first: u32,
    pub regular: u32,
    pub interior: u32,
}

/// The spans of all simplices, by row; of cells only the first rank, as they have no cofaces.
pub(super) struct Spans {
    pub cells: Vec<u32>,
    pub facets: Vec<Span>,
    pub edges: Vec<Span>,
    pub vertices: Vec<Span>,
}

impl Spans {
    pub(super) fn of(structure: &Structure, ranks: &Ranks) -> Self {
        let complex = structure.complex;
        let cells = ranks.cells.clone();
        let facets: Vec<Span> = (0..complex.facets.len())
            .map(|facet| {
                let sides: Vec<u32> =
                    structure.halves(facet).map(|half| cells[half.cell]).collect();
                let regular = sides.iter().copied().min().unwrap_or(NEVER);
                // A facet of the hull has one cell, and the outside on its other side.
                let last = if sides.len() == 2 { sides.into_iter().max() } else { None };
                span(ranks.facets[facet], regular, last.unwrap_or(NEVER))
            })
            .collect();
        let of_facet = |&[a, b, c]: &[u32; 3]| {
            [[a, b], [a, c], [b, c]].map(|edge| structure.edges.row(edge) as usize)
        };
        let edges = below(&facets, complex.facets.rows().iter().map(of_facet), &ranks.edges);
        let of_edge = |edge: &[u32; 2]| edge.map(|v| structure.vertices.row([v]) as usize);
        let vertices = below(&edges, complex.edges.rows().iter().map(of_edge), &ranks.vertices);
        Self { cells, facets, edges, vertices }
    }
}

/// The spans of faces from those of their cofaces.
fn below<const M: usize>(
    higher: &[Span],
    faces: impl Iterator<Item = [usize; M]>,
    own: &[u32],
) -> Vec<Span> {
    let mut ends = vec![(NEVER, 0); own.len()];
    for (span, faces) in higher.iter().zip(faces) {
        for face in faces {
            let (regular, interior) = &mut ends[face];
            *regular = span.first.min(*regular);
            *interior = span.interior.max(*interior);
        }
    }
    own.iter().zip(ends).map(|(&own, (regular, interior))| span(own, regular, interior)).collect()
}

fn span(own: u32, regular: u32, interior: u32) -> Span {
    let first = if own == ATTACHED { regular } else { own };
    Span { first, regular, interior }
}
