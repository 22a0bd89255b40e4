use walpha_base::Cancelled;
use walpha_base::advice::{Advice, Advise, Category, wrapped};
use walpha_base::shown::number;

use super::Triangulation;

/// A fault in a set of points.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SitesError {
    /// Different numbers of positions and weights.
    #[error("{positions} positions but {weights} weights: each point needs one weight")]
    Lengths {
        /// Positions given.
        positions: usize,
        /// Weights given.
        weights: usize,
    },
    /// More points than 32-bit indices can address.
    #[error("{0} points are too many: at most {max} fit a 32-bit index", max = u32::MAX)]
    TooMany(usize),
    /// NaN, infinity, or a magnitude above the limit.
    #[error(
        "point {index} has {what} {}: it must be a finite number of magnitude at most {limit:e}",
        number(*value)
    )]
    Value {
        /// Input index of the point.
        index: usize,
        /// The name of the number: x, y, z or weight.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The largest magnitude accepted.
        limit: f64,
    },
    /// No point.
    #[error("there is no point: at least 1 is needed")]
    Empty,
    /// Fewer than four distinct positions.
    #[error("{distinct} distinct points cannot span a tetrahedron: at least 4 are needed")]
    TooFew {
        /// Number of distinct positions.
        distinct: usize,
    },
    /// All points lie in one plane or on one line.
    #[error("all {points} points lie {on}: a 3D triangulation needs points that span a volume")]
    Flat {
        /// Number of distinct positions.
        points: usize,
        /// "in one plane" or "on one line".
        on: &'static str,
    },
}

impl SitesError {
    /// The error for points whose affine hull has a dimension below 3.
    #[doc(hidden)]
    pub fn flat(points: usize, dimension: i32) -> Self {
        Self::Flat { points, on: if dimension == 2 { "in one plane" } else { "on one line" } }
    }
}

/// Why points cannot be triangulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TriangulationError {
    /// The points cannot be triangulated.
    #[error(transparent)]
    Sites(#[from] SitesError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// More cells than [`Triangulation::MAX_CELLS`].
    #[error(
        "the triangulation has more than {} cells: that is more than its arrays can name",
        Triangulation::MAX_CELLS
    )]
    TooManyCells,
    /// Out of memory.
    #[error("no memory for the triangulation: {} MiB are needed at once", bytes >> 20)]
    Memory {
        /// The number of bytes that were requested.
        bytes: usize,
    },
}

impl Advise for SitesError {
    fn advice(&self) -> Option<Advice> {
        let advice = match self {
            Self::Lengths { .. } => return None,
            Self::TooMany(_) => "select fewer",
            Self::Value { .. } => "clean or rescale the input",
            Self::Empty => "select some",
            Self::TooFew { .. } => "select more points",
            Self::Flat { .. } => {
                "select points off this plane; points in one plane have an alpha shape, with α = ∞ their Delaunay triangles"
            }
        };
        Some(advice.into())
    }
}

impl Advise for TriangulationError {
    wrapped!(Sites, Cancelled);

    fn advice(&self) -> Option<Advice> {
        match self {
            Self::TooManyCells => Some("use more blocks, or select fewer points".into()),
            Self::Memory { .. } => {
                Some("allow more, use more blocks, or select fewer points".into())
            }
            Self::Sites(_) | Self::Cancelled(_) => self.wrapped()?.advice(),
        }
    }

    fn category(&self) -> Category {
        match self {
            Self::Memory { .. } => Category::Memory,
            _ => self.wrapped().map_or(Category::Input, Advise::category),
        }
    }
}
