//! The location of a point in a triangulation, decided exactly.

use std::cmp::Ordering;

use crate::triangulation::NO_CELL;
use crate::{Lattice, MAX_COORDINATE, Predicates, Triangulation};

/// The location of a point in a [`Triangulation`]: the face whose interior contains the point. The cases are those of CGAL's
/// `Triangulation_3::Locate_type`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Location {
    /// The point is in the interior of a cell.
    InCell {
        /// The cell.
        cell: u32,
    },
    /// The point is in the interior of a facet.
    OnFacet {
        /// A finite cell with this facet.
        cell: u32,
        /// Its vertices, ascending.
        facet: [u32; 3],
    },
    /// The point is in the interior of an edge.
    OnEdge {
        /// A finite cell with this edge.
        cell: u32,
        /// Its ends, ascending.
        edge: [u32; 2],
    },
    /// The point is at a vertex.
    OnVertex {
        /// A finite cell with this vertex.
        cell: u32,
        /// The vertex.
        vertex: u32,
    },
    /// Outside the convex hull.
    Outside {
        /// An infinite cell: the point is strictly beyond the plane of its facet of the hull.
        cell: u32,
    },
}

impl Location {
    /// The cell that contains the point; finite, unless the point is outside.
    pub fn cell(self) -> u32 {
        match self {
            Self::InCell { cell }
            | Self::OnFacet { cell, .. }
            | Self::OnEdge { cell, .. }
            | Self::OnVertex { cell, .. }
            | Self::Outside { cell } => cell,
        }
    }
}

impl Triangulation {
    /// The exact location of a point; `None` if a coordinate is NaN or larger in magnitude than [`MAX_COORDINATE`]. The named
    /// cell is any of the cells that share the face.
    ///
    /// This walks from the nearest of a few vertices (Mücke, Saias and Zhu 1999, doi:10.1016/S0925-7721(98)00035-2): expected
    /// O(n^¼) for evenly distributed points.
    ///
    /// ```
    /// use walpha_regular::{Location, triangulate};
    ///
    /// let points = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
    /// let tetrahedron = triangulate(&points, None)?;
    /// assert!(matches!(tetrahedron.locate([0.25; 3]), Some(Location::InCell { .. })));
    /// assert!(matches!(tetrahedron.locate([1.0, 0.0, 0.0]), Some(Location::OnEdge { edge: [0, 1], .. })));
    /// assert!(matches!(tetrahedron.locate([1.0; 3]), Some(Location::Outside { .. })));
    /// # Ok::<(), walpha_regular::TriangulationError>(())
    /// ```
    pub fn locate(&self, point: [f64; 3]) -> Option<Location> {
        self.locate_from(point, self.cell_near(point))
    }

    /// Like [`locate`](Self::locate), by a walk from a cell; `None` also if that cell does not exist. This is fast if the cell is
    /// near the point, such as the cell of the previous point along a curve.
    pub fn locate_from(&self, point: [f64; 3], cell: u32) -> Option<Location> {
        let mut cell = match self.infinite_corner(*self.cells().get(cell as usize)?) {
            Some(corner) => self.adjacency()[cell as usize][corner] / 4,
            None => cell,
        };
        if !point.iter().all(|x| x.abs() <= MAX_COORDINATE) {
            return None;
        }
        // The walk goes across facets that separate the cell from the point: such a walk never returns to a cell of a regular
        // triangulation (Edelsbrunner 1990, doi:10.1007/BF02122779).
        let (mut from, mut face) = (NO_CELL, Vec::with_capacity(4));
        'walk: loop {
            let corners = self.cells()[cell as usize];
            face.clear();
            for (corner, side) in self.adjacency()[cell as usize].into_iter().enumerate() {
                let next = side / 4;
                // The point is strictly on this side of the facet through which the walk came.
                let sign = if next == from {
                    Ordering::Greater
                } else {
                    self.orientation_with(corners, corner, point)
                };
                match sign {
                    Ordering::Less if self.is_finite(next) => {
                        (from, cell) = (cell, next);
                        continue 'walk;
                    }
                    Ordering::Less => return Some(Location::Outside { cell: next }),
                    Ordering::Equal => {}
                    Ordering::Greater => face.push(corners[corner]),
                }
            }
            face.sort_unstable();
            return Some(match face[..] {
                [a, b, c] => Location::OnFacet { cell, facet: [a, b, c] },
                [a, b] => Location::OnEdge { cell, edge: [a, b] },
                [vertex] => Location::OnVertex { cell, vertex },
                _ => Location::InCell { cell },
            });
        }
    }

    /// A finite cell at the vertex that is nearest to a point among about n^¼ vertices, evenly spaced by index.
    fn cell_near(&self, point: [f64; 3]) -> u32 {
        let points = self.positions();
        let few = (points.len() as f64).powf(0.25).ceil() as usize;
        let some = (0..points.len()).step_by(points.len() / few);
        let square = |v: &usize| {
            let way = [0, 1, 2].map(|k| points[*v][k] - point[k]);
            way.iter().map(|x| x * x).sum::<f64>()
        };
        let nearest = (some.filter(|&v| self.cell_at[v] != NO_CELL))
            .min_by(|v, w| square(v).total_cmp(&square(w)));
        self.cell_at[nearest.unwrap_or(self.infinite_vertex() as usize)]
    }

    /// The orientation of a finite cell with a point in place of a corner. Exact.
    fn orientation_with(&self, cell: [u32; 4], corner: usize, point: [f64; 3]) -> Ordering {
        let mut places = cell.map(|v| self.positions()[v as usize]);
        places[corner] = point;
        Predicates::on(Lattice::NONE, &places, &[0.0; 4]).orientation([0, 1, 2, 3])
    }

    fn infinite_corner(&self, cell: [u32; 4]) -> Option<usize> {
        cell.iter().position(|&v| v == self.infinite_vertex())
    }
}

#[cfg(test)]
pub(crate) mod tests;
