use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::{format_error, io_error, slices};
use crate::volume::{Volume, VolumeError};

/// Reads a folder: a Zarr store, a DICOM series, or slices as images.
pub(super) fn read(folder: &Path, level: Option<u32>) -> Result<Volume, VolumeError> {
    if is_zarr(folder) {
        #[cfg(feature = "zarr")]
        return super::zarr::read(folder, level);
        #[cfg(not(feature = "zarr"))]
        return Err(format_error(
            folder,
            format!("is a Zarr store, {}", super::detect::without("zarr")),
        ));
    }
    if let Some(level) = level {
        let what = format!("is no pyramid and has no level {level}; leave --level away");
        return Err(format_error(folder, what));
    }
    let series = dicom_files(folder)?;
    if !series.is_empty() {
        #[cfg(feature = "dicom")]
        return super::dicom::read_folder(folder, &series);
        #[cfg(not(feature = "dicom"))]
        return Err(format_error(
            folder,
            format!("is a folder of DICOM files, {}", super::detect::without("dicom")),
        ));
    }
    slices::read(folder)
}

/// Whether a folder is a Zarr array or group.
pub(super) fn is_zarr(folder: &Path) -> bool {
    [".zarray", ".zgroup", "zarr.json"].iter().any(|name| folder.join(name).is_file())
}

/// The DICOM files of a folder, by content, in the order of their names.
pub(super) fn dicom_files(folder: &Path) -> Result<Vec<PathBuf>, VolumeError> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(io_error(folder))? {
        let path = entry.map_err(io_error(folder))?.path();
        if path.is_file() && is_dicom(&path).unwrap_or(false) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn is_dicom(path: &Path) -> io::Result<bool> {
    let mut start = Vec::new();
    File::open(path)?.take(132).read_to_end(&mut start)?;
    Ok(start.get(128..) == Some(b"DICM"))
}
