//! DICOM series: the slices of one series as a volume.

mod claims;
mod slice;
mod stack;

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::described::{Described, Encoding};
use super::folder::dicom_files;
use super::format_error;
use crate::progress;
use crate::shown::shown;
use crate::volume::{Dims, Dtype, Endian, Volume, VolumeError};
use slice::Slice;
use stack::stacked;

/// Reads the series that a file belongs to: all slices of it in the same folder.
pub(super) fn read_series_of(path: &Path) -> Result<Volume, VolumeError> {
    let one = Slice::open(path)?;
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut slices = slices(&dicom_files(folder)?)?;
    slices.retain(|slice| slice.series == one.series);
    assemble(path, slices)
}

/// Reads the one series in a folder.
pub(super) fn read_folder(folder: &Path, files: &[PathBuf]) -> Result<Volume, VolumeError> {
    let slices = slices(files)?;
    let mut series: Vec<(&str, usize, &Path)> = Vec::new();
    for slice in &slices {
        match series.iter_mut().find(|(name, ..)| *name == slice.series) {
            Some((_, count, _)) => *count += 1,
            None => series.push((&slice.series, 1, &slice.path)),
        }
    }
    if series.len() > 1 {
        let list: Vec<String> = series
            .iter()
            .map(|(_, count, path)| format!("{count} slices with {}", shown(path)))
            .collect();
        let what = format!(
            "holds {} DICOM series, {}; name a file of the one to read",
            series.len(),
            list.join(", ")
        );
        return Err(format_error(folder, what));
    }
    assemble(folder, slices)
}

/// The slices among these files; indices of media (DICOMDIR) are none.
fn slices(files: &[PathBuf]) -> Result<Vec<Slice>, VolumeError> {
    let is_index = |path: &PathBuf| path.file_name().is_some_and(|name| name == "DICOMDIR");
    files.par_iter().filter(|path| !is_index(path)).map(|path| Slice::open(path)).collect()
}

/// The volume of slices of one series.
fn assemble(path: &Path, slices: Vec<Slice>) -> Result<Volume, VolumeError> {
    let (slices, frame) = stacked(path, slices)?;
    let first = &slices[0];
    let dims = Dims::new(first.columns, first.rows, slices.len() as u64)?;
    let gray_levels = slices.iter().all(|slice| slice.gray_levels);
    let mut samples = Vec::new();
    samples.try_reserve_exact(dims.samples()).map_err(|_| {
        let bytes = dims.samples() * size_of::<f32>();
        let what = format!("needs {bytes} bytes of memory, which cannot be had: crop it first");
        format_error(path, what)
    })?;
    // So many at once: pixels decoded ahead take memory.
    for (done, batch) in slices.chunks(16).enumerate() {
        let pixels: Vec<Vec<f32>> =
            batch.par_iter().map(Slice::pixels).collect::<Result<_, _>>()?;
        samples.extend(pixels.into_iter().flatten());
        progress::report((16 * done + batch.len()) as u64, slices.len() as u64);
    }
    let dtype = if gray_levels { Dtype::U8 } else { Dtype::F32 };
    let (endian, encoding) = (Endian::Little, Encoding::Raw);
    Described { dims, dtype, endian, frame, encoding }.volume(samples)
}
