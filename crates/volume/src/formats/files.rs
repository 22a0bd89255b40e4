//! Which files a volume is read from.

use std::path::{Path, PathBuf};

use super::begins::is_dicom;
use super::detect::{data_files, start_of};
use crate::ReadOptions;
use crate::read::series::is_zarr;

/// All files that a volume is read from: a file and those that its header names; of a folder the DICOM files in
/// it, its slices, or all of a Zarr store. As far as can be told: what cannot be read has none.
pub fn files_of(path: &Path) -> Vec<PathBuf> {
    if path.is_dir() {
        return files_of_folder(path);
    }
    let mut files = data_files(path, &ReadOptions::default()).unwrap_or_default();
    files.push(path.to_owned());
    files
}

fn files_of_folder(folder: &Path) -> Vec<PathBuf> {
    let files = files_below(folder);
    if is_zarr(folder) {
        return files;
    }
    let is_dicom = |path: &PathBuf| start_of(path).is_ok_and(|start| is_dicom(&start));
    let series: Vec<PathBuf> = files.into_iter().filter(is_dicom).collect();
    #[cfg(feature = "formats")]
    if series.is_empty() {
        return crate::read::slices::slices(folder).unwrap_or_default();
    }
    series
}

/// The files in a folder and those in it. Links to folders are not followed: they may lead round in circles.
fn files_below(folder: &Path) -> Vec<PathBuf> {
    let (mut folders, mut files) = (vec![folder.to_owned()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                folders.push(entry.path());
            } else if entry.path().is_file() {
                files.push(entry.path());
            }
        }
    }
    files
}
