//! Volumes from files: by what the file holds first, then by its extension.

mod base64;
mod described;
mod detached;
mod detect;
#[cfg(feature = "dicom")]
mod dicom;
mod folder;
mod frames;
mod inr;
mod lines;
mod metaimage;
mod nifti;
mod npy;
mod npz;
mod nrrd;
mod payload;
mod raw;
mod slices;
mod text;
mod tiff;
mod vti;
mod vtk;
mod vtk_xml;
#[cfg(feature = "zarr")]
mod zarr;

use std::fmt;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;
use serde::Serialize;

pub(crate) use inr::read as read_inr;
pub(crate) use lines::Lines;
pub(crate) use npy::NpyFile;
use payload::PayloadError;
pub(crate) use payload::{Element, Length};
pub use raw::RawLayout;
pub(crate) use vtk_xml::VtkXml;

use detect::Kind;

use crate::shown::shown;

use super::{Dims, Dtype, Nan, Region, Volume, VolumeError, downsample};

/// What a user says about a file beyond its name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Reads the file as bare samples in this layout, whatever it looks like.
    pub raw: Option<RawLayout>,
    /// The level of a pyramid to read (OME-Zarr), 0 being the finest. Files without levels refuse it.
    pub level: Option<u32>,
    /// The array to read, by its name, of a file that may hold several (VTK, NPZ).
    pub array: Option<String>,
    /// The volume to read of a file of several (a fourth axis), from 0.
    pub frame: Option<u64>,
    /// The series to read of a folder of several (DICOM): its number, from 1, or the end of its UID, if
    /// that is no number.
    pub series: Option<String>,
    /// What becomes of samples that are NaN; without a word they are refused.
    pub nan: Option<Nan>,
    /// The part to take.
    pub region: Option<Region>,
    /// How many samples along each axis become one; `None` leaves them as they are.
    pub downsample: Option<NonZeroUsize>,
}

impl ReadOptions {
    /// The part of a volume that is asked for.
    pub(crate) fn part(&self, volume: Volume) -> Result<Volume, VolumeError> {
        let volume = match &self.region {
            Some(region) => region.of(&volume)?,
            None => volume,
        };
        Ok(match self.downsample {
            Some(n) => downsample(volume, n),
            None => volume,
        })
    }

    /// Refuses what says nothing about this kind of file.
    fn fit(&self, path: &Path, kind: Kind) -> Result<(), VolumeError> {
        let arrays = matches!(kind, Kind::VtkLegacy | Kind::VtkXml | Kind::Npz);
        let frames = matches!(
            kind,
            Kind::Nrrd | Kind::MetaImage | Kind::Nifti | Kind::NiftiGzip | Kind::Npy
        );
        #[cfg(feature = "dicom")]
        let series = kind == Kind::Dicom;
        #[cfg(not(feature = "dicom"))]
        let series = false;
        for (given, fits, what) in [
            (self.level.is_some(), false, "is no pyramid: omit --level"),
            (self.array.is_some(), arrays, "has no arrays with names: omit --array"),
            (self.frame.is_some(), frames, "is of a format of one volume: omit --frame"),
            (self.series.is_some(), series, "is no DICOM series: omit --series"),
        ] {
            if given && !fits {
                return Err(format_error(path, what));
            }
        }
        Ok(())
    }
}

/// Reads a volume from a file: raw samples if a layout is given, else by what the file begins with,
/// and where that says nothing by its extension.
///
/// INRIMAGE and NIfTI (also gzipped), NRRD, MetaImage, legacy VTK, VTI, TIFF, NPY and NPZ are read,
/// and folders of PNG, JPEG or TIFF slices in natural order; with the feature `dicom` DICOM series (a
/// folder, or one file of it), with the feature `zarr` Zarr arrays and OME-Zarr pyramids. Spacing, origin and directions are those
/// of the file, in the space it means; where it says none, spacing is 1 and the origin 0.
///
/// A header's claim is compared with the length of the file before memory is allocated. Samples of
/// unsigned 8 bits are marked as gray levels. One pass; memory for the samples and a few MB.
///
/// # Errors
/// The file cannot be read, is of no format known, is truncated, longer than it claims or
/// otherwise not what it says, has an empty axis or too many samples, or holds a NaN or infinity.
/// Every message names the file.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Volume, VolumeError> {
    let volume = match &options.raw {
        Some(layout) => raw::read(path, layout),
        None if path.is_dir() => folder::read(path, options),
        None => read_file(path, options),
    };
    let volume = volume.and_then(|volume| options.part(volume.settled(options.nan)?));
    volume.map_err(|error| match error {
        VolumeError::Io { .. } | VolumeError::Format { .. } | VolumeError::InFile { .. } => error,
        other => VolumeError::InFile { path: path.into(), source: Box::new(other) },
    })
}

fn read_file(path: &Path, options: &ReadOptions) -> Result<Volume, VolumeError> {
    let start = start_of(path)?;
    let length = std::fs::metadata(path).map_err(io_error(path))?.len();
    if start.is_empty() {
        return Err(format_error(path, "is empty: there is no volume in it; write it again"));
    }
    let open = || File::open(path).map(BufReader::new).map_err(io_error(path));
    let kind = detect::kind(path, &start)?;
    options.fit(path, kind)?;
    let frame = options.frame;
    match kind {
        Kind::Npy => npy::read(path, frame),
        Kind::Npz => npz::read(path, options.array.as_deref()),
        Kind::Inrimage => inr::read(path, open()?, Length::Exactly(length)),
        Kind::InrimageGzip => {
            inr::read(path, MultiGzDecoder::new(open()?), Length::of_gzip(length))
        }
        Kind::Nifti => nifti::read(path, open()?, Length::Exactly(length), frame),
        Kind::NiftiGzip => {
            let length = Length::of_gzip(length);
            nifti::read(path, MultiGzDecoder::new(open()?), length, frame)
        }
        Kind::Nrrd => nrrd::read(path, frame),
        Kind::MetaImage => metaimage::read(path, frame),
        Kind::VtkLegacy => vtk::read(path, options.array.as_deref()),
        Kind::VtkXml => vti::read(path, options.array.as_deref()),
        Kind::Tiff => tiff::read(path),
        #[cfg(feature = "dicom")]
        Kind::Dicom => dicom::read_series_of(path, options.series.as_deref()),
    }
}

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

/// The series in a folder; none where it holds no DICOM files.
///
/// # Errors
/// The folder or a file in it cannot be read.
pub fn series(folder: &Path) -> Result<Vec<Series>, VolumeError> {
    #[cfg(feature = "dicom")]
    return dicom::series(&folder::dicom_files(folder, true)?);
    #[cfg(not(feature = "dicom"))]
    {
        let _ = folder;
        Ok(Vec::new())
    }
}

/// What a file is, as `NRRD` or `NIfTI, gzip`.
///
/// # Errors
/// The file cannot be read or is of no format known.
pub fn format_name(path: &Path, options: &ReadOptions) -> Result<&'static str, VolumeError> {
    if options.raw.is_some() {
        return Ok("raw samples");
    }
    if path.is_dir() {
        return folder::format_name(path);
    }
    Ok(detect::kind(path, &start_of(path)?)?.name())
}

/// The bytes that tell the format of a file.
fn start_of(path: &Path) -> Result<Vec<u8>, VolumeError> {
    let mut start = Vec::new();
    let file = File::open(path).map_err(io_error(path))?;
    file.take(detect::BYTES).read_to_end(&mut start).map_err(io_error(path))?;
    Ok(start)
}

/// The files that hold the samples of a volume, where its header is a file of its own (NRRD,
/// MetaImage, NIfTI); else none. A header may name any file, not only those of its folder.
///
/// # Errors
/// The header cannot be read.
pub fn data_files(path: &Path, options: &ReadOptions) -> Result<Vec<PathBuf>, VolumeError> {
    if options.raw.is_some() || !path.is_file() {
        return Ok(Vec::new());
    }
    let start = start_of(path)?;
    match detect::kind(path, &start)? {
        Kind::Nrrd => nrrd::data_files(path),
        Kind::MetaImage => metaimage::data_files(path),
        Kind::Nifti => nifti::data_files(path, &start),
        _ => Ok(Vec::new()),
    }
}

/// A [`VolumeError::Format`] for this file.
fn format_error(path: &Path, what: impl Into<String>) -> VolumeError {
    VolumeError::Format { path: path.into(), what: what.into() }
}

/// An [`VolumeError::Io`] for this file.
pub(crate) fn io_error(path: &Path) -> impl Fn(io::Error) -> VolumeError {
    move |source| VolumeError::Io { path: path.into(), source }
}

/// The error for a file whose header claims a volume that is not there.
fn payload_error(path: &Path, dims: &Dims, dtype: Dtype) -> impl Fn(PayloadError) -> VolumeError {
    let claim = format!("a volume of {dims} samples of type {dtype}");
    move |error| payload_error_of(path, &claim, error)
}

/// The error for a file whose header claims something that is not there.
fn payload_error_of(path: &Path, claim: &str, error: PayloadError) -> VolumeError {
    let what = match error {
        PayloadError::Io(source) if source.kind() == io::ErrorKind::UnexpectedEof => {
            format!(
                "its compressed data (gzip, zlib or bzip2) end early, inside {claim}: it is truncated; copy it again"
            )
        }
        PayloadError::Io(source)
            if matches!(
                source.kind(),
                io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData
            ) =>
        {
            format!(
                "its encoded data (gzip, zlib, bzip2, LZ4 or base64) are damaged ({source}): copy it again"
            )
        }
        PayloadError::Io(source) => return VolumeError::Io { path: path.into(), source },
        PayloadError::Memory { needed } => {
            format!("{claim} needs {needed} bytes of memory, which cannot be had: crop it first")
        }
        PayloadError::Length { needed, found, bound } => {
            let state = if found < needed { "truncated" } else { "too long" };
            format!(
                "its header claims {claim}, {needed} bytes, but {bound}{found} follow it: the file \
                 is {state} or mislabelled"
            )
        }
    };
    VolumeError::Format { path: path.into(), what }
}
