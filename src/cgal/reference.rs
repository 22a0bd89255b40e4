use super::ffi::bridge;
use super::{Sites, SitesError};

/// Why CGAL gave no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CgalError {
    /// The points are none that CGAL can triangulate.
    #[error(transparent)]
    Sites(#[from] SitesError),
    /// CGAL threw. This is a fault of walpha or CGAL, not of the input.
    #[error("CGAL failed in the {stage} stage: {text}; please report this with the input")]
    Thrown {
        /// The stage that asked.
        stage: &'static str,
        /// What C++ said.
        text: String,
    },
}

/// A classified complex as C++ lends it: rows of *site* indices and class numbers (0 exterior,
/// 1 interior, 2 regular, 3 singular), in no particular order. Cells are positively oriented,
/// regular facets turn counter-clockwise seen from outside.
pub struct RawComplex(cxx::UniquePtr<bridge::Complex>);

/// Triangulates sites with CGAL's `Regular_triangulation_3` and classifies every simplex of the
/// triangulation with `Fixed_alpha_shape_3` at `alpha`, a squared length or ±∞.
///
/// Expected O(n log n) for points of even density; memory about 1.5 kB a site.
///
/// # Errors
/// [`SitesError::Flat`] when the sites span no volume.
pub fn reference(sites: &Sites, alpha: f64) -> Result<RawComplex, CgalError> {
    assert!(!alpha.is_nan(), "Alpha is never NaN");
    let complex =
        bridge::reference(sites.positions().as_flattened(), sites.weights(), alpha).map_err(
            |thrown| CgalError::Thrown { stage: "reference engine", text: thrown.what().into() },
        )?;
    flat(complex.dimension(), sites.positions().len())
        .map_or(Ok(RawComplex(complex)), |flat| Err(flat.into()))
}

/// The error for so many sites whose affine hull has a dimension below 3.
pub(super) fn flat(dimension: i32, points: usize) -> Option<SitesError> {
    let on = match dimension {
        3 => return None,
        2 => "in one plane",
        _ => "on one line",
    };
    Some(SitesError::Flat { points, on })
}

impl RawComplex {
    /// Tetrahedra and their classes.
    pub fn cells(&self) -> (&[[u32; 4]], &[u8]) {
        (self.0.cells().as_chunks().0, self.0.cell_classes())
    }

    /// Triangles and their classes.
    pub fn facets(&self) -> (&[[u32; 3]], &[u8]) {
        (self.0.facets().as_chunks().0, self.0.facet_classes())
    }

    /// Edges and their classes.
    pub fn edges(&self) -> (&[[u32; 2]], &[u8]) {
        (self.0.edges().as_chunks().0, self.0.edge_classes())
    }

    /// Vertices and their classes.
    pub fn vertices(&self) -> (&[[u32; 1]], &[u8]) {
        (self.0.vertices().as_chunks().0, self.0.vertex_classes())
    }
}
