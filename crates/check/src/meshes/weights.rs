//! Weights in a file of their own.

use std::path::Path;

use super::MeshError;
use super::scan::Scan;

/// Reads weights, one for each point: NPY with one axis, or text with a number on each line, possibly after a name.
///
/// # Errors
/// A file that cannot be read, or contains anything but numbers.
pub fn open_weights(path: impl AsRef<Path>) -> Result<Vec<f64>, MeshError> {
    let bytes = std::fs::read(path)?;
    if bytes.starts_with(walpha_base::npy::MAGIC) {
        return npy(&bytes);
    }
    let mut scan = Scan::with_comments(&bytes);
    let (mut words, mut weights) = (Vec::new(), Vec::new());
    while scan.record(&mut words) {
        if words.len() > 1 {
            return Err(scan
                .fault("a line has more than one number")
                .with_advice("give weights alone, one on each line"));
        }
        let is_name = weights.is_empty() && words[0][0].is_ascii_alphabetic();
        if !(is_name && words[0].eq_ignore_ascii_case(b"weight")) {
            weights.push(scan.value(words[0], "a weight")?);
        }
    }
    Ok(weights)
}

#[cfg(feature = "npz")]
fn npy(bytes: &[u8]) -> Result<Vec<f64>, MeshError> {
    crate::schema::read_npy("weights", bytes).map_err(|error| MeshError::new(error.to_string()))
}

#[cfg(not(feature = "npz"))]
fn npy(_: &[u8]) -> Result<Vec<f64>, MeshError> {
    Err(MeshError::new("the file is NPY, which this build does not read")
        .with_advice("give weights as text, one on each line"))
}
