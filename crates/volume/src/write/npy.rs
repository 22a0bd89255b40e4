use std::io::{self, Write};

use ndarray_npy::{WriteNpyError, WriteNpyExt};

use crate::Volume;

/// Writes the samples of a volume as a `NumPy` array: `f32`, axes z, y, x.
///
/// # Errors
/// Whatever `out` returns.
pub(crate) fn npy(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    volume.samples().write_npy(out).map_err(|error| match error {
        WriteNpyError::Io(error) => error,
        other => io::Error::other(other),
    })
}
