use std::path::PathBuf;

use walpha_base::advice::{Advice, Advise, Setting, advice, wrapped};
use walpha_base::memory::NoMemory;
use walpha_base::shown::shown;
use walpha_complex::Alpha;
use walpha_regular::TriangulationError;

use super::Weighting;
use walpha_shape::LengthsError;
use walpha_volume::{Reason, VolumeError};

/// Why points or their weights cannot be computed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PointsError {
    /// A number of the selection is out of its range.
    #[error("{what} {given} makes no sense")]
    Number {
        /// Which number.
        what: &'static str,
        /// The number given.
        given: f64,
        /// What is valid instead.
        need: &'static str,
    },
    /// A column whose length differs from the number of points.
    #[error(transparent)]
    Lengths(#[from] LengthsError),
    /// More voxels asked for than take part and differ from a neighbour, or none.
    #[error(
        "{asked} points cannot be selected: {available} samples take part and differ from a neighbour after \
         truncation"
    )]
    Count {
        /// Points asked for.
        asked: u64,
        /// Voxels that take part and have a difference.
        available: u64,
        /// These as a share of all, if a share was asked for.
        ratio: Option<f64>,
    },
    /// No voxel that takes part differs from a neighbour: there is nothing to select by.
    #[error(
        "nothing tells which samples to select: after truncation none of the {available} that take part differs \
         from a neighbour"
    )]
    Flat {
        /// Voxels that take part.
        available: u64,
        /// The setting that says how much truncation drops.
        tolerance: Setting,
    },
    /// A volume whose values have not become gray levels.
    #[error("the values of the volume, {low} to {high}, are not gray levels 0 to 255")]
    NotGray {
        /// The least value.
        low: f32,
        /// The largest value.
        high: f32,
    },
    /// The mask leaves no voxel.
    #[error(
        "no voxel reaches the gray level {least}: after truncation gray levels end at {highest}"
    )]
    Masked {
        /// The least gray level asked for.
        least: f64,
        /// The highest gray level of the truncated volume.
        highest: f64,
    },
    /// The mask, given as a value of the file, leaves no voxel.
    #[error("no voxel reaches the value {least}: after truncation values end at {highest}")]
    MaskedValues {
        /// The least value asked for.
        least: f64,
        /// The highest value of the truncated volume.
        highest: f64,
    },
    /// All voxels are missing.
    #[error("none of {voxels} voxels takes part: all samples are missing")]
    Empty {
        /// Voxels of the volume.
        voxels: u64,
    },
    /// The threshold leaves no voxel.
    #[error("no voxel that takes part has a difference of {least} gray levels{}", at_most(*largest))]
    Threshold {
        /// The least difference asked for.
        least: f64,
        /// The largest difference, if it is known.
        largest: Option<f64>,
        /// The setting that keeps voxels from taking part, if one was given.
        mask: Option<Setting>,
    },
    /// Weights in proportion to an infinite α.
    #[error("{weighting} weights are proportional to α, which is {alpha}")]
    UnboundedAlpha {
        /// The weights asked for.
        weighting: Weighting,
        /// The α given.
        alpha: Alpha,
    },
    /// Points without differences.
    #[error(
        "{weighting} weights need the differences of a volume's voxels, or of the values of scattered \
         points, which these come without"
    )]
    NoDifferences {
        /// The weights asked for.
        weighting: Weighting,
    },
    /// Scattered points without values have no differences.
    #[error("differences of scattered points need a column `value` in the input")]
    NoValues,
    /// The neighbours of scattered points cannot be found.
    #[error("the neighbours of the points cannot be found: {0}")]
    Neighbours(#[from] TriangulationError),
    /// The input has no weights.
    #[error("column weights need a column `weight` or `radius` in the input")]
    NoColumn,
    /// A weight that is not finite.
    #[error("the weight of point {index} is {weight}: it must be finite")]
    Weight {
        /// The point, counted from 0.
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
    /// Not enough memory for the samples.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] VolumeError),
}

impl Advise for PointsError {
    wrapped!(Lengths, Neighbours, Memory, File);

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
                    "give a finite α, or the one to freeze weights at (",
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
            _ => return self.wrapped()?.advice(),
        })
    }
}

/// The largest difference, where it is known.
fn at_most(largest: Option<f64>) -> String {
    largest.map_or_else(String::new, |largest| format!(": the largest is {largest}"))
}
