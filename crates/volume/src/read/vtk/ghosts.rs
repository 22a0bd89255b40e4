//! Samples that VTK marks as hidden.

use std::path::Path;

use walpha_base::shown::shown;

use crate::error::format_error;
use crate::{Reason, VolumeError};

/// The name of the array of bytes that mark points or cells as hidden, or as copies of those in another piece.
pub(super) const NAME: &str = "vtkGhostType";
/// The bits of hidden points and cells in such bytes (vtkDataSetAttributes.h).
const HIDDEN_POINT: u8 = 2;
const HIDDEN_CELL: u8 = 32;

/// Finds the samples that these bytes hide; `None` if none is hidden. They are not data: the least of the others replaces them.
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
