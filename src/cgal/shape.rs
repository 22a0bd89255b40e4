//! Converts rows that C++ lends to the canonical order documented on [`Complex`].

use walpha_complex::canonical::{NumberedRows, in_order};
use walpha_regular::internals::Sites;

use super::ffi::bridge;
use super::{Error, or_zeros, spanning, thrown};
use walpha_shape::{Alpha, CgalError, Complex, ShapeError};

/// A classified complex as C++ lends it: rows of *site* indices and class numbers (0 exterior,
/// 1 interior, 2 regular, 3 singular), in no particular order. Cells are positively oriented,
/// regular facets turn counter-clockwise seen from outside.
pub(super) struct RawComplex(pub(super) cxx::UniquePtr<bridge::Complex>);

/// CGAL's `Fixed_alpha_shape_3`: the classes of all simplices of the regular triangulation at one α.
///
/// Simplices outside the shape are included, as [`Exterior`](walpha_shape::Class::Exterior). Rows name points by index and are in the order that
/// [`Complex`] documents, so that equal complexes are equal byte by byte. At α = ∞ and −∞, which CGAL does not support, all cells
/// or none are in the shape. α is a squared length, like weights; it is compared exactly.
///
/// Expected O(n log n) for points of even density; memory about 1.5 kB a point.
///
/// # Errors
/// [`Error::Sites`]: the numbers of weights and points differ; a number is not finite or is too large; there are fewer than four
/// distinct points; all points lie in one plane. [`Error::Cgal`]: out of memory, or a bug in the program.
pub fn fixed_alpha_shape(
    positions: &[[f64; 3]],
    weights: Option<&[f64]>,
    alpha: Alpha,
) -> Result<Complex, Error> {
    let weights = or_zeros(weights, positions.len());
    let sites = Sites::new(positions, &weights)?;
    let found = classified(&sites, alpha.squared())?;
    spanning(&sites, found.dimension())?;
    Ok(canonical(&RawComplex(found), sites.input()))
}

/// Like [`fixed_alpha_shape`], for sites, at a squared length or ±∞: the engine cgal.
///
/// # Errors
/// [`SitesError::Flat`](walpha_regular::SitesError::Flat) if the sites span no volume.
pub(crate) fn complex(sites: &Sites<'_>, alpha: f64) -> Result<Complex, ShapeError> {
    let found = classified(sites, alpha)?;
    spanning(sites, found.dimension())?;
    Ok(canonical(&RawComplex(found), sites.input()))
}

fn classified(sites: &Sites<'_>, alpha: f64) -> Result<cxx::UniquePtr<bridge::Complex>, CgalError> {
    assert!(!alpha.is_nan(), "Alpha is never NaN");
    let (positions, weights) = (sites.positions().as_flattened(), sites.weights());
    bridge::shape(positions, weights, alpha).map_err(thrown("alpha shape"))
}

impl RawComplex {
    /// Tetrahedra and their classes.
    pub(super) fn cells(&self) -> NumberedRows<'_, 4> {
        (self.0.cells().as_chunks().0, self.0.cell_classes())
    }

    /// Triangles and their classes.
    pub(super) fn facets(&self) -> NumberedRows<'_, 3> {
        (self.0.facets().as_chunks().0, self.0.facet_classes())
    }

    /// Edges and their classes.
    pub(super) fn edges(&self) -> NumberedRows<'_, 2> {
        (self.0.edges().as_chunks().0, self.0.edge_classes())
    }

    /// Vertices and their classes.
    pub(super) fn vertices(&self) -> NumberedRows<'_, 1> {
        (self.0.vertices().as_chunks().0, self.0.vertex_classes())
    }
}

/// Translates site indices to input indices and puts everything in canonical order.
pub(super) fn canonical(raw: &RawComplex, input: &[u32]) -> Complex {
    in_order(raw.cells(), raw.facets(), raw.edges(), raw.vertices(), input)
}
