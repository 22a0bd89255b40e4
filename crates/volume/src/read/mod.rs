//! The readers of each format.

#[cfg(feature = "formats")]
mod base64;
#[cfg(feature = "formats")]
mod described;
#[cfg(feature = "formats")]
mod detached;
#[cfg(feature = "dicom")]
pub(super) mod dicom;
mod frames;
pub(super) mod inr;
#[cfg(feature = "formats")]
mod lines;
#[cfg(feature = "formats")]
pub(super) mod metaimage;
#[cfg(feature = "formats")]
pub(super) mod mgh;
#[cfg(feature = "formats")]
pub(super) mod nifti;
pub(super) mod npy;
#[cfg(feature = "formats")]
pub(super) mod npz;
#[cfg(feature = "formats")]
pub(super) mod nrrd;
mod open_file;
mod payload;
pub(super) mod raw;
pub(super) mod series;
#[cfg(feature = "formats")]
pub(super) mod slices;
#[cfg(feature = "formats")]
mod text;
#[cfg(feature = "formats")]
pub(super) mod tiff;
mod uncompressed;
#[cfg(feature = "formats")]
pub(super) mod vti;
#[cfg(feature = "formats")]
pub(super) mod vtk;
#[cfg(feature = "formats")]
mod vtk_xml;
#[cfg(feature = "zarr")]
pub(super) mod zarr;

use std::io;
use std::num::NonZeroUsize;
use std::path::Path;

use serde::{Deserialize, Serialize};

#[cfg(feature = "formats")]
pub(crate) use detached::naming;
#[cfg(feature = "formats")]
pub use lines::Lines;
pub use npy::NpyFile;
pub use open_file::OpenFile;
#[cfg(feature = "formats")]
pub use payload::Element;
pub(crate) use payload::Length;
use payload::PayloadError;
pub use raw::RawLayout;
pub use series::Series;
pub(super) use uncompressed::CONVERT;
#[cfg(feature = "formats")]
pub use vtk::VtkPoints;
#[cfg(feature = "formats")]
pub use vtk_xml::VtkXml;

use walpha_base::Cancelled;
use walpha_base::setters;

use super::{Dims, Dtype, Nan, Reason, Region, Volume, VolumeError, downsample};

/// What a user says about a file beyond its name.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ReadOptions {
    /// Reads the file as bare samples in this layout, whatever it looks like.
    pub raw: Option<RawLayout>,
    /// The extension of the format that the file is of, whatever its own; content still says more.
    pub format: Option<String>,
    /// The level of a pyramid to read (OME-Zarr), 0 being the finest. Files without levels refuse it.
    pub level: Option<u32>,
    /// The array to read, by its name, of a file that may hold several (VTK, NPZ).
    pub array: Option<String>,
    /// The volume to read of a file of several (a fourth axis), from 0.
    pub frame: Option<u64>,
    /// The series to read of a folder of several (DICOM): its number, from 1, or the end of its UID, if
    /// that is not a number.
    pub series: Option<String>,
    /// Goes on without damaged slices of a series (DICOM), which a warning names; without it they are refused.
    pub skip_damaged: bool,
    /// What becomes of samples that are NaN or infinite; without a word they are refused.
    pub nan: Option<Nan>,
    /// The part to take.
    pub region: Option<Region>,
    /// How many samples along each axis become one; `None` leaves them as they are.
    pub downsample: Option<NonZeroUsize>,
}

impl ReadOptions {
    setters! {
        raw: Option<RawLayout>,
        format: Option<String>,
        level: Option<u32>,
        array: Option<String>,
        frame: Option<u64>,
        series: Option<String>,
        skip_damaged: bool,
        nan: Option<Nan>,
        region: Option<Region>,
        downsample: Option<NonZeroUsize>,
    }

    /// The part of a volume that is asked for.
    ///
    /// # Errors
    /// [`VolumeError`]: what cannot be read, and why.
    pub fn part(&self, volume: Volume) -> Result<Volume, VolumeError> {
        let volume = match &self.region {
            Some(region) => region.of(&volume)?,
            None => volume,
        };
        Ok(match self.downsample {
            Some(n) => downsample(volume, n),
            None => volume,
        })
    }
}

/// A [`VolumeError::Format`] for this file.
pub(crate) fn format_error(path: &Path, reason: Reason) -> VolumeError {
    VolumeError::Format { path: path.into(), reason }
}

/// An [`VolumeError::Io`] for this file.
pub fn io_error(path: &Path) -> impl Fn(io::Error) -> VolumeError {
    move |source| VolumeError::Io { path: path.into(), source }
}

/// The error for a file whose header claims a volume that is not there.
fn payload_error(path: &Path, dims: &Dims, dtype: Dtype) -> impl Fn(PayloadError) -> VolumeError {
    let claim = format!("a volume of {dims} samples of type {dtype}");
    move |error| payload_error_of(path, &claim, error)
}

/// The error for a file whose header claims something that is not there.
fn payload_error_of(path: &Path, claim: &str, error: PayloadError) -> VolumeError {
    let reason = match error {
        PayloadError::Io(source) if source.kind() == io::ErrorKind::UnexpectedEof => {
            Reason::truncated(format!(
                "its compressed data (gzip, zlib or bzip2) end early, inside {claim}: it is \
                     truncated"
            ))
        }
        PayloadError::Io(source)
            if matches!(
                source.kind(),
                io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData
            ) =>
        {
            Reason::damaged(format!(
                "its encoded data (gzip, zlib, bzip2, LZ4 or base64) are damaged ({source})"
            ))
        }
        PayloadError::Io(source) => return VolumeError::Io { path: path.into(), source },
        PayloadError::Cancelled => return Cancelled.into(),
        PayloadError::Memory { needed } => Reason::Memory { claim: claim.into(), needed },
        PayloadError::Length { needed, found, bound } => {
            Reason::Length { claim: claim.into(), needed, found, bound }
        }
    };
    format_error(path, reason)
}
