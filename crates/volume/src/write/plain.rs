//! Formats with hardly a header: raw and NPY.

use std::io::{self, Write};

use ndarray_npy::{WriteNpyError, WriteNpyExt};

use crate::Volume;

/// The number of samples turned into bytes at a time.
const CHUNK: usize = 1 << 16;

/// Writes the samples of a volume and nothing else: `f32`, little-endian, x fastest.
///
/// # Errors
/// Errors of `out`.
pub(crate) fn raw(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(CHUNK * 4);
    for samples in volume.as_slice().chunks(CHUNK) {
        bytes.clear();
        bytes.extend(samples.iter().flat_map(|sample| sample.to_le_bytes()));
        out.write_all(&bytes)?;
    }
    Ok(())
}

/// Writes the samples of a volume as a `NumPy` array: `f32`, axes z, y, x.
///
/// # Errors
/// Errors of `out`.
pub(crate) fn npy(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    volume.samples().write_npy(out).map_err(|error| match error {
        WriteNpyError::Io(error) => error,
        other => io::Error::other(other),
    })
}
