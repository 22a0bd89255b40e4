//! Volumes from files: by what the file holds first, then by its extension.

mod inr;
mod npy;
mod payload;
mod raw;

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use flate2::read::MultiGzDecoder;

pub(crate) use inr::read as read_inr;
pub(crate) use npy::{MAGIC as NPY_MAGIC, NpyFile};
pub(crate) use payload::Length;
use payload::PayloadError;
pub use raw::RawLayout;

use super::{Dims, Dtype, Volume, VolumeError};

/// What a user says about a file beyond its name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// Reads the file as bare samples in this layout, whatever it looks like.
    pub raw: Option<RawLayout>,
}

/// Reads a volume from a file: raw samples if a layout is given, else INRIMAGE (also gzipped) or
/// NPY.
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
        None => read_known(path),
    };
    volume.map_err(|error| match error {
        VolumeError::Io { .. } | VolumeError::Format { .. } | VolumeError::InFile { .. } => error,
        other => VolumeError::InFile { path: path.into(), source: Box::new(other) },
    })
}

fn read_known(path: &Path) -> Result<Volume, VolumeError> {
    let mut file = File::open(path).map_err(io_error(path))?;
    let length = file.metadata().map_err(io_error(path))?.len();
    let mut start = Vec::new();
    (&mut file).take(inr::MAGIC.len() as u64).read_to_end(&mut start).map_err(io_error(path))?;
    file.seek(SeekFrom::Start(0)).map_err(io_error(path))?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    if start.is_empty() {
        let what = "is empty: there is no volume in it; write it again".into();
        Err(VolumeError::Format { path: path.into(), what })
    } else if start.starts_with(npy::MAGIC) || name.ends_with(".npy") {
        npy::read(path)
    } else if start.starts_with(inr::MAGIC) || name.ends_with(".inr") {
        inr::read(path, BufReader::new(file), Length::Exactly(length))
    } else if start.starts_with(&[0x1f, 0x8b]) {
        inr::read(path, MultiGzDecoder::new(BufReader::new(file)), Length::of_gzip(length))
    } else if name.ends_with(".gz") {
        let what = "is not compressed with gzip, whatever its name says: rename it".into();
        Err(VolumeError::Format { path: path.into(), what })
    } else {
        let what = "is of no format known by content: INRIMAGE (.inr, .inr.gz) and NPY (.npy) are \
                    read; for raw samples give --dims X,Y,Z and --dtype";
        Err(VolumeError::Format { path: path.into(), what: what.into() })
    }
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
            format!("its gzip stream ends early, inside {claim}: it is truncated; copy it again")
        }
        PayloadError::Io(source)
            if matches!(
                source.kind(),
                io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData
            ) =>
        {
            format!("its gzip stream is damaged ({source}): copy it again")
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
