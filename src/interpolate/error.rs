use crate::haar::HaarError;
use crate::memory::NoMemory;
use crate::points::PointsError;
use crate::shape::ShapeError;
use crate::volume::VolumeError;

/// Why an interpolant, or points for one, cannot be had.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InterpolateError {
    /// The points of the shape have no values.
    #[error(
        "the points carry no values to interpolate: add a column `value` to the input, or start \
         from a volume"
    )]
    NoValues,
    /// A value that is not finite.
    #[error("the value of point {index} is {value}: it must be finite; correct the input")]
    Value {
        /// The point, counted from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A volume some of whose samples are missing.
    #[error(
        "adaptive selection interpolates between all samples, and some are missing: give --nan a value, \
         or select by difference"
    )]
    Missing,
    /// Adaptive selection cannot give this many points.
    #[error(
        "{asked} points cannot be selected adaptively: it starts from the 8 corners of the volume, \
         so give a count from 8 to {available}, its samples"
    )]
    Count {
        /// Points asked for.
        asked: u64,
        /// Samples of the volume.
        available: u64,
    },
    /// A target that no error can reach.
    #[error("an RMSE of {0} gray levels makes no sense as a target: give a number from 0 up")]
    Target(f64),
    /// The points make no shape.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// The volume yields no points.
    #[error(transparent)]
    Points(#[from] PointsError),
    /// The volume cannot be truncated.
    #[error(transparent)]
    Haar(#[from] HaarError),
    /// Memory for the samples cannot be had.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// The values make no volume: they pass the range of `f32`.
    #[error("after interpolation: {0}")]
    Volume(#[from] VolumeError),
}
