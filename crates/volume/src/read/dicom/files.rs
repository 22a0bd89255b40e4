//! The files of a series: those that belong to it, and those that cannot be read.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use walpha_base::advice::{Setting, advice};
use walpha_base::parallel::prelude::*;
use walpha_base::shown::shown;

use super::slice::{DicomFile, Slice};
use crate::error::format_error;
use crate::formats::recognised;
use crate::read::OpenFile;
use crate::read::series::{self, Files};
use crate::{Reason, VolumeError};

/// The files of a folder, sorted by what they are.
pub(super) struct SeriesFiles {
    pub found: Vec<DicomFile>,
    /// The files that may be slices but cannot be read, each with the reason.
    damaged: Vec<(PathBuf, VolumeError)>,
}

impl SeriesFiles {
    /// Reads the headers in a folder. Indices of media (DICOMDIR) are skipped.
    pub(super) fn of(folder: &Path, nested: bool) -> Result<Self, VolumeError> {
        let is_index = |path: &PathBuf| path.file_name().is_some_and(|name| name == "DICOMDIR");
        let Files { dicom, suspects } = series::files(folder, nested)?;
        let open = |path: &PathBuf| (path.clone(), DicomFile::open(path));
        let opened: Vec<_> = dicom.par_iter().filter(|path| !is_index(path)).map(open).collect();
        let mut files = Self { found: Vec::new(), damaged: Vec::new() };
        for (path, opened) in opened {
            match opened {
                Ok(found) if found.is_directory => {}
                Ok(found) => files.found.push(found),
                Err(error) => files.damaged.push((path, error)),
            }
        }
        // These are headers that end before they name their series.
        let named = files.found.iter().any(|found| !found.series.is_empty());
        for broken in files
            .found
            .extract_if(.., |found| named && found.series.is_empty() && found.slices.is_err())
        {
            if let Err(error) = broken.slices {
                files.damaged.push((broken.path, error));
            }
        }
        files.damaged.extend(suspects.into_iter().map(|path| {
            let error = format_error(&path, not_dicom(&path));
            (path, error)
        }));
        Ok(files)
    }

    /// The slices of a series. Files that cannot be read are refused, or left out with a warning if `skip` is set.
    ///
    /// The series of an unreadable file cannot be known. `near` decides whether such a file may belong to this series; others are
    /// left out with a warning.
    pub(super) fn slices(
        self,
        skip: bool,
        near: impl Fn(&Path) -> bool,
    ) -> Result<Vec<Slice>, VolumeError> {
        let mut slices = Vec::new();
        let mut notes: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
        let mut damaged = self.damaged;
        let some = self.found.iter().any(|found| found.slices.is_ok());
        for found in self.found {
            match found.slices {
                Ok(of_file) => {
                    slices.extend(of_file);
                    found
                        .notes
                        .into_iter()
                        .for_each(|note| notes.entry(note).or_default().push(found.path.clone()));
                }
                Err(error) if skip => damaged.push((found.path, error)),
                Err(error) if some => return Err(skippable(error)),
                Err(error) => return Err(error),
            }
        }
        for (path, error) in damaged {
            if near(&path) && !skip {
                return Err(skippable(error));
            }
            tracing::warn!("{} is left out: {}", shown(&path), reason(&error));
        }
        for (note, of) in notes {
            match &of[..] {
                [first, _, ..] => {
                    tracing::warn!("{} {note} ({} files are so)", shown(first), of.len());
                }
                of => of.iter().for_each(|path| tracing::warn!("{} {note}", shown(path))),
            }
        }
        Ok(slices)
    }
}

/// Adds the advice that the remaining slices can be read to an error.
pub(super) fn skippable(error: VolumeError) -> VolumeError {
    match error {
        VolumeError::Format { path, reason } => {
            let next = advice![", or go on without it: ", Setting::SkipDamaged];
            let next = reason.advice().and(next);
            VolumeError::Format { path, reason: Reason::content(reason.to_string(), next) }
        }
        other => other,
    }
}

/// What is wrong with a file, without the name of the file.
pub(super) fn reason(error: &VolumeError) -> String {
    match error {
        VolumeError::Format { reason, .. } => format!("it {reason}"),
        other => other.to_string(),
    }
}

/// What is wrong with a file that has the name of a DICOM file but is not one.
fn not_dicom(path: &Path) -> Reason {
    let open = OpenFile::open(path);
    match open.as_ref().map(|file| (file.length(), file.start())) {
        Ok((0, _)) => Reason::damaged("is empty, beside DICOM files"),
        Ok((length, start)) => {
            if let Some(what) = recognised(start) {
                let what = format!("is {what}, beside DICOM files");
                return Reason::content(what, "move it out of the folder");
            }
            Reason::content(
                format!(
                    "has {length} bytes and neither the mark of DICOM (DICM at byte 128) nor its elements, beside DICOM files"
                ),
                "move it out of the folder, or copy it again if it is a slice",
            )
        }
        Err(error) => Reason::content(error.to_string(), "move it out of the folder"),
    }
}

/// The name of a file without its digits, which is common to the slices of a series.
pub(super) fn pattern(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.chars().filter(|c| !c.is_ascii_digit()).collect()
}
