//! Converts rows that C++ lends to the canonical order documented on [`Complex`].

use walpha_base::parallel::prelude::*;
use walpha_complex::canonical::{smallest_even, sorted};
use walpha_regular::internals::Sites;

use super::ffi::bridge;
use super::{Error, or_zeros, spanning, thrown};
use walpha_shape::{Alpha, CgalError, Class, Complex, ShapeError, Simplices};

/// A classified complex as C++ lends it: rows of *site* indices and class numbers (0 exterior,
/// 1 interior, 2 regular, 3 singular), in no particular order. Cells are positively oriented,
/// regular facets turn counter-clockwise seen from outside.
pub(super) struct RawComplex(pub(super) cxx::UniquePtr<bridge::Complex>);

/// CGAL's `Fixed_alpha_shape_3`: the classes of all simplices of the regular triangulation at one α.
///
/// Simplices outside the shape are included, as [`Class::Exterior`]. Rows name points by index and are in the order that
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

/// Translates site indices to input indices and puts everything in canonical order.
pub(super) fn canonical(raw: &RawComplex, input: &[u32]) -> Complex {
    Complex {
        cells: simplices(raw.cells(), input, |row, _| smallest_even(row)),
        facets: simplices(raw.facets(), input, |row, class| {
            if class == Class::Regular { smallest_even(row) } else { sorted(row) }
        }),
        edges: simplices(raw.edges(), input, |row, _| sorted(row)),
        vertices: simplices(raw.vertices(), input, |row, _| row),
    }
}

fn simplices<const N: usize>(
    (rows, classes): (&[[u32; N]], &[u8]),
    input: &[u32],
    order: impl Fn([u32; N], Class) -> [u32; N] + Sync,
) -> Simplices<N> {
    let mut pairs: Vec<([u32; N], Class)> = rows
        .par_iter()
        .zip(classes)
        .map(|(row, &number)| {
            let class = Class::from_number(number).expect("CGAL has four classes");
            (order(row.map(|site| input[site as usize]), class), class)
        })
        .collect();
    // Rows are distinct, so an unstable sort has a unique result.
    pairs.par_sort_unstable_by_key(|pair| pair.0);
    pairs.into_iter().collect()
}
