use walpha_base::Cancelled;
use walpha_base::advice::{Advice, Advise, Setting, advice, wrapped};
use walpha_base::memory::NoMemory;
use walpha_base::monitor::wraps;

use walpha_points::PointsError;
use walpha_points::haar::HaarError;
use walpha_shape::ShapeError;
use walpha_volume::VolumeError;

/// Why an interpolant, or points for one, cannot be computed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InterpolateError {
    /// The points of the shape have no values.
    #[error("the points carry no values to interpolate")]
    NoValues,
    /// A value that is not finite.
    #[error("the value of point {index} is {value}: it must be finite")]
    Value {
        /// The point, counted from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A volume some of whose samples are missing.
    #[error("adaptive selection interpolates between all samples, and some are missing")]
    Missing,
    /// Several samples where the grid has no room for them.
    #[error(
        "{samples} samples along {axis} from {low} to {high} are not a step apart: the grid must have a positive, finite extent there"
    )]
    Extent {
        /// x, y or z.
        axis: char,
        /// Samples asked for.
        samples: usize,
        /// The first position.
        low: f64,
        /// The last.
        high: f64,
    },
    /// Adaptive selection cannot give this many points.
    #[error(
        "{asked} points cannot be selected adaptively: it starts from the 8 corners of the volume"
    )]
    Count {
        /// Points asked for.
        asked: u64,
        /// Samples of the volume.
        available: u64,
    },
    /// A target that no error can reach.
    #[error("{what} of {target} gray levels makes no sense as a target")]
    Target {
        /// The kind of target.
        what: &'static str,
        /// The number.
        target: f64,
    },
    /// The normal equations of values that are fitted were not solved.
    #[error("after {steps} steps the values of the points are not fitted to 1e-6")]
    Fit {
        /// Steps of conjugate gradients.
        steps: usize,
    },
    /// The shape is one of a torus, and places are those of space.
    #[error(
        "a shape of a periodic box cannot be interpolated: it repeats, and the interpolant is one of space"
    )]
    Periodic,
    /// The points make no shape.
    #[error(transparent)]
    Shape(ShapeError),
    /// The volume yields no points.
    #[error(transparent)]
    Points(#[from] PointsError),
    /// The volume cannot be truncated.
    #[error(transparent)]
    Haar(HaarError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Not enough memory for the samples.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// The values make no volume: they pass the range of `f32`.
    #[error("after interpolation: {0}")]
    Volume(#[from] VolumeError),
}

wraps! { InterpolateError: Shape(ShapeError), Haar(HaarError) }

impl Advise for InterpolateError {
    wrapped!(Shape, Points, Haar, Cancelled, Memory, Volume);

    fn advice(&self) -> Option<Advice> {
        Some(match self {
            Self::NoValues => "add a column `value` to the input, or start from a volume".into(),
            Self::Missing => advice!["give ", Setting::Nan, " a value, or select by difference"],
            Self::Value { .. } => "correct the input".into(),
            Self::Extent { axis, .. } => format!("ask for 1 sample along {axis}").into(),
            Self::Count { available, .. } => {
                format!("give a count from 8 to {available}, its samples").into()
            }
            Self::Fit { .. } => "keep the samples' own values".into(),
            Self::Target { .. } => "give a number from 0 up".into(),
            Self::Periodic => "lay the shape out in space first (AlphaShape::unwrapped)".into(),
            _ => return self.wrapped()?.advice(),
        })
    }
}
