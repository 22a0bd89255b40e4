//! Errors of volumes.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use walpha_base::Cancelled;
use walpha_base::advice::{Advice, Advise, Category, Setting, advice, wrapped};
use walpha_base::memory::NoMemory;
use walpha_base::shown::{number, shown};

use crate::Reason;

/// An error of a volume or of the file it comes from.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VolumeError {
    /// An axis has no samples.
    #[error("a volume of {x}×{y}×{z} samples is empty: every axis needs at least one")]
    EmptyAxis {
        /// Samples along x.
        x: u64,
        /// Samples along y.
        y: u64,
        /// Samples along z.
        z: u64,
    },
    /// There are more samples than indices.
    #[error("{x}×{y}×{z} samples are too many: at most {} fit a 32-bit index", u32::MAX)]
    TooManySamples {
        /// Samples along x.
        x: u64,
        /// Samples along y.
        y: u64,
        /// Samples along z.
        z: u64,
    },
    /// A sample is NaN or infinite.
    #[error("sample (x, y, z) = {at:?} is {value}: every sample must be a finite number")]
    NotFinite {
        /// The offending value.
        value: f32,
        /// Its voxel (x, y, z).
        at: [usize; 3],
    },
    /// Samples that are not finite are left out, and there are no others.
    #[error("no sample is a finite number")]
    NoFinite,
    /// The gray range is empty, or its ends are so close or so far apart that gray levels overflow.
    #[error(
        "gray range {}..{} cannot be mapped to 0..255",
        number(*low),
        number(*high)
    )]
    GrayRange {
        /// The value meant to become 0.
        low: f64,
        /// The value meant to become 255.
        high: f64,
    },
    /// A region contains no samples, or reaches beyond the volume.
    #[error("the region {} is not part of a volume of {}×{}×{} samples", ranges(first, end), dims[0], dims[1], dims[2])]
    Region {
        /// The first index along each axis.
        first: [usize; 3],
        /// One past the last along each axis.
        end: [usize; 3],
        /// The number of samples of the volume along each axis.
        dims: [usize; 3],
    },
    /// Reading was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The operating system refused.
    #[error("cannot read {}: {source}", shown(path))]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// A folder of parts cannot be written.
    #[error("cannot write {}: {source}", shown(path))]
    Written {
        /// The folder.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// The file is not what its name or header says.
    #[error("{}: {reason}", shown(path))]
    Format {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: Reason,
    },
    /// The header or the samples of a file do not make a volume.
    #[error("{}: {source}", shown(path))]
    InFile {
        /// The file.
        path: PathBuf,
        /// What is wrong with them.
        source: Box<VolumeError>,
    },
    /// There is not enough memory for the samples.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// No sample has this name.
    #[error("{name:?} is not a sample; there are {known}")]
    UnknownSample {
        /// What was asked for.
        name: String,
        /// The samples that exist.
        known: String,
        /// What to do about it.
        advice: Advice,
    },
    /// The skull is not installed.
    #[error("sample:skull is not installed: looked for it {sought}")]
    NoSkull {
        /// Where it would be.
        sought: String,
    },
}

impl VolumeError {
    /// Why the file cannot be read, if this is such an error.
    pub fn reason(&self) -> Option<&Reason> {
        match self {
            Self::Format { reason, .. } => Some(reason),
            Self::InFile { source, .. } => source.reason(),
            _ => None,
        }
    }

    /// The error of a volume whose part from this sample (x, y, z) on has this error.
    pub(crate) fn moved(self, first: [usize; 3]) -> Self {
        match self {
            Self::NotFinite { value, at } => {
                Self::NotFinite { value, at: [0, 1, 2].map(|k| first[k] + at[k]) }
            }
            other => other,
        }
    }

    /// Whether the error is about a sample that is not finite.
    pub fn is_not_finite(&self) -> bool {
        match self {
            Self::NotFinite { .. } | Self::NoFinite => true,
            Self::InFile { source, .. } => source.is_not_finite(),
            _ => false,
        }
    }
}

/// The ranges of a region, unless it is [nowhere](crate::Region::NOWHERE).
fn ranges(first: &[usize; 3], end: &[usize; 3]) -> String {
    if *first == crate::Region::NOWHERE.first {
        return "of places".to_owned();
    }
    [0, 1, 2].map(|k| format!("{}:{}", first[k], end[k])).join(",")
}

impl Advise for VolumeError {
    wrapped!(Cancelled, Memory; Io { source }, Written { source }, InFile { source });

    fn advice(&self) -> Option<Advice> {
        Some(match self {
            Self::TooManySamples { .. } => "crop or downsample first".into(),
            Self::NotFinite { .. } => {
                advice![
                    "give ",
                    Setting::Nan,
                    " VALUE to replace NaN and infinities, or ",
                    Setting::Nan,
                    " alone to leave them out"
                ]
            }
            Self::NoFinite => advice![
                "give ",
                Setting::Nan,
                " VALUE to replace NaN and infinities, or name another file"
            ],
            Self::GrayRange { .. } => {
                "give LO..HI with LO < HI, both finite, of about the samples' size".into()
            }
            Self::Region { .. } => advice![
                "give indices from 0 on, each first one below its end, as in ",
                Setting::Region,
                " 20:40,20:40,10:30"
            ],
            Self::Io { path, source } => return advice_for_io(path, source.kind()),
            Self::Written { source, .. } if source.kind() == ErrorKind::AlreadyExists => {
                "remove it, or choose another name".into()
            }
            Self::Written { .. } => {
                "nothing was left behind, choose a place with room that you may write to".into()
            }
            Self::Format { reason, .. } => reason.advice(),
            Self::UnknownSample { advice, .. } => advice.clone(),
            Self::NoSkull { .. } => {
                "on Debian and Ubuntu `sudo apt-get install libcgal-demo` brings \
                                     it, elsewhere set CGAL_DATA_DIR to CGAL's data folder; \
                                     sample:phantom needs nothing"
                    .into()
            }
            _ => return self.wrapped()?.advice(),
        })
    }

    fn category(&self) -> Category {
        match self {
            // The file of a sample is not installed.
            Self::NoSkull { .. } => Category::System(ErrorKind::Other),
            _ => self.wrapped().map_or(Category::Input, Advise::category),
        }
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

/// What to do about an error of the system.
fn advice_for_io(path: &Path, kind: ErrorKind) -> Option<Advice> {
    Some(match kind {
        ErrorKind::NotFound => match path.to_str() {
            Some(name @ ("skull" | "phantom")) => format!("did you mean sample:{name}?").into(),
            _ => "check the path, or try sample:phantom".into(),
        },
        ErrorKind::PermissionDenied => "make it readable first".into(),
        ErrorKind::IsADirectory => "name a file in it".into(),
        _ => return None,
    })
}
