use std::io::{self, Write};

use crate::Volume;

/// Samples turned into bytes at a time.
const CHUNK: usize = 1 << 16;

/// Writes the samples of a volume and nothing else: `f32`, little-endian, x fastest.
///
/// # Errors
/// Whatever `out` returns.
pub(crate) fn raw(volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(CHUNK * 4);
    for samples in volume.as_slice().chunks(CHUNK) {
        bytes.clear();
        bytes.extend(samples.iter().flat_map(|sample| sample.to_le_bytes()));
        out.write_all(&bytes)?;
    }
    Ok(())
}
