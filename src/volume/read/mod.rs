//! Volumes from files: by what the file holds first, then by its extension.

mod base64;
mod described;
mod detached;
mod detect;
#[cfg(feature = "dicom")]
mod dicom;
mod folder;
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

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;

pub(crate) use inr::read as read_inr;
pub(crate) use lines::Lines;
pub(crate) use npy::{MAGIC as NPY_MAGIC, NpyFile};
use payload::PayloadError;
pub(crate) use payload::{Element, Length, MOST_EXPANSION};
pub use raw::RawLayout;
pub(crate) use vtk_xml::VtkXml;

use detect::Kind;

use super::{Dims, Dtype, Volume, VolumeError};

/// What a user says about a file beyond its name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// Reads the file as bare samples in this layout, whatever it looks like.
    pub raw: Option<RawLayout>,
    /// The level of a pyramid to read (OME-Zarr), 0 being the finest. Files without levels refuse it.
    pub level: Option<u32>,
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
        None if path.is_dir() => folder::read(path, options.level),
        None => read_file(path, options.level),
    };
    volume.map_err(|error| match error {
        VolumeError::Io { .. } | VolumeError::Format { .. } | VolumeError::InFile { .. } => error,
        other => VolumeError::InFile { path: path.into(), source: Box::new(other) },
    })
}

fn read_file(path: &Path, level: Option<u32>) -> Result<Volume, VolumeError> {
    let mut file = File::open(path).map_err(io_error(path))?;
    let length = file.metadata().map_err(io_error(path))?.len();
    let mut start = Vec::new();
    (&mut file).take(detect::BYTES).read_to_end(&mut start).map_err(io_error(path))?;
    if start.is_empty() {
        return Err(format_error(path, "is empty: there is no volume in it; write it again"));
    }
    if let Some(level) = level {
        let what = format!("is no pyramid and has no level {level}; leave --level away");
        return Err(format_error(path, what));
    }
    let open = || File::open(path).map(BufReader::new).map_err(io_error(path));
    match detect::kind(path, &start)? {
        Kind::Npy => npy::read(path),
        Kind::Npz => npz::read(path),
        Kind::Inrimage => inr::read(path, open()?, Length::Exactly(length)),
        Kind::InrimageGzip => {
            inr::read(path, MultiGzDecoder::new(open()?), Length::of_gzip(length))
        }
        Kind::Nifti => nifti::read(path, open()?, Length::Exactly(length)),
        Kind::NiftiGzip => nifti::read(path, MultiGzDecoder::new(open()?), Length::of_gzip(length)),
        Kind::Nrrd => nrrd::read(path),
        Kind::MetaImage => metaimage::read(path),
        Kind::VtkLegacy => vtk::read(path),
        Kind::VtkXml => vti::read(path),
        Kind::Tiff => tiff::read(path),
        #[cfg(feature = "dicom")]
        Kind::Dicom => dicom::read_series_of(path),
    }
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
    let mut start = Vec::new();
    let file = File::open(path).map_err(io_error(path))?;
    file.take(detect::BYTES).read_to_end(&mut start).map_err(io_error(path))?;
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
                "its compressed data (gzip or zlib) end early, inside {claim}: it is truncated; copy it again"
            )
        }
        PayloadError::Io(source)
            if matches!(
                source.kind(),
                io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData
            ) =>
        {
            format!("its encoded data (gzip, zlib or base64) are damaged ({source}): copy it again")
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
