//! Incidences and radii, in one visit of each simplex: most of the time goes into waiting for memory.
//!
//! In a regular triangulation, if a smallest orthogonal sphere of a facet contains any point, it contains one of the two vertices
//! opposite the facet; the sphere of an edge or a vertex contains a vertex of a facet or an edge that it is a face of. So cells
//! determine the facets that are not Gabriel, then facets the edges, and edges the vertices.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use walpha_base::Cancelled;
use walpha_regular::internals::Predicates;

use super::along::{Along, Table, is_before, rows, starts};
use crate::Complex;

/// The double nearest to the squared radius of the smallest orthogonal sphere of a simplex, if that is
/// empty; otherwise no number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Radius(pub f64);

impl Radius {
    pub(super) fn known(self) -> Option<f64> {
        (!self.0.is_nan()).then_some(self.0)
    }
}

/// Squared radii of the smallest orthogonal spheres, each the nearest double, by row.
#[derive(Debug)]
pub(super) struct Radii {
    /// The radii of all cells, …
    pub cells: Vec<f64>,
    /// … and those of the Gabriel simplices among the lower ones.
    pub facets: Vec<Radius>,
    pub edges: Vec<Radius>,
    pub vertices: Vec<Radius>,
}

/// Radii that threads write in the order in which they visit simplices. A slot becomes NaN as soon as any thread finds that its
/// sphere is not empty; its radius is only set after that.
pub(super) struct Slots(Vec<AtomicU64>);

impl Slots {
    pub(super) fn new(rows: usize) -> Self {
        Self((0..rows).into_par_iter().map(|_| AtomicU64::new(0)).collect())
    }

    pub(super) fn set(&self, row: usize, radius: f64) {
        self.0[row].store(radius.to_bits(), Ordering::Relaxed);
    }

    /// Notes which faces, in the order of the corners opposite them, have spheres that are not empty.
    pub(super) fn refute<const N: usize>(&self, inside: [bool; N], faces: [u32; N]) {
        for (_, face) in inside.into_iter().zip(faces).filter(|&(inside, _)| inside) {
            self.set(face as usize, f64::NAN);
        }
    }

    pub(super) fn set_if_empty(&self, row: usize, radius: impl FnOnce() -> f64) {
        if self.0[row].load(Ordering::Relaxed) != f64::NAN.to_bits() {
            self.set(row, radius());
        }
    }

    /// The radii, in the same memory.
    pub(super) fn finished<T>(self, radius: impl Fn(f64) -> T) -> Vec<T> {
        self.0.into_iter().map(|slot| radius(f64::from_bits(slot.into_inner()))).collect()
    }
}

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

/// The index of the row with this last vertex, among rows whose last vertices ascend. There are nearly always few rows; then
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

/// The incidences and radii of all simplices. Expected O(n log d), where d is the degree of a vertex, and exact arithmetic if
/// doubles do not decide. Calls `done` after each of the three passes.
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

/// The side of the facet opposite each corner on which a cell lies. The corners of the cell are positively oriented, and those of
/// the facet ascend. Two cells at a facet are on different sides, so each is written to its own place.
fn sides([_, _, c, d]: [u32; 4]) -> [usize; 4] {
    // An exchange of two corners changes the side: (a, b, c, d) is on side 0 of (a, b, c), so (a, b, d, c) is on
    // side 1 of (a, b, d); (b, c, d, a) takes three exchanges and (a, c, d, b) two, and one more where c > d.
    if c < d { [1, 0, 1, 0] } else { [0, 1, 1, 0] }
}
