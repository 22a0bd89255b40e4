use walpha_regular::{Sites, SitesError};

use super::canonical::canonical;
use super::ffi::bridge;
use super::thrown;
use crate::shape::{Complex, ShapeError};

/// A classified complex as C++ lends it: rows of *site* indices and class numbers (0 exterior,
/// 1 interior, 2 regular, 3 singular), in no particular order. Cells are positively oriented,
/// regular facets turn counter-clockwise seen from outside.
pub(super) struct RawComplex(cxx::UniquePtr<bridge::Complex>);

/// Triangulates sites with CGAL's `Regular_triangulation_3` and classifies every simplex of the
/// triangulation with `Fixed_alpha_shape_3` at `alpha`, a squared length or ±∞: the complex, by input indices.
///
/// Expected O(n log n) for points of even density; memory about 1.5 kB a site.
///
/// # Errors
/// [`SitesError::Flat`] when the sites span no volume.
pub(crate) fn complex(sites: &Sites<'_>, alpha: f64) -> Result<Complex, ShapeError> {
    assert!(!alpha.is_nan(), "Alpha is never NaN");
    let (positions, weights) = (sites.positions().as_flattened(), sites.weights());
    let found = bridge::shape(positions, weights, alpha).map_err(thrown("alpha shape"))?;
    match found.dimension() {
        3 => Ok(canonical(&RawComplex(found), sites.input())),
        flat => Err(SitesError::flat(sites.positions().len(), flat).into()),
    }
}

impl RawComplex {
    /// Tetrahedra and their classes.
    pub(super) fn cells(&self) -> (&[[u32; 4]], &[u8]) {
        (self.0.cells().as_chunks().0, self.0.cell_classes())
    }

    /// Triangles and their classes.
    pub(super) fn facets(&self) -> (&[[u32; 3]], &[u8]) {
        (self.0.facets().as_chunks().0, self.0.facet_classes())
    }

    /// Edges and their classes.
    pub(super) fn edges(&self) -> (&[[u32; 2]], &[u8]) {
        (self.0.edges().as_chunks().0, self.0.edge_classes())
    }

    /// Vertices and their classes.
    pub(super) fn vertices(&self) -> (&[[u32; 1]], &[u8]) {
        (self.0.vertices().as_chunks().0, self.0.vertex_classes())
    }
}
