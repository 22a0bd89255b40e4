use crate::triangulation::{SitesError, TriangulationError};

/// Why a shape in the plane cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlaneError {
    /// The points cannot be triangulated.
    #[error(transparent)]
    Triangulation(#[from] TriangulationError),
    /// Discs of infinite or no size cannot be drawn.
    #[error(
        "discs of squared radius α + ω need a finite α, got {given}: give a number; any α above the largest squared circumradius makes the convex hull"
    )]
    InfiniteAlpha {
        /// The α given.
        given: f64,
    },
}

impl From<SitesError> for PlaneError {
    fn from(error: SitesError) -> Self {
        Self::Triangulation(error.into())
    }
}
