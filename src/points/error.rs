use std::path::PathBuf;

use super::Weighting;
use crate::memory::NoMemory;
use crate::shown::shown;
use crate::triangulation::TriangulationError;
use crate::volume::VolumeError;

/// Why there are no points, or no weights for them.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PointsError {
    /// A number of the selection is out of its range.
    #[error("{what} {given} makes no sense: it must be {need}")]
    Number {
        /// The option.
        what: &'static str,
        /// What was given.
        given: f64,
        /// What would do.
        need: &'static str,
    },
    /// More voxels asked for than there are, or none.
    #[error(
        "{asked} points cannot be selected: give a count from 1 to {available}, the voxels that \
         take part"
    )]
    Count {
        /// Points asked for.
        asked: u64,
        /// Voxels that take part.
        available: u64,
    },
    /// The mask leaves no voxel.
    #[error(
        "no voxel reaches --gray-min {least}: after truncation gray levels end at {highest}; give less"
    )]
    Masked {
        /// The least gray level asked for.
        least: f64,
        /// The highest there is.
        highest: f64,
    },
    /// The threshold or the mask leaves no voxel.
    #[error(
        "none of {voxels} voxels is selected: lower --threshold or --gray-min, or give --ratio"
    )]
    Empty {
        /// Voxels of the volume.
        voxels: u64,
    },
    /// Weights in proportion to an infinite α.
    #[error(
        "{weighting} weights are proportional to α, which is {alpha}: give a finite α, or the one \
         to freeze weights at (--alpha-ref)"
    )]
    UnboundedAlpha {
        /// The weights asked for.
        weighting: Weighting,
        /// The α given.
        alpha: f64,
    },
    /// Points without differences.
    #[error(
        "{weighting} weights need the differences of a volume's voxels, or of the values of scattered \
         points, which these come without: add a column `value`, or use column or common=C"
    )]
    NoDifferences {
        /// The weights asked for.
        weighting: Weighting,
    },
    /// Scattered points without values have no differences.
    #[error("differences of scattered points need a column `value` in the input: add it")]
    NoValues,
    /// Scattered points whose neighbours cannot be found.
    #[error("the neighbours of the points cannot be found: {0}")]
    Neighbours(#[from] TriangulationError),
    /// The input has no weights.
    #[error("column weights need a column `weight` in the input: add it, or use common=C")]
    NoColumn,
    /// A weight that is no finite number.
    #[error("the weight of point {index} is {weight}: it must be finite; correct the input")]
    Weight {
        /// The point, counted from 0.
        index: usize,
        /// Its weight.
        weight: f64,
    },
    /// A point file is not what it should be.
    #[error("{}: {what}", shown(path))]
    Format {
        /// The file.
        path: PathBuf,
        /// What is wrong, and what to do next.
        what: String,
    },
    /// Memory for the samples cannot be had.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] VolumeError),
}
