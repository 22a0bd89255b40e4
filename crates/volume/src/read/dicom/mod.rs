//! DICOM series: the slices of one series as a volume, each in a file of its own or several as the
//! frames of one.

mod claims;
mod files;
mod slice;
mod stack;

use std::path::Path;

use rayon::prelude::*;
use walpha_base::Monitor;
use walpha_base::advice::{Setting, advice};
use walpha_base::memory::asking;
use walpha_base::shown::shown;

use super::ReadOptions;
use super::frames::FrameChoice;
use super::layout::{Encoding, Layout};
use super::series::Series;
use crate::error::format_error;
use crate::{Dims, Dtype, Endian, Frame, Reason, Volume, VolumeError};
use files::{SeriesFiles, pattern, reason, skippable};
use slice::{DicomFile, Slice, pixels};
use stack::stacked;

/// Reads the series that a file belongs to: all slices of it in the same folder.
pub(crate) fn read_series_of(
    path: &Path,
    options: &ReadOptions,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    if options.series.is_some() {
        let reason = Reason::choice(
            Setting::Series,
            "is one file, and its series is read",
            advice!["omit ", Setting::Series, ", or name the folder"],
        );
        return Err(format_error(path, reason));
    }
    let one = DicomFile::open(path)?;
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    one.slices?;
    let mut files = SeriesFiles::of(folder, false)?;
    files.found.retain(|other| other.series == one.series);
    // Its neighbours may be anything, but those that are called alike.
    let names: Vec<String> = files.found.iter().map(|found| pattern(&found.path)).collect();
    let near = |other: &Path| names.contains(&pattern(other));
    let skip = options.skip_damaged;
    assemble(path, files.slices(skip, near)?, skip, monitor)
}

/// Reads the one series in a folder, or the one wanted.
pub(crate) fn read_folder(
    folder: &Path,
    options: &ReadOptions,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let (wanted, skip) = (options.series.as_deref(), options.skip_damaged);
    let mut files = SeriesFiles::of(folder, true)?;
    let listed = listed(&files.found);
    let list = || listed.iter().map(Series::to_string).collect::<Vec<_>>().join("; ");
    let chosen = match (wanted, &listed[..]) {
        (None, []) => return assemble(folder, files.slices(skip, |_| true)?, skip, monitor),
        (None, [one]) => one,
        (None, several) => {
            let count = several.len();
            let reason = Reason::choice(
                Setting::Series,
                format!("holds {count} DICOM series: {}", list()),
                advice!["choose one with ", Setting::Series, ", or name a file of it"],
            );
            return Err(format_error(folder, reason));
        }
        (Some(wanted), _) => {
            // Digits alone may end a UID, too, and are a number first of all.
            let is_it = |one: &&Series| match wanted.parse::<usize>() {
                Ok(number) => one.number == number,
                Err(_) => one.uid.ends_with(wanted),
            };
            listed.iter().find(is_it).ok_or_else(|| {
                format_error(
                    folder,
                    Reason::choice(
                        Setting::Series,
                        format!("has no series {wanted}: there are {}", list()),
                        advice!["choose one of these with ", Setting::Series],
                    ),
                )
            })?
        }
    };
    files.found.retain(|one| one.series == chosen.uid);
    assemble(folder, files.slices(skip, |_| true)?, skip, monitor)
}

/// The series in a folder that have images, in the order of the names of their files.
pub(crate) fn series(folder: &Path) -> Result<Vec<Series>, VolumeError> {
    Ok(listed(&SeriesFiles::of(folder, true)?.found))
}

fn listed(found: &[DicomFile]) -> Vec<Series> {
    let mut list: Vec<Series> = Vec::new();
    for one in found.iter().filter(|one| one.size.is_some()) {
        let known = list.iter().position(|series| series.uid == one.series);
        let place = known.unwrap_or_else(|| {
            let number = list.len() + 1;
            let (modality, description) = (one.modality.clone(), one.description.clone());
            let (uid, size) = (one.series.clone(), one.size.unwrap_or_default());
            list.push(Series {
                number,
                uid,
                modality,
                description,
                size,
                slices: 0,
                file: one.path.clone(),
            });
            list.len() - 1
        });
        list[place].slices += one.slices.as_ref().map_or(1, Vec::len);
    }
    list
}

/// The volume of slices of one series. Those whose pixels cannot be read are refused, or left out with a warning
/// where `skip` says so.
fn assemble(
    path: &Path,
    mut slices: Vec<Slice>,
    skip: bool,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    loop {
        let (stack, frame) = stacked(path, slices.clone())?;
        let error = match volume(path, &stack, frame, monitor) {
            Err(error) => error,
            done => return done,
        };
        let of = match &error {
            VolumeError::Format { path, .. } | VolumeError::Io { path, .. } => path.clone(),
            _ => return Err(error),
        };
        let count = slices.len();
        slices.retain(|slice| slice.path != of);
        // Nothing to do with one of several slices.
        if slices.len() == count || slices.is_empty() {
            return Err(error);
        }
        if !skip {
            return Err(skippable(error));
        }
        tracing::warn!("{} is left out: {}", shown(&of), reason(&error));
    }
}

/// The volume of a stack of slices that can all be read.
fn volume(
    path: &Path,
    slices: &[Slice],
    frame: Frame,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let first = &slices[0];
    let dims = Dims::new(first.columns, first.rows, slices.len() as u64)?;
    let mut samples = Vec::new();
    asking(|| samples.try_reserve_exact(dims.samples())).map_err(|_| {
        let bytes = dims.bytes(size_of::<f32>());
        let reason = Reason::unsupported(
            format!("needs {bytes} bytes of memory, more than is available"),
            "crop it first",
        );
        format_error(path, reason)
    })?;
    samples.resize(dims.samples(), 0.0);
    let mut places: Vec<(&Slice, &mut [f32])> =
        slices.iter().zip(samples.chunks_exact_mut(dims.samples() / slices.len())).collect();
    // Frames of one file are decoded together.
    places.sort_by(|a, b| a.0.path.cmp(&b.0.path));
    let mut files: Vec<_> = places.chunk_by_mut(|a, b| a.0.path == b.0.path).collect();
    let count = files.len();
    // So many at once: pixels decoded ahead take memory.
    for (done, batch) in files.chunks_mut(16).enumerate() {
        batch.par_iter_mut().try_for_each(|file| {
            let frames: Vec<&Slice> = file.iter().map(|(slice, _)| *slice).collect();
            let pixels = pixels(&frames)?;
            file.iter_mut()
                .zip(pixels)
                .for_each(|((_, place), pixels)| place.copy_from_slice(&pixels));
            Ok::<_, VolumeError>(())
        })?;
        monitor.report((16 * done + batch.len()) as u64, count as u64)?;
    }
    let dtype =
        slices.iter().map(|slice| slice.dtype).reduce(|a, b| if a == b { a } else { Dtype::F32 });
    let dtype = dtype.unwrap_or(Dtype::F32);
    let (endian, encoding) = (Endian::Little, Encoding::Raw);
    Layout { dims, dtype, endian, frame, encoding, frames: FrameChoice::ONE }.volume(samples)
}
