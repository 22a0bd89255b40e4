use super::ffi::bridge;
use super::sites::{check, keep_heaviest};
use super::{CgalError, SitesError};

/// Weighted points of the plane that CGAL can stand: all numbers finite and of sane magnitude, no
/// two places equal, at least one point. Checked once, then trusted. Unlike in space, points on
/// one line, two points and one point are all welcome.
#[derive(Clone, Debug)]
pub struct PlaneSites {
    positions: Vec<[f64; 2]>,
    weights: Vec<f64>,
    input: Vec<u32>,
    duplicates: Vec<[u32; 2]>,
}

impl PlaneSites {
    /// Checks points and removes duplicates: of several at one place the largest weight stays, of
    /// equal weights the lowest index. −0 and 0 are one place. O(n log n).
    ///
    /// # Errors
    /// No point, lists of different lengths, NaN, infinities, magnitudes beyond the limits of
    /// [`Sites`](super::Sites).
    pub fn new(positions: &[[f64; 2]], weights: &[f64]) -> Result<Self, SitesError> {
        check(positions, weights)?;
        let (input, duplicates) = keep_heaviest(positions, weights);
        if input.is_empty() {
            return Err(SitesError::Empty);
        }
        Ok(Self {
            positions: input.iter().map(|&i| positions[i as usize]).collect(),
            weights: input.iter().map(|&i| weights[i as usize]).collect(),
            input,
            duplicates,
        })
    }

    /// Positions, one per site.
    pub fn positions(&self) -> &[[f64; 2]] {
        &self.positions
    }

    /// Power weights, one per site.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The input index of each site, ascending.
    pub fn input(&self) -> &[u32] {
        &self.input
    }

    /// Pairs of input indices: a point that went, and the one at the same place that stayed.
    /// Ascending.
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.duplicates
    }
}

/// A triangulation of the plane as C++ lends it: rows of *site* indices in no particular order.
pub struct RawTriangulation(cxx::UniquePtr<bridge::PlaneTriangulation>);

/// CGAL's `Regular_triangulation_2` of the sites: the Delaunay triangulation when all weights are
/// equal. A function of the set of sites: which of several triangulations of cocircular points
/// comes out does not depend on their order.
///
/// Expected O(n log n).
///
/// # Errors
/// Only [`CgalError::Thrown`]: a fault of the program.
pub fn regular_plane(sites: &PlaneSites) -> Result<RawTriangulation, CgalError> {
    bridge::regular_plane(sites.positions.as_flattened(), &sites.weights)
        .map(RawTriangulation)
        .map_err(|thrown| thrown_in("regular triangulation of the plane", &thrown))
}

/// The farthest-point Delaunay triangulation of the positions, weights left aside: its triangles
/// have circumscribed discs that contain every point. All points but the corners of the convex
/// hull are hidden.
///
/// The power of a place x to a point p of weight ω is |x−p|² − ω. With ω = 2|p|² it is
/// |x|² − 2x·p − |p|² = 2|x|² − |x+p|², least where p is *farthest* from −x: so the cells of the
/// power diagram are those of the farthest-point diagram reflected at the origin, and the regular
/// triangulation, which tells only whose cells meet, is the farthest-point one. The weights are
/// exact numbers, not doubles.
///
/// Expected O(n log n).
///
/// # Errors
/// Only [`CgalError::Thrown`]: a fault of the program.
pub fn farthest_plane(sites: &PlaneSites) -> Result<RawTriangulation, CgalError> {
    bridge::farthest_plane(sites.positions.as_flattened())
        .map(RawTriangulation)
        .map_err(|thrown| thrown_in("farthest-point triangulation", &thrown))
}

fn thrown_in(stage: &'static str, thrown: &cxx::Exception) -> CgalError {
    CgalError::Thrown { stage, text: thrown.what().into() }
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
