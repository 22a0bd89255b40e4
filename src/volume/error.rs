use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::{Dims, SAMPLES};
use crate::memory::NoMemory;
use crate::shown::shown;

/// What can be wrong with a volume or the file it comes from.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VolumeError {
    /// An axis without samples.
    #[error("a volume of {x}×{y}×{z} samples is empty: every axis needs at least one")]
    EmptyAxis {
        /// Samples along x.
        x: u64,
        /// Samples along y.
        y: u64,
        /// Samples along z.
        z: u64,
    },
    /// More samples than indices.
    #[error(
        "{x}×{y}×{z} samples are too many: at most {} fit a 32-bit index; crop or downsample first",
        Dims::MAX_SAMPLES
    )]
    TooManySamples {
        /// Samples along x.
        x: u64,
        /// Samples along y.
        y: u64,
        /// Samples along z.
        z: u64,
    },
    /// A NaN or an infinity among the samples.
    #[error(
        "sample (x, y, z) = {at:?} is {value}: every sample must be a finite number; give --nan VALUE to replace NaN, or --nan alone to leave it out"
    )]
    NotFinite {
        /// The offending value.
        value: f32,
        /// Its voxel, (x, y, z).
        at: [usize; 3],
    },
    /// An empty gray range, or one whose ends are so close or so far that gray levels overflow.
    #[error(
        "gray range {low}..{high} cannot be mapped to 0..255: give LO..HI with LO < HI, both finite, of about the samples' size"
    )]
    GrayRange {
        /// The value meant to become 0.
        low: f64,
        /// The value meant to become 255.
        high: f64,
    },
    /// A region without samples, or beyond the volume.
    #[error(
        "the region {}:{},{}:{},{}:{} is no part of a volume of {dims} samples: give indices from 0 on, \
         each first one below its end, as in --roi 20:40,20:40,10:30",
        first[0], end[0], first[1], end[1], first[2], end[2]
    )]
    Region {
        /// The first index of each axis.
        first: [usize; 3],
        /// One behind the last of each axis.
        end: [usize; 3],
        /// The volume.
        dims: Dims,
    },
    /// The operating system refused.
    #[error("cannot read {}: {source}{}", shown(path), next_step(path, source.kind()))]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is not what its name or header says.
    #[error("{}: {what}", shown(path))]
    Format {
        /// The file.
        path: PathBuf,
        /// What is wrong, and what to do next.
        what: String,
    },
    /// A file whose header or samples make no volume.
    #[error("{}: {source}", shown(path))]
    InFile {
        /// The file.
        path: PathBuf,
        /// What is wrong with them.
        source: Box<VolumeError>,
    },
    /// Memory for the samples cannot be had.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// The sample is not installed, or no sample has this name.
    #[error("{0}")]
    Sample(String),
}

/// What to do about an error of the system.
fn next_step(path: &Path, kind: ErrorKind) -> String {
    let sample = format!("sample:{}", path.display());
    match kind {
        ErrorKind::NotFound if SAMPLES.contains(&sample.as_str()) => {
            format!("; did you mean {sample}?")
        }
        ErrorKind::NotFound => "; check the path, or try sample:phantom".into(),
        ErrorKind::PermissionDenied => "; make it readable first".into(),
        ErrorKind::IsADirectory => "; name a file in it".into(),
        _ => String::new(),
    }
}
