use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::{ReadOptions, format_error, io_error, slices};
use crate::volume::{Volume, VolumeError};

/// Reads a folder: a Zarr store, a DICOM series, or slices as images.
pub(super) fn read(folder: &Path, options: &ReadOptions) -> Result<Volume, VolumeError> {
    let zarr = is_zarr(folder);
    let series = if zarr { Vec::new() } else { dicom_files(folder, true)? };
    for (given, fits, what) in [
        (options.level.is_some(), zarr, "is no pyramid: omit --level"),
        (options.frame.is_some(), zarr, "holds one volume: omit --frame"),
        (options.series.is_some(), !series.is_empty(), "is no DICOM series: omit --series"),
        (options.array.is_some(), false, "has no arrays with names: omit --array"),
    ] {
        if given && !fits {
            return Err(format_error(folder, what));
        }
    }
    if zarr {
        #[cfg(feature = "zarr")]
        return super::zarr::read(folder, options.level, options.frame);
        #[cfg(not(feature = "zarr"))]
        return Err(format_error(
            folder,
            format!("is a Zarr store, {}", super::detect::without("zarr")),
        ));
    }
    if !series.is_empty() {
        #[cfg(feature = "dicom")]
        return super::dicom::read_folder(folder, &series, options.series.as_deref());
        #[cfg(not(feature = "dicom"))]
        return Err(format_error(
            folder,
            format!("is a folder of DICOM files, {}", super::detect::without("dicom")),
        ));
    }
    slices::read(folder)
}

/// What a folder is, for people.
pub(super) fn format_name(folder: &Path) -> Result<&'static str, VolumeError> {
    Ok(if is_zarr(folder) {
        "Zarr"
    } else if !dicom_files(folder, true)?.is_empty() {
        "DICOM series"
    } else {
        "folder of slices"
    })
}

/// Whether a folder is a Zarr array or group.
pub(super) fn is_zarr(folder: &Path) -> bool {
    [".zarray", ".zgroup", "zarr.json"].iter().any(|name| folder.join(name).is_file())
}

/// The DICOM files of a folder and, if wanted, of the folders in it, by content, in the order of their
/// names. Links to folders are not followed: they may lead round in circles.
pub(super) fn dicom_files(folder: &Path, nested: bool) -> Result<Vec<PathBuf>, VolumeError> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).map_err(io_error(&folder))? {
            let entry = entry.map_err(io_error(&folder))?;
            let path = entry.path();
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                if nested {
                    folders.push(path);
                }
            } else if path.is_file() && is_dicom(&path).unwrap_or(false) {
                files.push(path);
            }
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
