//! Interpolants that cover a whole volume, in gray levels.

use crate::interpolate::{InterpolateError, fill_monitored};
use crate::{AlphaShape, Units, Volume};
use walpha_base::Monitor;

/// A shape of a volume's points filled in, and the gray levels of its points, of which the first are given:
/// the shape may have other values.
pub(super) fn filled_in(
    shape: &AlphaShape,
    grays: &[f64],
    volume: &Volume,
    units: Units,
    monitor: &Monitor,
) -> Result<(AlphaShape, Vec<f64>), InterpolateError> {
    let whole = fill_monitored(shape, Some(volume), units, monitor)?;
    // The corners follow the points, in gray levels already.
    let corners = whole.points().values.iter().flatten().skip(grays.len());
    let all = grays.iter().chain(corners).copied().collect();
    Ok((whole, all))
}
