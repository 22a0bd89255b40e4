//! Progress of long work, for programs that show it.
//!
//! Loops that may take long say now and then how much is done, as `tracing` events of the target
//! [`TARGET`] with the fields `done` and `total` (both `u64`). Without a listener this costs a few
//! nanoseconds. The command shows a bar with the rate and the remaining time.

pub use walpha_base::progress::TARGET;

/// What a command or a [`Pipeline`](crate::Pipeline) does at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Stage {
    /// Reads its input.
    Read,
    /// Transforms, truncates and transforms back.
    Haar,
    /// Selects points and gives them weights.
    Points,
    /// Finds α.
    Alpha,
    /// Fits the values of points.
    Refit,
    /// Computes the shape.
    Shape,
    /// Computes all shapes at once.
    Filtration,
    /// Counts what each critical α changes.
    Curve,
    /// Puts all simplices in order.
    Order,
    /// Pairs the simplices that begin and end components and voids.
    Pairs,
    /// Takes levels from a filtration.
    Ladder,
    /// Triangulates the whole volume.
    Fill,
    /// Samples the interpolant.
    Interpolate,
    /// Judges a complex.
    Certify,
    /// Builds a complex from its definition.
    Enumerate,
    /// Makes the interactive page.
    Page,
    /// Writes its result.
    Write,
}

impl Stage {
    /// A word for it, as reports have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Haar => "haar",
            Self::Points => "points",
            Self::Alpha => "alpha",
            Self::Refit => "refit",
            Self::Shape => "shape",
            Self::Filtration => "filtration",
            Self::Curve => "curve",
            Self::Order => "order",
            Self::Pairs => "pairs",
            Self::Ladder => "ladder",
            Self::Fill => "fill",
            Self::Interpolate => "interpolate",
            Self::Certify => "certify",
            Self::Enumerate => "enumerate",
            Self::Page => "page",
            Self::Write => "write",
        }
    }
}
