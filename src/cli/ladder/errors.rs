//! What a level of detail misses of the volume.

use serde::Serialize;
use walpha_base::Monitor;

use crate::cli::filled::filled_in;
use crate::interpolate::{Deviation, Grid, Interpolant, InterpolateError};
use crate::{AlphaShape, Units, Volume};

/// Root mean square differences of F from a volume, in gray levels.
#[derive(Clone, Copy, Serialize)]
pub(super) struct Errors {
    /// On the samples that the shape covers; null where there are none.
    #[serde(rename = "rmse_inside")]
    pub inside: Option<f64>,
    /// On all samples, F being filled in.
    #[serde(rename = "rmse_filled")]
    pub filled: f64,
}

impl Errors {
    /// Of the shape of a volume's points, whose gray levels are given: its own values may be others. One
    /// triangulation, and two passes over the volume.
    pub(super) fn of(
        shape: &AlphaShape,
        grays: &[f64],
        volume: &Volume,
        units: Units,
        monitor: &Monitor,
    ) -> Result<Self, InterpolateError> {
        let grid = Grid::of(volume, units);
        let rmse = |interpolant: Interpolant<'_>| -> Result<Option<f64>, InterpolateError> {
            Ok(Deviation::of(volume, &interpolant.resample(&grid)?).rmse)
        };
        let inside = rmse(Interpolant::with_values(shape, grays)?)?;
        let (whole, all) = filled_in(shape, grays, volume, units, monitor)?;
        let filled = rmse(Interpolant::with_values(&whole, &all)?)?;
        Ok(Self { inside, filled: filled.unwrap_or_default() })
    }
}
