use serde::{Deserialize, Serialize};
use walpha_base::Monitor;

use super::least_squares::{Normal, Solved};
use super::{Grid, Interpolant, InterpolateError, fill};
use walpha_points::Units;
use walpha_shape::AlphaShape;
use walpha_volume::Volume;

/// Which samples the values of points are fitted to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Refit {
    /// All samples, with F on the whole triangulation as [`fill`](super::fill()) makes it.
    #[default]
    Whole,
    /// The samples on the shape.
    Shape,
}

/// Values fitted to a volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Refitted {
    /// A value for each point of the shape, in gray levels.
    pub values: Vec<f64>,
    /// How they were found.
    pub fit: Fit,
}

/// How values were fitted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// To which samples.
    pub to: Refit,
    /// Steps of conjugate gradients.
    pub steps: usize,
    /// The residual of the normal equations over that of the values before.
    pub residual: f64,
}

/// The values at the points of a shape with which F has the least sum of squared errors over the
/// samples of a volume.
///
/// F is linear in its values, so this is a linear problem of least squares. Its normal equations,
/// Σₛ φᵥ(s) (f(s) − F(s)) = 0 for each point v with the piecewise linear function φᵥ that is 1 there
/// and 0 at the others, are symmetric and sparse; conjugate gradients (Hestenes and Stiefel 1952,
/// doi:10.6028/jres.049.044) solve them to a relative residual of 10⁻⁶, beginning with the values
/// that the points have. A value that no sample depends on stays as it is: that of a hidden point,
/// say. So do the values of corners that [`fill`](super::fill()) adds. Missing samples take no part.
///
/// O(samples + points) for each step, of which a few dozen do; 8 bytes a sample and about 200 a
/// point. The result does not depend on the number of threads.
///
/// # Errors
/// Points without values; no memory; what [`fill`](super::fill()) refuses.
pub fn refit(
    shape: &AlphaShape,
    volume: &Volume,
    units: Units,
    to: Refit,
) -> Result<Refitted, InterpolateError> {
    let monitor = &*Monitor::current();
    let filled = match to {
        Refit::Whole => Some(monitor.unreported().watch(|| fill(shape, Some(volume), units))?),
        Refit::Shape => None,
    };
    let interpolant = Interpolant::new(filled.as_ref().unwrap_or(shape))?;
    let grid = Grid::of(volume, units);
    let (interpolant, grid) = interpolant.by_index(&grid);
    let resampled = interpolant.resample(&grid)?;
    // The corners that were added come last.
    let free = shape.points().len();
    let normal = Normal::assemble(&*interpolant, &resampled.owners, &grid, volume, free)?;
    let Solved { change, steps, residual } = normal.solve(monitor)?;
    tracing::debug!(steps, residual, "refit");
    let values = interpolant.values()[..free].iter().zip(change).map(|(v, d)| v + d).collect();
    Ok(Refitted { values, fit: Fit { to, steps, residual } })
}
