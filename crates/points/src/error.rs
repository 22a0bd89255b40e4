use std::path::PathBuf;

use walpha_base::advice::{Advice, Advise, Category, Setting, advice, wrapped};
use walpha_base::memory::{NoMemory, readable};
use walpha_base::shown::{number, rounded, shown};
use walpha_complex::Alpha;
use walpha_regular::TriangulationError;

use super::Weighting;
use walpha_shape::LengthsError;
use walpha_volume::{Reason, VolumeError};

/// An error of the computation of points or their weights.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PointsError {
    /// A number of the selection is out of its range.
    #[error("{what} {} is out of range", number(*given))]
    Number {
        /// The name of the number.
        what: &'static str,
        /// The number given.
        given: f64,
        /// The valid numbers.
        need: &'static str,
    },
    /// The length of a column differs from the number of points.
    #[error(transparent)]
    Lengths(#[from] LengthsError),
    /// More voxels are requested than take part and differ from a neighbour.
    #[error(
        "{asked} points cannot be selected: {available} samples take part and differ from a neighbour after \
         truncation"
    )]
    Count {
        /// The number of points requested.
        asked: u64,
        /// The number of voxels that take part and have a difference.
        available: u64,
        /// The number available as a share of all voxels, if a share was requested.
        ratio: Option<f64>,
    },
    /// No voxel that takes part differs from a neighbour, so the selection has no criterion.
    #[error(
        "nothing tells which samples to select: after truncation none of the {available} that take part differs \
         from a neighbour"
    )]
    Flat {
        /// The number of voxels that take part.
        available: u64,
        /// The setting that determines how much truncation drops.
        tolerance: Setting,
    },
    /// The values of a volume have not been converted to gray levels.
    #[error("the values of the volume, {low} to {high}, are not gray levels 0 to 255")]
    NotGray {
        /// The least value.
        low: f32,
        /// The largest value.
        high: f32,
    },
    /// The mask leaves no voxel.
    #[error(
        "no voxel reaches the gray level {}: after truncation gray levels end at {}",
        number(*least),
        rounded(*highest)
    )]
    Masked {
        /// The least gray level requested.
        least: f64,
        /// The highest gray level of the truncated volume.
        highest: f64,
    },
    /// The mask, given as a value of the file, leaves no voxel.
    #[error(
        "no voxel reaches the value {}: after truncation values end at {}",
        number(*least),
        rounded(*highest)
    )]
    MaskedValues {
        /// The least value requested.
        least: f64,
        /// The highest value of the truncated volume.
        highest: f64,
    },
    /// All voxels are missing.
    #[error("none of {voxels} voxels takes part: all samples are missing")]
    Empty {
        /// The number of voxels of the volume.
        voxels: u64,
    },
    /// The threshold leaves no voxel.
    #[error(
        "no voxel that takes part has a difference of {} gray levels{}",
        number(*least),
        at_most(*largest)
    )]
    Threshold {
        /// The least difference requested.
        least: f64,
        /// The largest difference, if it is known.
        largest: Option<f64>,
        /// The setting that excludes voxels, if one was given.
        mask: Option<Setting>,
    },
    /// Weights are to be proportional to an infinite α.
    #[error("{weighting} weights are proportional to α, which is {alpha}")]
    UnboundedAlpha {
        /// The weights requested.
        weighting: Weighting,
        /// The α given.
        alpha: Alpha,
    },
    /// The points have no differences.
    #[error(
        "{weighting} weights need the differences of a volume's voxels, or of the values of scattered \
         points, which these come without"
    )]
    NoDifferences {
        /// The weights requested.
        weighting: Weighting,
    },
    /// Scattered points have no values, and therefore no differences.
    #[error("differences of scattered points need a column `value` in the input")]
    NoValues,
    /// The neighbours of scattered points cannot be found.
    #[error("the neighbours of the points cannot be found: {0}")]
    Neighbours(#[from] TriangulationError),
    /// The input has no weights.
    #[error("column weights need a column `weight` or `radius` in the input")]
    NoColumn,
    /// A weight is not finite.
    #[error(
        "the weight of point {index} is {}: it must be finite",
        number(*weight)
    )]
    Weight {
        /// The number of the point, from 0.
        index: usize,
        /// Its weight.
        weight: f64,
    },
    /// A file of points is invalid or unsupported.
    #[error("{}: {reason}", shown(path))]
    Format {
        /// The file.
        path: PathBuf,
        /// The problem.
        reason: Reason,
    },
    /// The points of a file do not fit in memory.
    #[error("{} holds {points} points, which need {} of memory", shown(path), readable(*bytes))]
    Room {
        /// The file.
        path: PathBuf,
        /// The number of points, as far as they are known to be taken.
        points: u64,
        /// The number of bytes that they need.
        bytes: u64,
    },
    /// There is not enough memory for the samples.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] VolumeError),
}

impl Advise for PointsError {
    wrapped!(Lengths, Neighbours, Memory, File);

    fn category(&self) -> Category {
        match self {
            Self::Room { .. } => Category::Memory,
            _ => self.wrapped().map_or(Category::Input, Advise::category),
        }
    }

    fn advice(&self) -> Option<Advice> {
        Some(match self {
            Self::Number { need, .. } => format!("give {need}").into(),
            Self::Count { ratio: Some(ratio), .. } => {
                format!("give a ratio of at most {ratio}, or omit it to take all that differ")
                    .into()
            }
            Self::Count { available, .. } => format!("give a count from 1 to {available}").into(),
            Self::Flat { tolerance, .. } => advice![
                "give a volume with contrast, let the wavelet stage drop less (",
                *tolerance,
                "), or spread the values over the gray levels (",
                Setting::Gray,
                ")"
            ],
            Self::NotGray { .. } => "map them first, by Volume::into_gray".into(),
            Self::Masked { .. } => advice!["give less for ", Setting::GrayMin],
            Self::MaskedValues { .. } => advice!["give less for ", Setting::ValueMin],
            Self::Empty { .. } => "give a volume with samples".into(),
            Self::Threshold { mask: Some(mask), .. } => {
                advice!["lower ", Setting::Threshold, " or ", *mask]
            }
            Self::Threshold { .. } => advice!["lower ", Setting::Threshold],
            Self::UnboundedAlpha { .. } => {
                advice![
                    "give a finite α; where α varies, weights may be frozen at one (",
                    Setting::AlphaRef,
                    ")"
                ]
            }
            Self::NoDifferences { .. } => {
                "add a column `value`, or use column or common=C as weights".into()
            }
            Self::NoValues => "add it".into(),
            Self::NoColumn => "add it, or use common=C".into(),
            Self::Weight { .. } => "correct the input".into(),
            Self::Format { reason, .. } => reason.advice(),
            Self::Room { .. } => advice![
                "read a part of them (",
                Setting::Region,
                "), or one in each cube (",
                Setting::Thin,
                ")"
            ],
            _ => return self.wrapped()?.advice(),
        })
    }
}

/// The part of a message about the largest difference, if it is known.
fn at_most(largest: Option<f64>) -> String {
    largest.map_or_else(String::new, |largest| format!(": the largest is {}", number(largest)))
}
