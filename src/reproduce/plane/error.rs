use walpha_regular::SitesError;

use crate::CgalError;

/// Why a shape in the plane cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlaneError {
    /// The points are no sites.
    #[error(transparent)]
    Sites(#[from] SitesError),
    /// CGAL gave no answer.
    #[error(transparent)]
    Cgal(#[from] CgalError),
    /// Discs of infinite or no size cannot be drawn.
    #[error(
        "discs of squared radius α + ω need a finite α, got {given}: give a number; any α above the largest squared circumradius makes the convex hull"
    )]
    InfiniteAlpha {
        /// The α given.
        given: f64,
    },
}
