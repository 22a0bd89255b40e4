use serde::{Deserialize, Serialize};
use walpha_base::Monitor;

use super::least_squares::{Normal, Solved};
use super::{Grid, Interpolant, InterpolateError, fill};
use walpha_points::Units;
use walpha_shape::AlphaShape;
use walpha_volume::Volume;

/// The samples to which the values of points are fitted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Refit {
    /// All samples, with F on the whole triangulation that [`fill`](super::fill()) makes.
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
    /// How the values were fitted.
    pub fit: Fit,
}

/// How values were fitted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// The samples to which they were fitted.
    pub to: Refit,
    /// The number of steps of conjugate gradients.
    pub steps: usize,
    /// The residual of the normal equations divided by that of the values before.
    pub residual: f64,
}

/// Computes the values at the points of a shape for which the sum of squared errors of F over the samples of a volume is least.
///
/// F is linear in its values, so this is a linear least-squares problem. Its normal equations, Σₛ φᵥ(s) (f(s) − F(s)) = 0 for
/// each point v with the piecewise linear function φᵥ that is 1 there and 0 at the others, are symmetric and sparse; conjugate
/// gradients (Hestenes and Stiefel 1952, doi:10.6028/jres.049.044) solve them to a relative residual of 10⁻⁶, starting from the
/// values of the points. A value on which no sample depends does not change, such as that of a hidden point; nor do the values of
/// corners that [`fill`](super::fill()) adds. Missing samples are ignored.
///
/// O(samples + points) for each step, of which a few dozen suffice. Memory is 8 bytes a sample and about 200 a point. The result
/// does not depend on the number of threads.
///
/// # Errors
/// The points have no values, or there is not enough memory; and the errors of [`fill`](super::fill()).
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
    // The added corners come last.
    let free = shape.points().len();
    let normal = Normal::assemble(&*interpolant, &resampled.owners, &grid, volume, free)?;
    let Solved { change, steps, residual } = normal.solve(monitor)?;
    tracing::debug!(steps, residual, "refit");
    let values = interpolant.values()[..free].iter().zip(change).map(|(v, d)| v + d).collect();
    Ok(Refitted { values, fit: Fit { to, steps, residual } })
}
