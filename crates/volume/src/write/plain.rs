//! Formats with hardly a header: raw and NPY.

use std::io::{self, Write};

use walpha_base::npy;

use crate::Volume;

/// Writes the samples of a volume and nothing else: `f32`, little-endian, x fastest.
///
/// # Errors
/// Errors of `out`.
pub(crate) fn raw(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    npy::write_elements(out, volume.as_slice())
}

/// Writes the samples of a volume as a `NumPy` array: `f32`, axes z, y, x.
///
/// # Errors
/// Errors of `out`.
pub(crate) fn npy(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    let dims = volume.dims();
    npy::write(out, &[dims.z(), dims.y(), dims.x()], volume.as_slice())
}
