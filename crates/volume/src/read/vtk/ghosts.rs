//! Samples that VTK hides.

use std::path::Path;

use walpha_base::shown::shown;

use crate::error::format_error;
use crate::{Reason, VolumeError};

/// The array of bytes that says which points or cells are copies of those of another piece, or hidden.
pub(super) const NAME: &str = "vtkGhostType";
/// Its bits of hidden points and cells (vtkDataSetAttributes.h).
const HIDDEN_POINT: u8 = 2;
const HIDDEN_CELL: u8 = 32;

/// Which samples are hidden by these bytes, `None` where none is. They are not data: the least of the others replaces
/// them.
pub(super) fn hide(
    path: &Path,
    samples: &mut [f32],
    bytes: &[f32],
    cells: bool,
) -> Result<Option<Vec<bool>>, VolumeError> {
    let bit = if cells { HIDDEN_CELL } else { HIDDEN_POINT };
    let hidden: Vec<bool> = bytes.iter().map(|&byte| byte as u8 & bit != 0).collect();
    let count = hidden.iter().filter(|&&hidden| hidden).count();
    if count == 0 {
        return Ok(None);
    }
    if count == hidden.len() {
        let reason = Reason::content("hides all its samples (vtkGhostType)", "name another file");
        return Err(format_error(path, reason));
    }
    let there =
        samples.iter().zip(&hidden).filter(|(sample, hidden)| !**hidden && sample.is_finite());
    let least = there.map(|(&sample, _)| sample).fold(f32::INFINITY, f32::min);
    samples
        .iter_mut()
        .zip(&hidden)
        .filter(|(_, hidden)| **hidden)
        .for_each(|(sample, _)| *sample = least);
    tracing::warn!("{}: {count} samples are hidden (vtkGhostType), and no data", shown(path));
    Ok(Some(hidden))
}
