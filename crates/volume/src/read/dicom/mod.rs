//! DICOM series: reads the slices of one series as a volume. Each slice is a file, or several are the frames of one file.

mod claims;
mod distances;
mod files;
mod header;
mod index;
mod nuclear;
mod pixels;
mod segments;
mod slice;
mod stack;
mod start;
mod values;
mod volumes;

use std::path::Path;

use ndarray::Array3;
use walpha_base::Monitor;
use walpha_base::advice::{Setting, advice};
use walpha_base::memory::try_with_capacity;
use walpha_base::parallel::prelude::*;
use walpha_base::shown::{counted, number, shown};
use walpha_base::sort::sort_by;

use super::ReadOptions;
use super::series::Series;
use crate::error::format_error;
use crate::rounding::Rounding;
use crate::{Dims, Dtype, Reason, Volume, VolumeError};
use files::{SeriesFiles, pattern, reason, skippable};
use pixels::pixels;
use slice::{DicomFile, Slice};
use stack::{Order, Stack, stacked};
use volumes::{chosen, without_copies};

/// Reads the series that a file belongs to: all of its slices in the same folder.
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
    let slices = one.slices?;
    if slices.iter().any(|slice| slice.segment.is_some()) {
        // A segmentation is complete in one file.
        one.notes.iter().for_each(|note| tracing::warn!("{} {note}", shown(path)));
        return assemble(path, slices, options, monitor);
    }
    let mut files = SeriesFiles::of(folder, false)?;
    files.found.retain(|other| other.series == one.series);
    // Unreadable files beside it may be anything, except those with similar names.
    let names: Vec<String> = files.found.iter().map(|found| pattern(&found.path)).collect();
    let near = |other: &Path| names.contains(&pattern(other));
    assemble(path, files.slices(options.skip_damaged, near)?, options, monitor)
}

/// Reads the only series in a folder, or the one asked for.
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
        (None, []) => return assemble(folder, files.slices(skip, |_| true)?, options, monitor),
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
            // Digits may be a number or the end of a UID; a number takes precedence.
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
    assemble(folder, files.slices(skip, |_| true)?, options, monitor)
}

/// The series in a folder that have images, in the order of their file names.
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

/// Builds the volume from the slices of one series. Slices whose pixels cannot be read are refused, or left out with a warning if
/// that is asked for.
fn assemble(
    path: &Path,
    mut slices: Vec<Slice>,
    options: &ReadOptions,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    loop {
        let error = match volume(path, slices.clone(), options, monitor)? {
            Err(error) => error,
            Ok(volume) => return Ok(volume),
        };
        let of = match &error {
            VolumeError::Format { path, .. } | VolumeError::Io { path, .. } => path.clone(),
            _ => return Err(error),
        };
        let count = slices.len();
        slices.retain(|slice| slice.path != of);
        // The error is not about one of several slices.
        if slices.len() == count || slices.is_empty() {
            return Err(error);
        }
        if !options.skip_damaged {
            return Err(skippable(error));
        }
        tracing::warn!("{} is left out: {}", shown(&of), reason(&error));
    }
}

/// Builds a volume from slices. The inner error is about a file whose pixels cannot be read; the outer error is about the slices
/// as a whole.
fn volume(
    path: &Path,
    slices: Vec<Slice>,
    options: &ReadOptions,
    monitor: &Monitor,
) -> Result<Result<Volume, VolumeError>, VolumeError> {
    let slices = match without_copies(path, slices)? {
        Ok(slices) => slices,
        Err(error) => return Ok(Err(error)),
    };
    if slices.iter().any(|slice| slice.segment.is_some()) {
        return segments::volume(path, slices, options, monitor).map(Ok);
    }
    let slices = chosen(path, slices, options.frame)?;
    let Stack { slices, frame, order } = stacked(path, slices, options.no_resample)?;
    let dtypes = slices.iter().map(Slice::dtype);
    let dtype = dtypes.reduce(|a, b| if a == b { a } else { Dtype::F32 }).unwrap_or(Dtype::F32);
    let (samples, padded) = match samples(&slices, monitor) {
        Ok(samples) => samples,
        Err(error) => return Ok(Err(error)),
    };
    let (samples, padded, dtype) = match order {
        Order::Between(places) => {
            let (samples, padded) = resampled(samples, padded, slices.len(), &places)?;
            (samples, padded, Dtype::F32)
        }
        _ => (samples, padded, dtype),
    };
    let (columns, rows) = (slices[0].columns as usize, slices[0].rows as usize);
    let planes = samples.len() / (columns * rows);
    let samples = Array3::from_shape_vec((planes, rows, columns), samples);
    let volume = Volume::of_file(samples.expect("whole planes"), frame)?.with_dtype(dtype);
    let Some(padded) = padded else { return Ok(Ok(volume)) };
    let count = padded.par_iter().filter(|&&padded| padded).count();
    let values = paddings(&slices);
    let Some(volume) = volume.with_padding(padded) else {
        let what =
            format!("holds nothing but padding (Pixel Padding Value {values}): {count} samples");
        return Err(format_error(path, Reason::content(what, "name another series")));
    };
    tracing::warn!(
        "{} of padding (Pixel Padding Value {values}), which is not data: masked",
        counted(count as u64, "sample")
    );
    Ok(Ok(volume))
}

/// The stored numbers that are padding.
fn paddings(slices: &[Slice]) -> String {
    let mut all: Vec<String> = Vec::new();
    for padding in slices.iter().filter_map(|slice| slice.values.padding) {
        let (low, high) = (number(padding.low), number(padding.high));
        let shown = if low == high { low } else { format!("{low} to {high}") };
        if !all.contains(&shown) {
            all.push(shown);
        }
    }
    all.join(", ")
}

/// The samples of slices, one after the other; and which of them are padding, if any is.
fn samples(slices: &[Slice], monitor: &Monitor) -> Result<Padded, VolumeError> {
    let first = &slices[0];
    let dims = Dims::new(first.columns, first.rows, slices.len() as u64)?;
    let mut samples = try_with_capacity(dims.samples(), || "the slices of a series".into())?;
    samples.resize(dims.samples(), 0.0);
    let each = dims.samples() / slices.len();
    let mut padded: Vec<Option<Vec<bool>>> = vec![None; slices.len()];
    let targets = samples.chunks_exact_mut(each).zip(&mut padded);
    let mut places: Vec<_> = slices.iter().zip(targets).collect();
    // The frames of one file are decoded together.
    sort_by(&mut places, |a, b| a.0.path.cmp(&b.0.path));
    let mut files: Vec<_> = places.chunk_by_mut(|a, b| a.0.path == b.0.path).collect();
    let count = files.len();
    let rounding = Rounding::default();
    // The number of files at a time is limited, as decoded pixels take memory.
    for (done, batch) in files.chunks_mut(16).enumerate() {
        batch.par_iter_mut().try_for_each(|file| {
            let frames: Vec<&Slice> = file.iter().map(|(slice, _)| *slice).collect();
            for ((_, (place, padded)), plane) in file.iter_mut().zip(pixels(&frames, &rounding)?) {
                place.copy_from_slice(&plane.samples);
                **padded = plane.padded;
            }
            Ok::<_, VolumeError>(())
        })?;
        monitor.report((16 * done + batch.len()) as u64, count as u64)?;
    }
    rounding.say(&slices[0].path);
    if padded.iter().all(Option::is_none) {
        return Ok((samples, None));
    }
    let mut all = try_with_capacity(dims.samples(), || "the mask of a volume".into())?;
    for padded in padded {
        match padded {
            Some(padded) => all.extend(padded),
            None => all.resize(all.len() + each, false),
        }
    }
    Ok((samples, Some(all)))
}

/// The samples and, if any is padding, a mask of the padding.
type Padded = (Vec<f32>, Option<Vec<bool>>);

/// Interpolates planes between slices: mixtures of the slice below and a share of the next. A mixture with padding is padding.
fn resampled(
    samples: Vec<f32>,
    padded: Option<Vec<bool>>,
    slices: usize,
    places: &[(usize, f64)],
) -> Result<Padded, VolumeError> {
    let each = samples.len() / slices;
    let total = Dims::new(each as u64, 1, places.len() as u64)?.samples();
    let mut out = try_with_capacity(total, || "resampled slices".into())?;
    let mut mask = match &padded {
        Some(_) => try_with_capacity(total, || "the mask of a volume".into())?,
        None => Vec::new(),
    };
    let of = |slice: usize| slice * each..(slice + 1) * each;
    for &(below, share) in places {
        let above = if share > 0.0 { below + 1 } else { below };
        let (low, high) = (&samples[of(below)], &samples[of(above)]);
        let mixed = low.iter().zip(high).map(|(&low, &high)| {
            let (low, high) = (f64::from(low), f64::from(high));
            (low + (high - low) * share) as f32
        });
        out.extend(mixed);
        if let Some(padded) = &padded {
            mask.extend(padded[of(below)].iter().zip(&padded[of(above)]).map(|(&a, &b)| a || b));
        }
    }
    Ok((out, padded.map(|_| mask)))
}
