//! Incidences and radii.
//!
//! In a regular triangulation, a smallest orthogonal sphere of a facet that contains any point contains one of the two
//! vertices opposite the facet; that of an edge or a vertex, one of a facet or an edge that it is a face of. So cells
//! tell which facets are not Gabriel, then facets which edges, and edges which vertices.

use std::sync::atomic::{AtomicU64, Ordering};

use walpha_base::Cancelled;
use walpha_base::parallel::join;
use walpha_base::parallel::prelude::*;
use walpha_regular::internals::Predicates;

use crate::Complex;
use crate::along::{Along, Table, is_before, starts};
use crate::incidence::{Faces, sides, sorted_facets};
use crate::winding::Winding;

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
    /// Of all cells, …
    pub cells: Vec<f64>,
    /// … and of what is Gabriel among lower simplices.
    pub facets: Vec<Radius>,
    pub edges: Vec<Radius>,
    pub vertices: Vec<Radius>,
}

/// Radii that threads write in the order in which they visit simplices. A slot is NaN once its sphere is known not to be
/// empty, from any thread; its radius is set after that only.
pub(super) struct Slots(Vec<AtomicU64>);

impl Slots {
    pub(super) fn new(rows: usize) -> Self {
        Self((0..rows).into_par_iter().coarse().map(|_| AtomicU64::new(0)).collect())
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

    fn set_if_known(&self, row: usize, radius: Option<f64>) {
        if let Some(radius) = radius {
            self.set(row, radius);
        }
    }

    /// Whether no sphere has been found not to be empty.
    fn may_be_empty(&self, row: usize) -> bool {
        self.0[row].load(Ordering::Relaxed) != f64::NAN.to_bits()
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
    /// For each facet, the multiples of the vectors by which its second cell is to be moved so that the vertices of the facet coincide in
    /// both; empty unless rows name copies of points.
    pub ways: Vec<Winding>,
    /// The edge opposite each corner of each facet.
    pub facet_edges: Vec<[u32; 3]>,
    /// The row of each point, and of each copy of one, among the vertices; undefined for hidden points, and one past the last point.
    pub vertex_rows: Vec<u32>,
}

impl Incidence {
    /// Stands for the missing cell of a facet of the hull.
    pub(super) const OUTSIDE: u32 = u32::MAX;

    /// The corners of the facet opposite a corner of a cell, counter-clockwise seen from outside the cell.
    pub(super) fn outward(opposite: usize) -> [usize; 3] {
        let [a, b, c] = [1, 2, 3].map(|step| (opposite + step) % 4);
        if opposite % 2 == 1 { [a, c, b] } else { [a, b, c] }
    }
}

impl Incidence {
    /// The incidences of a whole triangulation, found by looking for the faces of each simplex. Expected O(n log d), where d is the
    /// degree of a vertex.
    pub(super) fn new(whole: &Complex, positions: usize, along: &Along) -> Self {
        let facets = sorted_facets(whole);
        let faces = Faces::new(whole.edges.rows(), &facets, along);
        let vertex_rows = starts(whole.vertices.rows(), positions, is_before);
        let cell_facets = Table::new(whole.cells.len(), 0);
        let facet_cells = Table::new(facets.len(), Self::OUTSIDE);
        along.each(&along.cells, |row| {
            let cell = whole.cells.rows()[row];
            let facets = faces.facets(cell);
            cell_facets.write(row, facets);
            for (facet, side) in facets.into_iter().zip(sides(cell)) {
                facet_cells.write_at(facet as usize, side, row as u32);
            }
        });
        let facet_edges = Table::new(facets.len(), 0);
        along.each(&along.facets, |row| facet_edges.write(row, faces.edges(facets[row])));
        let mut facet_cells: Vec<[u32; 2]> = facet_cells.finished();
        // The lower cell first.
        facet_cells.par_iter_mut().coarse().for_each(|sides| sides.sort_unstable());
        let (cell_facets, facet_edges) =
            join(facets.len(), || cell_facets.finished(), || facet_edges.finished());
        Self { facets, cell_facets, facet_cells, ways: Vec::new(), facet_edges, vertex_rows }
    }
}

impl Radii {
    /// The radii of all simplices of a whole triangulation. O(n), and exact arithmetic where doubles do not decide. Calls `done`
    /// after each of three passes.
    pub(super) fn new(
        whole: &Complex,
        incidence: &Incidence,
        along: &Along,
        spheres: &Predicates<'_>,
        done: impl Fn(u64) -> Result<(), Cancelled>,
    ) -> Result<Self, Cancelled> {
        let Incidence { facets, cell_facets, facet_edges, vertex_rows, .. } = incidence;
        let (of_cells, of_facets) = (Slots::new(whole.cells.len()), Slots::new(facets.len()));
        along.each(&along.cells, |row| {
            let (radius, inside) = spheres.radius_and_inside(whole.cells.rows()[row], || true);
            of_cells.set_if_known(row, radius);
            of_facets.refute(inside, cell_facets[row]);
        });
        done(1)?;
        let of_edges = Slots::new(whole.edges.len());
        along.each(&along.facets, |row| {
            let may_be_empty = || of_facets.may_be_empty(row);
            let (radius, inside) = spheres.radius_and_inside(facets[row], may_be_empty);
            of_facets.set_if_known(row, radius);
            of_edges.refute(inside, facet_edges[row]);
        });
        done(2)?;
        let of_vertices = Slots::new(whole.vertices.len());
        along.each(&along.edges, |row| {
            let edge @ [a, b] = whole.edges.rows()[row];
            let may_be_empty = || of_edges.may_be_empty(row);
            let (radius, inside) = spheres.radius_and_inside(edge, may_be_empty);
            of_edges.set_if_known(row, radius);
            let ends = [b, a].map(|v| vertex_rows[v as usize]);
            of_vertices.refute(inside, ends);
        });
        whole.vertices.rows().par_iter().coarse().enumerate().for_each(|(row, &vertex)| {
            if of_vertices.may_be_empty(row) {
                of_vertices.set(row, spheres.nearest_radius(vertex));
            }
        });
        done(3)?;
        Ok(Self {
            cells: of_cells.finished(|radius| radius),
            facets: of_facets.finished(Radius),
            edges: of_edges.finished(Radius),
            vertices: of_vertices.finished(Radius),
        })
    }
}
