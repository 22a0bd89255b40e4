use walpha_base::Cancelled;
use walpha_base::advice::{Advice, Advise, Setting, advice, wrapped};
use walpha_base::memory::NoMemory;
use walpha_base::shown::number;
use walpha_shape::ShapeError;

/// Why a union of balls cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BallsError {
    /// α is infinite, and so is the union.
    #[error("at α = ∞ the balls are the whole space: their union has no volume")]
    Infinite,
    /// The shape is not one of balls: it fills voxels.
    #[error("the shape is that of the voxels of a label: it has no balls")]
    Labels,
    /// The shape is that of a torus, cut open.
    #[error(
        "the shape is one of a periodic box, unwrapped into space: its copies of balls are not all of those that overlap"
    )]
    Unwrapped,
    /// The exterior simplices are needed, and not listed.
    #[error("{what} consist of exterior cells, and the shape does not list them")]
    NoExterior {
        /// What they are needed for.
        what: &'static str,
    },
    /// Pockets are open to the outside, and a torus has none.
    #[error("pockets are open to the outside, and a periodic box has no outside")]
    NoOutside,
    /// Discs are asked for, and the points span a volume.
    #[error("the points span a volume, and discs lie in one plane")]
    Solid,
    /// Discs are asked for, and the shape is that of a torus.
    #[error("discs lie in one plane, and a periodic box does not")]
    Periodic,
    /// The box is so small that the balls of its points cannot be told from their copies.
    #[error(
        "the periodic box is so small that balls, or simplices between them, meet copies of themselves: {what} are not measured there"
    )]
    SmallBox {
        /// What was asked for.
        what: &'static str,
    },
    /// Pores are asked for, and the box does not repeat along all three vectors.
    #[error("pores are of boxes that repeat along all three vectors, and this one does not")]
    Slab,
    /// A radius is negative or not a number, or doubles do not hold its square.
    #[error("ball {row} has a radius of {radius:e}")]
    Radius {
        /// The ball, by input index.
        row: usize,
        /// Its radius.
        radius: f64,
    },
    /// A probe is so large that doubles do not hold the squared radii of balls that are larger by it.
    #[error("a probe of radius {radius:e} is too large: doubles do not hold its square")]
    Probe {
        /// Its radius.
        radius: f64,
    },
    /// A surface is asked for, and the shape is that of a torus.
    #[error("the sides of a periodic box would cut the surface open")]
    Seam,
    /// A tolerance of a surface is out of range.
    #[error(
        "the tolerance {} is not from 0.000001 to 0.5",
        number(*tolerance)
    )]
    Tolerance {
        /// What was asked for.
        tolerance: f64,
    },
    /// The patch of a ball cannot be triangulated.
    #[error("the surface of ball {ball} has features as small as the rounding of its coordinates")]
    Unresolved {
        /// The ball, by input index.
        ball: u32,
    },
    /// A point without a ball has no radius that a probe could add to.
    #[error(
        "point {row} has a negative squared radius, {}, so no probe can roll over its ball",
        number(*squared)
    )]
    NoRadius {
        /// The point, by input index.
        row: usize,
        /// α + ω.
        squared: f64,
    },
    /// Other numbers of weights than of points.
    #[error("{weights} weights for {points} balls: each ball needs one")]
    Weights {
        /// Number of weights.
        weights: usize,
        /// Number of points.
        points: usize,
    },
    /// The shape of several copies of a small box cannot be had.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// Out of memory.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// Cancelled by the monitor.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Advise for BallsError {
    wrapped!(Memory, Cancelled, Shape);

    fn advice(&self) -> Option<Advice> {
        Some(match self {
            Self::Infinite => advice!["give a finite ", Setting::Alpha],
            Self::Labels => {
                "measure the solid of the label, or take the points of the volume as centres".into()
            }
            Self::Unwrapped => "measure the shape of the periodic box itself".into(),
            Self::NoOutside => "take its voids, or repeat the points without a periodic box".into(),
            Self::NoExterior { .. } => advice!["set ", Setting::Exterior],
            Self::Solid => "measure the balls in space".into(),
            Self::Periodic => "measure the balls of the box".into(),
            Self::Slab => "measure the voids of its balls".into(),
            Self::Radius { .. } => "give a length from 0 up, whose square a double holds".into(),
            Self::Probe { .. } => "give its radius in the unit of the points".into(),
            Self::Seam => "repeat the points without a periodic box".into(),
            Self::Tolerance { .. } => "give a part of the radius, such as 0.01".into(),
            Self::Unresolved { .. } => {
                "move or remove that ball by a little, or give coordinates nearer to 0".into()
            }
            Self::Weights { .. } => "give a weight for each ball, in the order of the input".into(),
            Self::NoRadius { .. } => {
                "take no probe, or give weights that are squares of radii".into()
            }
            Self::SmallBox { .. } => {
                "repeat the points along the vectors of the box, and give the box that holds them"
                    .into()
            }
            Self::Memory(_) | Self::Cancelled(_) | Self::Shape(_) => {
                return self.wrapped()?.advice();
            }
        })
    }
}
