//! Incidences and radii, in one visit of each simplex: most of the time goes into waiting for memory.
//!
//! In a regular triangulation, a smallest orthogonal sphere of a facet that contains any point contains one of the two
//! vertices opposite the facet; that of an edge or a vertex, one of a facet or an edge that it is a face of. So cells
//! tell which facets are not Gabriel, then facets which edges, and edges which vertices.

use rayon::prelude::*;
use walpha_base::Cancelled;
use walpha_regular::internals::Predicates;

use super::along::{Along, Table, is_before, starts};
use super::incidence::{Faces, Incidence, sorted_facets};
use super::radii::{Radii, Radius, Slots};
use crate::Complex;

/// The incidences and radii of all simplices. Expected O(n log d), where d is the degree of a vertex, and exact arithmetic
/// where doubles do not decide. Calls `done` after each of the three passes.
pub(super) fn incidence_and_radii(
    whole: &Complex,
    positions: &[[f64; 3]],
    spheres: &Predicates<'_>,
    done: impl Fn(u64) -> Result<(), Cancelled>,
) -> Result<(Incidence, Radii), Cancelled> {
    let along = Along::new(whole, positions);
    let facets = sorted_facets(whole);
    let faces = Faces::new(whole.edges.rows(), &facets, &along);
    let vertex_rows = starts(whole.vertices.rows(), positions.len(), is_before);
    done(1)?;
    let cell_facets = Table::new(whole.cells.len(), 0);
    let facet_cells = Table::new(facets.len(), Incidence::OUTSIDE);
    let (of_cells, of_facets) = (Slots::new(whole.cells.len()), Slots::new(facets.len()));
    along.each(&along.cells, |row| {
        let cell = whole.cells.rows()[row];
        let facets = faces.facets(cell);
        cell_facets.write(row, facets);
        for (facet, side) in facets.into_iter().zip(sides(cell)) {
            facet_cells.write_at(facet as usize, side, row as u32);
        }
        of_cells.set(row, spheres.nearest_radius(cell));
        of_facets.refute(spheres.inside_opposite(cell), facets);
    });
    done(2)?;
    let facet_edges = Table::new(facets.len(), 0);
    let of_edges = Slots::new(whole.edges.len());
    along.each(&along.facets, |row| {
        let facet = facets[row];
        let edges = faces.edges(facet);
        facet_edges.write(row, edges);
        of_facets.set_if_empty(row, || spheres.nearest_radius(facet));
        of_edges.refute(spheres.inside_opposite(facet), edges);
    });
    done(3)?;
    let of_vertices = Slots::new(whole.vertices.len());
    along.each(&along.edges, |row| {
        let edge @ [a, b] = whole.edges.rows()[row];
        of_edges.set_if_empty(row, || spheres.nearest_radius(edge));
        let ends = [b, a].map(|v| vertex_rows[v as usize]);
        of_vertices.refute(spheres.inside_opposite(edge), ends);
    });
    whole.vertices.rows().par_iter().enumerate().for_each(|(row, &vertex)| {
        of_vertices.set_if_empty(row, || spheres.nearest_radius(vertex));
    });
    let mut facet_cells: Vec<[u32; 2]> = facet_cells.finished();
    // The lower cell first.
    facet_cells.par_iter_mut().for_each(|sides| sides.sort_unstable());
    let (cell_facets, facet_edges) =
        rayon::join(|| cell_facets.finished(), || facet_edges.finished());
    let incidence = Incidence { facets, cell_facets, facet_cells, facet_edges, vertex_rows };
    let radii = Radii {
        cells: of_cells.finished(|radius| radius),
        facets: of_facets.finished(Radius),
        edges: of_edges.finished(Radius),
        vertices: of_vertices.finished(Radius),
    };
    Ok((incidence, radii))
}

/// On which side of the facet opposite each corner a cell lies: its corners are positively oriented, and those of the facet
/// ascend. Two cells at a facet are on different sides, so that each is written to a place of its own.
fn sides([_, _, c, d]: [u32; 4]) -> [usize; 4] {
    // An exchange of two corners changes the side: (a, b, c, d) is on side 0 of (a, b, c), so (a, b, d, c) is on
    // side 1 of (a, b, d); (b, c, d, a) takes three exchanges and (a, c, d, b) two, and one more where c > d.
    if c < d { [1, 0, 1, 0] } else { [0, 1, 1, 0] }
}
