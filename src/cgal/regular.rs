use super::ffi::bridge;
use super::thrown;
use crate::triangulation::{SitesError, TriangulationError};

const STAGE: &str = "regular triangulation";

/// CGAL's `Regular_triangulation_3` of points that are sites, or some of them, in three dimensions.
pub(crate) struct Regular(cxx::UniquePtr<bridge::Regular>);

/// Triangulates, inserting points in an order, each near the one before if it is to be fast. Expected
/// O(n log n) for points of even density; about 1 kB a point.
///
/// # Errors
/// Points that span no volume, no memory.
pub(crate) fn regular(
    positions: &[[f64; 3]],
    weights: &[f64],
    order: &[u32],
) -> Result<Regular, TriangulationError> {
    assert_eq!(positions.len(), weights.len(), "one weight for each point");
    assert!(order.iter().all(|&i| (i as usize) < weights.len()), "the order is one of the points");
    let made = bridge::regular(positions.as_flattened(), weights, order).map_err(thrown(STAGE))?;
    match made.dimension() {
        3 => Ok(Regular(made)),
        flat => Err(SitesError::flat(positions.len(), flat).into()),
    }
}

impl Regular {
    /// The number of cells, infinite ones included.
    pub(crate) fn cells(&self) -> usize {
        self.0.cells()
    }

    /// Writes the corners of each cell, the ghost being one past the last point, and what lies across
    /// its facets, as [`Triangulation`](crate::triangulation::Triangulation) has them.
    pub(crate) fn copy(
        &self,
        cells: &mut [[u32; 4]],
        beside: &mut [[u32; 4]],
    ) -> Result<(), TriangulationError> {
        self.0.copy(cells.as_flattened_mut(), beside.as_flattened_mut()).map_err(thrown(STAGE))
    }
}
