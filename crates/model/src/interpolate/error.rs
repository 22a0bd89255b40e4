use walpha_base::Cancelled;
use walpha_base::advice::{Advice, Advise, Setting, advice, wrapped};
use walpha_base::memory::NoMemory;
use walpha_base::monitor::wraps;
use walpha_base::shown::number;
use walpha_points::PointsError;
use walpha_points::haar::HaarError;
use walpha_shape::ShapeError;
use walpha_volume::VolumeError;

/// An error of the computation of an interpolant, or of points for one.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InterpolateError {
    /// The points of the shape have no values.
    #[error("the points carry no values to interpolate")]
    NoValues,
    /// A value is not finite.
    #[error(
        "the value of point {index} is {}: it must be finite",
        number(*value)
    )]
    Value {
        /// The number of the point, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Some samples of a volume are missing.
    #[error("adaptive selection interpolates between all samples, and some are missing")]
    Missing,
    /// There are several samples along an axis in which the grid has no room for them.
    #[error(
        "{samples} samples along {axis} from {} to {} are not a step apart: the grid must have a positive, finite extent there",
        number(*low),
        number(*high)
    )]
    Extent {
        /// x, y or z.
        axis: char,
        /// The number of samples requested.
        samples: usize,
        /// The position of the first sample.
        low: f64,
        /// The position of the last sample.
        high: f64,
    },
    /// Adaptive selection cannot give this many points.
    #[error(
        "{asked} points cannot be selected adaptively: it starts from the corners of the volume, and takes 8 points at least"
    )]
    Count {
        /// The number of points requested.
        asked: u64,
        /// The number of samples of the volume.
        available: u64,
    },
    /// The samples of the volume lie in a plane or on a line, and adaptive selection begins with tetrahedra.
    #[error(
        "adaptive selection divides tetrahedra, of which {}×{}×{} samples have none",
        dims[0],
        dims[1],
        dims[2]
    )]
    Thin {
        /// The number of samples along x, y and z.
        dims: [usize; 3],
    },
    /// A goal is not a valid error.
    #[error("{what} of {} gray levels is not a valid target", number(*target))]
    Target {
        /// The kind of target.
        what: &'static str,
        /// The number.
        target: f64,
    },
    /// The normal equations of the fitted values were not solved.
    #[error("after {steps} steps the values of the points are not fitted to 1e-6")]
    Fit {
        /// The number of steps of conjugate gradients.
        steps: usize,
    },
    /// The shape is on a torus, but interpolants are defined in space.
    #[error(
        "a shape of a periodic box cannot be interpolated: it repeats, and the interpolant is one of space"
    )]
    Periodic,
    /// The points do not make a shape.
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
    /// There is not enough memory for the samples.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// The values do not make a volume, as they exceed the range of `f32`.
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
            Self::Thin { .. } => "select by difference".into(),
            Self::Target { .. } => "give a number from 0 up".into(),
            Self::Volume(error) if error.is_not_finite() => {
                "scale the values: samples of a volume are of single precision, up to 3.4e38".into()
            }
            Self::Periodic => "lay the shape out in space first (AlphaShape::unwrapped)".into(),
            _ => return self.wrapped()?.advice(),
        })
    }
}
