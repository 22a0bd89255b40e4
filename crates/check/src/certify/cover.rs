//! Whether the simplices that are listed on a sphere cover the hull of all points on it.

use walpha_complex::canonical::sorted;

use super::structure::{Index, Points, Structure};
use crate::exact::orientation;
use crate::flat::auxiliary_positions;

/// The corners of the faces of a simplex.
const OF_CELL: [[usize; 3]; 4] = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]];
const OF_FACET: [[usize; 2]; 3] = [[1, 2], [0, 2], [0, 1]];
const OF_EDGE: [[usize; 1]; 2] = [[1], [0]];

/// Points on one empty sphere, ascending, and their affine hull.
pub(super) struct Polytope<'a> {
    points: Points<'a>,
    on: &'a [u32],
    /// Positions that span a volume together with the points.
    apexes: Vec<[f64; 3]>,
}

impl<'a> Polytope<'a> {
    pub(super) fn new(points: Points<'a>, on: &'a [u32]) -> Self {
        let positions = on.iter().map(|&v| points.position(v));
        Self { points, on, apexes: auxiliary_positions(positions).unwrap_or_default() }
    }

    /// The dimension of the hull of the points.
    pub(super) fn dimension(&self) -> usize {
        3 - self.apexes.len()
    }

    /// Whether the simplices of this dimension that are listed between the points cover their hull. They must be part of one
    /// triangulation.
    ///
    /// If they leave a part of it open, a face of one of them without another on its other side has points of the sphere beyond
    /// it.
    pub(super) fn is_covered(&self, structure: &Structure) -> bool {
        match (self.dimension(), self.on) {
            (0, &[v]) => structure.vertices.contains([v]),
            (1, &[a, b]) => structure.edges.contains([a, b]),
            (2, &[a, b, c]) => structure.facets.contains([a, b, c]),
            (3, &[a, b, c, d]) => structure.cells.contains([a, b, c, d]),
            (1, _) => self.covers(&structure.edges, OF_EDGE),
            (2, _) => self.covers(&structure.facets, OF_FACET),
            _ => self.covers(&structure.cells, OF_CELL),
        }
    }

    fn covers<const N: usize, const M: usize>(
        &self,
        listed: &Index<N>,
        faces: [[usize; M]; N],
    ) -> bool {
        let is_on = |row: &[u32; N]| row.iter().all(|v| self.on.binary_search(v).is_ok());
        let rows = self.on.iter().flat_map(|&v| listed.with_smallest(v)).filter(is_on);
        // Each face, with the opposite corner.
        let mut sides: Vec<([u32; M], u32)> = rows
            .flat_map(|row| {
                (0..N).map(move |k| (sorted(faces[k].map(|corner| row[corner])), row[k]))
            })
            .collect();
        sides.sort_unstable();
        let mut open = sides.chunk_by(|one, other| one.0 == other.0).filter(|side| side.len() == 1);
        !sides.is_empty() && open.all(|side| self.is_outer(side[0].0, side[0].1))
    }

    /// Whether no point is beyond a face, as seen from a corner.
    fn is_outer<const M: usize>(&self, face: [u32; M], corner: u32) -> bool {
        let position = |v: u32| self.points.position(v);
        let plane = || face.into_iter().map(position).chain(self.apexes.iter().copied());
        let mut plane = plane();
        let [a, b, c] = [(); 3].map(|()| plane.next().expect("three corners in all"));
        let here = orientation(a, b, c, position(corner));
        self.on.iter().all(|&v| orientation(a, b, c, position(v)) != here.reverse())
    }
}
