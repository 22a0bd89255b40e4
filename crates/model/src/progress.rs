//! Progress and cancellation of long work: the [`Monitor`], and the stages reported to it.

pub use walpha_base::monitor::{Cancelled, Listener, Monitor};

/// A stage of a command or a [`Recipe`](crate::Recipe).
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
    /// Finds the components and voids of the shape, and measures them.
    Measure,
    /// Computes all shapes at once.
    Filtration,
    /// Counts the changes at each critical α.
    Curve,
    /// Sorts all simplices.
    Order,
    /// Pairs the simplices that begin and end components, loops and voids.
    Pairs,
    /// Extracts levels from a filtration.
    Ladder,
    /// Triangulates the whole volume.
    Fill,
    /// Samples the interpolant.
    Interpolate,
    /// Checks a complex.
    Certify,
    /// Builds a complex from its definition.
    Enumerate,
    /// Compares two complexes or filtrations.
    Compare,
    /// Makes the interactive page.
    Page,
    /// Writes its result.
    Write,
}

impl Stage {
    /// Reports that the stage begins, to the monitor that watches this call.
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn begin(self) -> Result<(), Cancelled> {
        Monitor::current().stage(self.name())
    }

    /// The name of the stage in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Haar => "haar",
            Self::Points => "points",
            Self::Alpha => "alpha",
            Self::Refit => "refit",
            Self::Shape => "shape",
            Self::Measure => "measure",
            Self::Filtration => "filtration",
            Self::Curve => "curve",
            Self::Order => "order",
            Self::Pairs => "pairs",
            Self::Ladder => "ladder",
            Self::Fill => "fill",
            Self::Interpolate => "interpolate",
            Self::Certify => "certify",
            Self::Enumerate => "enumerate",
            Self::Compare => "compare",
            Self::Page => "page",
            Self::Write => "write",
        }
    }
}
