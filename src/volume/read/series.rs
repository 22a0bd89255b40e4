//! What is in a folder: a Zarr store, or the files of DICOM series.

use std::collections::VecDeque;
use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::io_error;
use crate::shown::shown;
use crate::volume::VolumeError;

/// A series of slices in a folder (DICOM).
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Series {
    /// Its place among those of the folder, from 1.
    pub number: usize,
    /// Its unique name.
    pub uid: String,
    /// As CT or MR.
    pub modality: String,
    /// What somebody called it.
    pub description: String,
    /// Columns and rows of the first slice.
    pub size: [u64; 2],
    /// How many slices it has.
    pub slices: usize,
    /// The first of its files.
    pub file: PathBuf,
}

impl fmt::Display for Series {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { number, uid, modality, description, size: [columns, rows], slices, file } = self;
        let called = [modality, description].map(String::as_str).join(" ");
        let comma = if called.trim().is_empty() { "" } else { ", " };
        let called = called.trim();
        write!(f, "{number}: {called}{comma}{slices} slices of {columns}×{rows}, {uid}, as ")?;
        f.write_str(&shown(file))
    }
}

/// Whether a folder is a Zarr array or group.
pub(crate) fn is_zarr(folder: &Path) -> bool {
    [".zarray", ".zgroup", "zarr.json"].iter().any(|name| folder.join(name).is_file())
}

/// The first DICOM file that is found in a folder or those in it.
pub(crate) fn first(folder: &Path) -> Result<Option<PathBuf>, VolumeError> {
    Walk::new(folder, true).next().transpose()
}

/// The DICOM files of a folder and, if wanted, of the folders in it, by content, in the order of their
/// names.
#[cfg(feature = "dicom")]
pub(super) fn files(folder: &Path, nested: bool) -> Result<Vec<PathBuf>, VolumeError> {
    let mut files = Walk::new(folder, nested).collect::<Result<Vec<_>, _>>()?;
    files.sort();
    Ok(files)
}

/// Goes through DICOM files. Links to folders are not followed: they may lead round in circles.
struct Walk {
    nested: bool,
    folders: Vec<PathBuf>,
    found: VecDeque<PathBuf>,
}

impl Walk {
    fn new(folder: &Path, nested: bool) -> Self {
        Self { nested, folders: vec![folder.to_owned()], found: VecDeque::new() }
    }

    fn open(&mut self, folder: &Path) -> io::Result<()> {
        for entry in std::fs::read_dir(folder)? {
            let entry = entry?;
            let path = entry.path();
            if !entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                self.found.push_back(path);
            } else if self.nested {
                self.folders.push(path);
            }
        }
        Ok(())
    }
}

impl Iterator for Walk {
    type Item = Result<PathBuf, VolumeError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            while let Some(path) = self.found.pop_front() {
                if path.is_file() && is_dicom(&path).unwrap_or(false) {
                    return Some(Ok(path));
                }
            }
            let folder = self.folders.pop()?;
            if let Err(error) = self.open(&folder) {
                return Some(Err(io_error(&folder)(error)));
            }
        }
    }
}

fn is_dicom(path: &Path) -> io::Result<bool> {
    let mut start = Vec::new();
    File::open(path)?.take(132).read_to_end(&mut start)?;
    Ok(start.get(128..) == Some(b"DICM"))
}
