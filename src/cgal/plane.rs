use bridge::{PlaneTriangulation, farthest_plane as farthest, regular_plane as regular};
use walpha_regular::internals::Sites;

use super::thrown;
use walpha_shape::CgalError;

/// The entries of `cpp/plane.cc`, compiled with the feature `paper` alone.
#[allow(unused_qualifications, reason = "in what the macro writes")]
#[cxx::bridge(namespace = "walpha")]
mod bridge {
    unsafe extern "C++" {
        include!("walpha/cpp/bridge.h");
        include!("walpha/cpp/plane.h");

        /// A triangulation of the plane as flat arrays of input indices.
        type PlaneTriangulation;

        fn triangles(self: &PlaneTriangulation) -> &[u32];
        fn edges(self: &PlaneTriangulation) -> &[u32];
        fn vertices(self: &PlaneTriangulation) -> &[u32];

        fn regular_plane(
            positions: &[f64],
            weights: &[f64],
        ) -> Result<UniquePtr<PlaneTriangulation>>;
        fn farthest_plane(positions: &[f64]) -> Result<UniquePtr<PlaneTriangulation>>;
    }
}

/// A triangulation of the plane as C++ lends it: rows of *site* indices in no particular order.
pub(crate) struct RawTriangulation(cxx::UniquePtr<PlaneTriangulation>);

/// CGAL's `Regular_triangulation_2` of the sites: the Delaunay triangulation when all weights are
/// equal. A function of the set of sites: which of several triangulations of cocircular points
/// comes out does not depend on their order.
///
/// Expected O(n log n).
///
/// # Errors
/// No memory, or a fault of the program.
pub(crate) fn regular_plane(sites: &Sites<'_, 2>) -> Result<RawTriangulation, CgalError> {
    regular(sites.positions().as_flattened(), sites.weights())
        .map(RawTriangulation)
        .map_err(thrown("regular triangulation of the plane"))
}

/// The farthest-point Delaunay triangulation of the positions, weights left aside: its triangles
/// have circumscribed discs that contain every point. All points but the corners of the convex
/// hull are hidden.
///
/// The power of a place x to a point p of weight ω is |x−p|² − ω. With ω = 2|p|² it is
/// |x|² − 2x·p − |p|² = 2|x|² − |x+p|², least where p is *farthest* from −x: so the cells of the
/// power diagram are those of the farthest-point diagram reflected at the origin, and the regular
/// triangulation, which records only whose cells meet, is the farthest-point one. The weights are
/// exact numbers, not doubles.
///
/// Expected O(n log n).
///
/// # Errors
/// No memory, or a fault of the program.
pub(crate) fn farthest_plane(sites: &Sites<'_, 2>) -> Result<RawTriangulation, CgalError> {
    farthest(sites.positions().as_flattened())
        .map(RawTriangulation)
        .map_err(thrown("farthest-point triangulation"))
}

impl RawTriangulation {
    /// Triangles, counter-clockwise; none for points on one line.
    pub fn triangles(&self) -> &[[u32; 3]] {
        self.0.triangles().as_chunks().0
    }

    /// Edges.
    pub fn edges(&self) -> &[[u32; 2]] {
        self.0.edges().as_chunks().0
    }

    /// Points that are not hidden.
    pub fn vertices(&self) -> &[u32] {
        self.0.vertices()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cgal_throws_is_an_error() {
        // Sites refuse an infinity, because CGAL throws where its exact numbers meet one.
        let infinite = [0., 0., 1., 0., 0., 1., f64::INFINITY, 0.];
        let Err(exception) = regular(&infinite, &[0.0; 4]) else { panic!("∞ was taken") };
        let CgalError::Thrown { stage, text } = thrown("tried")(exception) else {
            panic!("not what was thrown")
        };
        assert_eq!(stage, "tried");
        assert!(text.starts_with("CGAL ERROR: assertion violation!"), "{text}");
    }
}
