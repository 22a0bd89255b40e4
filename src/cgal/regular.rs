use super::ffi::bridge;
use super::thrown;
use crate::triangulation::{SitesError, Triangulation, TriangulationError};

/// CGAL's `Regular_triangulation_3` of points that are sites, or some of them, copied out.
///
/// Expected O(n log n) for points of even density; about 1 kB a point while it works.
///
/// # Errors
/// Points that span no volume, no memory, too many cells.
pub(crate) fn regular(
    positions: &[[f64; 3]],
    weights: &[f64],
) -> Result<Triangulation, TriangulationError> {
    const STAGE: &str = "regular triangulation";
    let made = bridge::regular(positions.as_flattened(), weights).map_err(thrown(STAGE))?;
    if made.dimension() != 3 {
        return Err(SitesError::flat(positions.len(), made.dimension()).into());
    }
    Triangulation::filled(made.cells(), positions.len() as u32, |cells, beside| {
        made.copy(cells.as_flattened_mut(), beside.as_flattened_mut()).map_err(thrown(STAGE))
    })
}
