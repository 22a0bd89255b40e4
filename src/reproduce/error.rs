use walpha_base::Cancelled;
use walpha_base::advice::{Advise, wrapped};
use walpha_base::monitor::wraps;

use super::OffError;
use super::plane::{NotACurvature, PlaneError};
use crate::haar::HaarError;
use crate::interpolate::InterpolateError;
use crate::points::PointsError;
use crate::render::RenderError;
use crate::shape::ShapeError;
use crate::volume::VolumeError;

/// Why the paper cannot be reproduced on a volume.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReproduceError {
    /// The file of the volume cannot be read again for its checksum.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// The wavelet stage failed.
    #[error(transparent)]
    Haar(HaarError),
    /// The volume yields no points.
    #[error(transparent)]
    Points(#[from] PointsError),
    /// The points have no shape.
    #[error(transparent)]
    Shape(ShapeError),
    /// The points in the plane have no shape.
    #[error(transparent)]
    Plane(#[from] PlaneError),
    /// A number given as α that is not a curvature.
    #[error(transparent)]
    Curvature(#[from] NotACurvature),
    /// The points have no interpolant.
    #[error(transparent)]
    Interpolate(InterpolateError),
    /// A picture cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A file just written does not read back.
    #[error("an OFF file does not read back: {0}")]
    Off(#[from] OffError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Not enough memory for a file.
    #[error("cannot write a file into memory: {0}")]
    Io(#[from] std::io::Error),
}

wraps! { ReproduceError: Haar(HaarError), Shape(ShapeError), Interpolate(InterpolateError) }

impl Advise for ReproduceError {
    wrapped!(
        Volume,
        Haar,
        Points,
        Shape,
        Plane,
        Curvature,
        Interpolate,
        Render,
        Off,
        Cancelled,
        Io
    );
}
