use std::collections::HashMap;

use walpha_base::advice::{Advise, wrapped};
use walpha_base::shown::number;
use walpha_regular::SitesError;
use walpha_regular::internals::Sites;

use crate::{CgalError, cgal};

/// A triangulation of the plane with what lies on the two sides of each edge, by site index and in
/// an order of its own: triangles counter-clockwise from their smallest vertex, edges with the
/// smaller vertex first, rows sorted.
pub(super) struct Mesh {
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) edges: Vec<Edge>,
    pub(super) vertices: Vec<u32>,
}

/// An edge and the triangles on its sides, seen from `ends[0]` towards `ends[1]`.
pub(super) struct Edge {
    pub(super) ends: [u32; 2],
    pub(super) left: Option<Side>,
    pub(super) right: Option<Side>,
}

/// A triangle at an edge.
#[derive(Clone, Copy)]
pub(super) struct Side {
    /// Its index in [`Mesh::triangles`].
    pub(super) triangle: usize,
    /// Its vertex opposite the edge.
    pub(super) apex: u32,
}

impl Mesh {
    /// The regular triangulation.
    pub(super) fn closest(sites: &Sites<'_, 2>) -> Result<Self, CgalError> {
        Ok(Self::new(&cgal::regular_plane(sites)?))
    }

    /// The farthest-point Delaunay triangulation.
    pub(super) fn farthest(sites: &Sites<'_, 2>) -> Result<Self, CgalError> {
        Ok(Self::new(&cgal::farthest_plane(sites)?))
    }

    fn new(raw: &cgal::RawTriangulation) -> Self {
        let mut triangles: Vec<_> = raw.triangles().iter().map(|&t| from_smallest(t)).collect();
        triangles.sort_unstable();
        // Seen along a directed edge of a counter-clockwise triangle, the triangle is on the left.
        let left_of: HashMap<[u32; 2], Side> = (triangles.iter().enumerate())
            .flat_map(|(triangle, &[a, b, c])| {
                [([a, b], c), ([b, c], a), ([c, a], b)]
                    .map(|(edge, apex)| (edge, Side { triangle, apex }))
            })
            .collect();
        let mut ends: Vec<_> = raw.edges().iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        ends.sort_unstable();
        let edges = ends.into_iter().map(|[a, b]| Edge {
            ends: [a, b],
            left: left_of.get(&[a, b]).copied(),
            right: left_of.get(&[b, a]).copied(),
        });
        let mut vertices = raw.vertices().to_vec();
        vertices.sort_unstable();
        Self { edges: edges.collect(), triangles, vertices }
    }
}

impl Edge {
    /// Triangles at the edge.
    pub(super) fn sides(&self) -> impl Iterator<Item = Side> {
        [self.left, self.right].into_iter().flatten()
    }

    /// Whether the edge bounds the triangulated region, or there are no triangles at all.
    pub(super) fn is_outer(&self) -> bool {
        self.left.is_none() || self.right.is_none()
    }
}

fn from_smallest(mut triangle: [u32; 3]) -> [u32; 3] {
    let first = (0..3).min_by_key(|&i| triangle[i]).unwrap_or(0);
    triangle.rotate_left(first);
    triangle
}

/// Why a shape in the plane cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlaneError {
    /// The points or weights cannot be triangulated.
    #[error(transparent)]
    Sites(#[from] SitesError),
    /// CGAL failed.
    #[error(transparent)]
    Cgal(#[from] CgalError),
    /// Discs of infinite or no size cannot be drawn.
    #[error(
        "discs of squared radius α + ω need a finite α, got {}: give a number; any α above the largest squared circumradius makes the convex hull",
        number(*given)
    )]
    InfiniteAlpha {
        /// The α given.
        given: f64,
    },
}

impl Advise for PlaneError {
    wrapped!(Sites, Cgal);
}
