use walpha_base::Cancelled;
use walpha_base::advice::{Advice, Setting, advice};
use walpha_base::monitor::wraps;

use crate::haar::HaarError;
use crate::interpolate::InterpolateError;
use crate::points::PointsError;
use crate::shape::{AlphaError, ShapeError};

/// Why a pipeline gives no shape: what one of its stages refuses, or options that contradict each other.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PipelineError {
    /// The wavelet stage.
    #[error(transparent)]
    Haar(HaarError),
    /// Selection or weights.
    #[error(transparent)]
    Points(#[from] PointsError),
    /// Adaptive selection.
    #[error(transparent)]
    Interpolate(InterpolateError),
    /// The shape.
    #[error(transparent)]
    Shape(ShapeError),
    /// A voxel so large that 10 h² is not finite.
    #[error(transparent)]
    Alpha(#[from] AlphaError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// With [`Balls::Radius`](crate::shape::Balls) α is a radius, and the α that was found is a squared one.
    #[error("with balls of radius α + ω, α is a radius, and the one found is a squared one")]
    Radii {
        /// The radius of the α that was found.
        radius: f64,
    },
    /// A space of coordinates in voxels.
    #[error("a space is for world coordinates, and these are voxels")]
    SpaceOfVoxels,
    /// A space for a volume that does not say how it lies in one.
    #[error("the input does not say how its axes lie in a patient, so that no space can be chosen")]
    UnknownSpace,
    /// Weights of scattered points from differences to neighbours, on a torus.
    #[error(
        "these weights come from differences to neighbours, and those beyond the sides of a periodic box are not looked for"
    )]
    PeriodicWeights,
}

wraps! { PipelineError: Haar(HaarError), Interpolate(InterpolateError), Shape(ShapeError) }

impl PipelineError {
    /// What to do about it, where there is something.
    pub fn advice(&self) -> Option<Advice> {
        match self {
            Self::Haar(error) => error.advice(),
            Self::Points(error) => error.advice(),
            Self::Interpolate(error) => error.advice(),
            Self::Shape(error) => error.advice(),
            Self::Alpha(error) => Some(error.advice().into()),
            Self::Cancelled(_) => None,
            Self::SpaceOfVoxels | Self::UnknownSpace => Some(advice!["omit ", Setting::Space]),
            Self::PeriodicWeights => {
                Some(advice!["give weights as a column of the input, or omit ", Setting::Periodic])
            }
            Self::Radii { radius } => {
                Some(advice!["give a number, as in ", Setting::Alpha, format!(" {radius}")])
            }
        }
    }
}
