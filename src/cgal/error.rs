//! Errors of the functions that call CGAL.

use walpha_base::advice::{Advice, Advise};
use walpha_base::shown::number;
use walpha_regular::SitesError;
use walpha_shape::CgalError;

/// An error of a function of [`cgal`](crate::cgal).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// CGAL cannot triangulate the points: they are refused before the call, or CGAL finds that they span no volume.
    #[error(transparent)]
    Sites(#[from] SitesError),
    /// CGAL failed, or there is not enough memory.
    #[error(transparent)]
    Cgal(#[from] CgalError),
    /// The side of a periodic cube is not a positive number of usual size.
    #[error(
        "a periodic cube has side {}: it must be a number between {low:e} and {high:e}",
        number(*side)
    )]
    Side {
        /// The side.
        side: f64,
        /// The shortest side accepted.
        low: f64,
        /// The longest side accepted.
        high: f64,
    },
    /// A point is not in the periodic cube.
    #[error(
        "point {index} has {axis} {}: it must be at least 0 and less than the side of the cube, {}",
        number(*value),
        number(*side)
    )]
    Outside {
        /// The index of the point.
        index: usize,
        /// x, y or z.
        axis: char,
        /// The coordinate.
        value: f64,
        /// The side.
        side: f64,
    },
    /// CGAL's periodic triangulations do not take this weight.
    #[error(
        "point {index} has weight {}: in a periodic cube it must be at least 0 and less than {}, 1/64 of the squared side",
        number(*weight),
        number(*limit)
    )]
    Weight {
        /// The index of the point.
        index: usize,
        /// Its weight.
        weight: f64,
        /// The exclusive limit of weights.
        limit: f64,
    },
}

impl Advise for Error {
    fn wrapped(&self) -> Option<&dyn Advise> {
        match self {
            Self::Sites(error) => Some(error),
            Self::Cgal(error) => Some(error),
            _ => None,
        }
    }

    fn advice(&self) -> Option<Advice> {
        Some(match self {
            Self::Sites(_) | Self::Cgal(_) => return self.wrapped()?.advice(),
            Self::Side { .. } => "rescale the points".into(),
            Self::Outside { .. } => "move the points by multiples of the side".into(),
            Self::Weight { .. } => {
                "add one number to all weights, or use walpha's own periodic shapes".into()
            }
        })
    }
}
