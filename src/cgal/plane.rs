//! Triangulations of the plane: `Regular_triangulation_2`.

use bridge::{farthest_plane as farthest, regular_plane as regular};
use walpha_regular::internals::Sites;

use super::{Error, or_zeros, thrown};
use walpha_shape::CgalError;

/// The entry points of `cpp/plane.cc`, which is compiled only with the features `paper` and `cgal-oracles`.
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

/// A triangulation of points in the plane, by their indices.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct PlaneTriangulation {
    /// Triangles, counter-clockwise from their smallest vertex, in lexicographic order. There are none for points on one line.
    pub triangles: Vec<[u32; 3]>,
    /// Edges, the smaller vertex first, in lexicographic order. There are none for one point.
    pub edges: Vec<[u32; 2]>,
    /// The points that are vertices, ascending: those that are neither hidden nor duplicates.
    pub vertices: Vec<u32>,
}

/// CGAL's `Regular_triangulation_2` of points in the plane: the Delaunay triangulation when all weights are equal.
///
/// Weights are squared lengths. There may be any number of points from one up, and they may lie on one line. The result depends
/// only on the set of points, even for ties: CGAL inserts them in the order of (x, y), which decides how cocircular points are
/// triangulated.
///
/// Expected O(n log n).
///
/// ```
/// use walpha::cgal::regular_triangulation_2;
///
/// // A square, whose middle is so light that the corners hide it.
/// let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0]];
/// let plane = regular_triangulation_2(&points, Some(&[0.0, 0.0, 0.0, 0.0, -3.0]))?;
/// assert_eq!((plane.triangles.len(), plane.edges.len()), (2, 5));
/// assert_eq!(plane.vertices, [0, 1, 2, 3]);
/// # Ok::<(), walpha::cgal::Error>(())
/// ```
///
/// # Errors
/// [`Error::Sites`]: the numbers of weights and points differ; a number is not finite or is too large; there is no point.
/// [`Error::Cgal`]: out of memory, or a bug in the program.
pub fn regular_triangulation_2(
    positions: &[[f64; 2]],
    weights: Option<&[f64]>,
) -> Result<PlaneTriangulation, Error> {
    let weights = or_zeros(weights, positions.len());
    let sites = Sites::in_plane(positions, &weights)?;
    Ok(named(&regular_plane(&sites)?, sites.input()))
}

/// The farthest-point Delaunay triangulation: each of its triangles has a circumscribed disc that contains every point. All
/// points except the corners of the convex hull are hidden. It is a regular triangulation with the weights 2|p|², which CGAL
/// compares exactly.
///
/// Expected O(n log n) operations on numbers of any length.
///
/// # Errors
/// See [`regular_triangulation_2`].
pub fn farthest_point_triangulation_2(positions: &[[f64; 2]]) -> Result<PlaneTriangulation, Error> {
    let weights = or_zeros(None, positions.len());
    let sites = Sites::in_plane(positions, &weights)?;
    Ok(named(&farthest_plane(&sites)?, sites.input()))
}

/// Converts a triangulation to input indices, and sorts it.
fn named(raw: &RawTriangulation, input: &[u32]) -> PlaneTriangulation {
    let point = |site: u32| input[site as usize];
    let from_smallest = |triangle: &[u32; 3]| {
        let mut triangle = triangle.map(point);
        let first = (0..3).min_by_key(|&i| triangle[i]).unwrap_or(0);
        triangle.rotate_left(first);
        triangle
    };
    let ascending = |edge: &[u32; 2]| {
        let [a, b] = edge.map(point);
        [a.min(b), a.max(b)]
    };
    let mut plane = PlaneTriangulation {
        triangles: raw.triangles().iter().map(from_smallest).collect(),
        edges: raw.edges().iter().map(ascending).collect(),
        vertices: raw.vertices().iter().map(|&site| point(site)).collect(),
    };
    plane.triangles.sort_unstable();
    plane.edges.sort_unstable();
    plane.vertices.sort_unstable();
    plane
}

/// A triangulation of the plane as C++ lends it: rows of *site* indices in no particular order.
pub(crate) struct RawTriangulation(cxx::UniquePtr<bridge::PlaneTriangulation>);

/// CGAL's `Regular_triangulation_2` of the sites: the Delaunay triangulation when all weights are equal. The result depends only
/// on the set of sites: which of several triangulations of cocircular points it is does not depend on their order.
///
/// Expected O(n log n).
///
/// # Errors
/// Out of memory, or a bug in the program.
pub(crate) fn regular_plane(sites: &Sites<'_, 2>) -> Result<RawTriangulation, CgalError> {
    regular(sites.positions().as_flattened(), sites.weights())
        .map(RawTriangulation)
        .map_err(thrown("regular triangulation of the plane"))
}

/// The farthest-point Delaunay triangulation of the positions, ignoring weights: its triangles have circumscribed discs that
/// contain every point. All points except the corners of the convex hull are hidden.
///
/// The power of a place x to a point p of weight ω is |x−p|² − ω. With ω = 2|p|² it is |x|² − 2x·p − |p|² = 2|x|² − |x+p|², which
/// is least if p is *farthest* from −x. So the cells of the power diagram are those of the farthest-point diagram reflected at
/// the origin, and the regular triangulation, which only records whose cells meet, is the farthest-point one. The weights are
/// exact numbers, not doubles.
///
/// Expected O(n log n).
///
/// # Errors
/// Out of memory, or a bug in the program.
pub(crate) fn farthest_plane(sites: &Sites<'_, 2>) -> Result<RawTriangulation, CgalError> {
    farthest(sites.positions().as_flattened())
        .map(RawTriangulation)
        .map_err(thrown("farthest-point triangulation"))
}

impl RawTriangulation {
    /// Triangles, counter-clockwise; there are none for points on one line.
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
        // This contains an infinity, which sites refuse, because CGAL throws if its exact numbers meet one.
        let infinite = [0., 0., 1., 0., 0., 1., f64::INFINITY, 0.];
        let Err(exception) = regular(&infinite, &[0.0; 4]) else { panic!("∞ was taken") };
        let CgalError::Thrown { stage, text } = thrown("tried")(exception) else {
            panic!("not what was thrown")
        };
        assert_eq!(stage, "tried");
        assert!(text.starts_with("CGAL ERROR: assertion violation!"), "{text}");
    }
}
