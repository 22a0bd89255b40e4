use walpha_base::Cancelled;
use walpha_base::advice::{Advice, Advise, Category, Setting, advice, wrapped};
use walpha_base::memory::{self, NoMemory};
use walpha_base::monitor::wraps;
use walpha_base::shown::number;
use walpha_regular::internals::{AXES, is_flat};
use walpha_regular::{MAX_COORDINATE, SitesError, TriangulationError};

use super::{Disagreement, IsosurfaceError, TorusError, VoxelsError};

/// Why a shape cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// The points cannot be triangulated.
    #[error(transparent)]
    Triangulation(TriangulationError),
    /// CGAL failed.
    #[error(transparent)]
    Cgal(#[from] CgalError),
    /// With [`Balls::Radius`](super::Balls::Radius), a ball has a negative or infinite radius.
    #[error(
        "point {index} would be a ball of radius α + ω = {}: where α + ω is a radius it must \
         be finite and not negative",
        number(*radius)
    )]
    Radius {
        /// Input index of the point.
        index: usize,
        /// Its α + ω.
        radius: f64,
    },
    /// The memory allowed is not enough for any number of blocks.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Out of memory for data about the simplices.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// A bound on memory requires cutting the points into blocks, but this shape requires the whole triangulation.
    #[error(
        "a bound on memory cannot be kept {}: that takes the whole triangulation at once",
        by.when()
    )]
    Unbounded {
        /// The option that requires the whole triangulation.
        by: Whole,
    },
    /// Two points at one position, in a set of points that is distributed over blocks.
    #[error("two points are at one position, {at:?}, which separate blocks cannot resolve")]
    Coincident {
        /// The position.
        at: [f64; 3],
    },
    /// There are several blocks, but an option requires the whole triangulation.
    #[error("a shape {} takes the whole triangulation, and {blocks} blocks were asked for", by.when())]
    Divided {
        /// The option that requires it.
        by: Whole,
        /// The given number of blocks.
        blocks: usize,
    },
    /// CGAL has no weighted alpha shapes of periodic boxes.
    #[error(
        "the engine cgal is CGAL's alpha shape of points in space, which does not support a periodic box"
    )]
    Unrepeated,
    /// An edge is so long that its ends do not determine which of their copies it joins. Within this crate alone: rows then name copies.
    #[doc(hidden)]
    #[error(
        "the edge between points {} and {} spans {} along {axis}, half of the periodic box ({}) or \
         more: its ends would not determine which of their copies it joins",
        edge[0],
        edge[1],
        number(*span),
        number(*side)
    )]
    Wraps {
        /// Input indices; equal for an edge from a point to its own copy.
        edge: [u32; 2],
        /// The axis along which it spans most of the box, or of a slanted box the vector, a, b or c.
        axis: char,
        /// The length that it spans, along that vector.
        span: f64,
        /// The side of the box along that axis, or the length of that vector.
        side: f64,
    },
    /// The points cannot lie in the periodic box.
    #[error(transparent)]
    Torus(#[from] TorusError),
    /// Power cells cannot end at these walls.
    #[error(transparent)]
    Walls(#[from] WallsError),
    /// The voxels have no solid.
    #[error(transparent)]
    Voxels(#[from] VoxelsError),
    /// There is no solid inside an isosurface.
    #[error(transparent)]
    Isosurface(#[from] IsosurfaceError),
    /// With [`Engine::Both`](super::Engine::Both), the engines differ.
    #[error(transparent)]
    Differ(#[from] Box<Disagreement>),
}

/// The memory allowed is not enough.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{} of memory is not enough: with {blocks} blocks, one at a time, about {} are needed",
    memory::readable(*asked),
    memory::readable(*needed)
)]
#[non_exhaustive]
pub struct PlanError {
    /// Bytes allowed.
    pub asked: u64,
    /// Bytes that the most economical plan needs.
    pub needed: u64,
    /// Its number of blocks.
    pub blocks: usize,
}

impl PlanError {
    /// Creates the error from the allowed bytes, and the bytes and the number of blocks of the most economical plan.
    pub fn new(asked: u64, needed: u64, blocks: usize) -> Self {
        Self { asked, needed, blocks }
    }
}

impl Advise for PlanError {
    fn advice(&self) -> Option<Advice> {
        Some("allow more, or select fewer points".into())
    }
}

/// An option that requires the whole triangulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Whole {
    /// The engine cgal.
    Cgal,
    /// The simplices outside the shape.
    Exterior,
    /// The hidden points.
    Hidden,
    /// α = ∞.
    Hull,
}

impl Whole {
    fn when(self) -> &'static str {
        match self {
            Self::Cgal => "by the engine cgal",
            Self::Exterior => "with the simplices outside the shape",
            Self::Hidden => "with its hidden points",
            Self::Hull => "at α = inf, the convex hull",
        }
    }
}

impl Advise for ShapeError {
    wrapped!(
        Triangulation,
        Cgal,
        Plan,
        Cancelled,
        Memory,
        Torus,
        Walls,
        Voxels,
        Isosurface,
        Differ
    );

    fn advice(&self) -> Option<Advice> {
        Some(match self {
            Self::Radius { .. } => advice!["raise α, or use ", Setting::Balls, " power"],
            Self::Unbounded { by: Whole::Exterior } => {
                advice!["omit ", Setting::Memory, ", or omit ", Setting::Exterior]
            }
            Self::Unbounded { by: Whole::Hidden } => {
                advice!["omit ", Setting::Memory, ", or omit ", Setting::Hidden]
            }
            Self::Unbounded { by: Whole::Hull } => {
                advice!["omit ", Setting::Memory, ", or give a finite ", Setting::Alpha]
            }
            Self::Unbounded { by: Whole::Cgal } => {
                advice!["omit ", Setting::Memory, ", or use ", Setting::Engine, " native"]
            }
            Self::Unrepeated => advice!["use ", Setting::Engine, " native"],
            Self::Wraps { axis, .. } => advice![
                "lower ",
                Setting::Alpha,
                format!(
                    ", or repeat the points along {axis}, and make the box as many times as long"
                )
            ],
            Self::Coincident { .. } => {
                "correct the spacing and directions of the grid, or use voxels as units".into()
            }
            Self::Divided { by: Whole::Hidden, .. } => {
                advice!["give ", Setting::Blocks, " 1, or omit ", Setting::Hidden]
            }
            Self::Divided { .. } => {
                advice!["give ", Setting::Blocks, " 1, or omit ", Setting::Exterior]
            }
            _ => return self.wrapped()?.advice(),
        })
    }
}

impl ShapeError {
    /// Whether the reason is that points span no volume, though there is at least one.
    pub fn is_flat(&self) -> bool {
        matches!(self, Self::Triangulation(error) if is_flat(error))
    }
}

wraps! { ShapeError: Triangulation(TriangulationError) }

impl From<SitesError> for ShapeError {
    fn from(error: SitesError) -> Self {
        Self::Triangulation(error.into())
    }
}

/// Why a shape has no outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum OutlineError {
    /// The points span a volume.
    #[error("the points span a volume, and only a shape in one plane has an outline")]
    Space,
    /// The points lie on one line, or at one place.
    #[error("the points lie on one line, where a shape has no area and so no outline")]
    Line,
    /// A coordinate that is not finite, or too large.
    #[error(
        "point {index} has a coordinate that is not a finite number of magnitude at most {MAX_COORDINATE:e}"
    )]
    Coordinate {
        /// Index of the point.
        index: usize,
    },
    /// The shape is that of a torus.
    #[error("a shape of a periodic box lies on a torus, not in a plane, so it has no outline")]
    Torus,
}

impl Advise for OutlineError {
    fn advice(&self) -> Option<Advice> {
        Some(match self {
            Self::Space => "take its boundary, a surface, or leave out a coordinate".into(),
            Self::Line => "take its edges and vertices".into(),
            Self::Coordinate { .. } => "clean or rescale the input".into(),
            Self::Torus => advice!["omit ", Setting::Periodic],
        })
    }
}

/// Why power cells cannot end at walls.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WallsError {
    /// The box repeats along all three vectors.
    #[error("the box repeats along all three vectors, which leaves no place for walls")]
    Everywhere,
    /// The vectors along which the box repeats are not perpendicular to the axes across which there would be walls.
    #[error(
        "walls are perpendicular to axes, and the vectors along which the box repeats are not parallel to such walls"
    )]
    Slanted,
    /// The lower wall is not below the upper one.
    #[error(
        "the walls across {} are at {} and {}, not at two numbers in ascending order",
        AXES[*axis],
        number(*low),
        number(*high)
    )]
    Order {
        /// The axis, 0 for x.
        axis: usize,
        /// The given place of the lower wall.
        low: f64,
        /// The given place of the upper wall.
        high: f64,
    },
    /// A point lies beyond a wall.
    #[error(
        "point {index} has {} = {}, and the walls are at {} and {}",
        AXES[*axis],
        number(*at),
        number(*low),
        number(*high)
    )]
    Beyond {
        /// Index of the point.
        index: usize,
        /// The axis, 0 for x.
        axis: usize,
        /// Its coordinate.
        at: f64,
        /// The place of the lower wall.
        low: f64,
        /// The place of the upper wall.
        high: f64,
    },
}

impl Advise for WallsError {
    fn advice(&self) -> Option<Advice> {
        Some(match self {
            Self::Everywhere => "omit the walls, or a vector of the box".into(),
            Self::Slanted => {
                "turn the points and vectors so that an axis is perpendicular to the vectors".into()
            }
            Self::Order { .. } => "give the lowest and the highest corner of the walls".into(),
            Self::Beyond { .. } => "leave the point out, or move the walls".into(),
        })
    }
}

/// Why CGAL failed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CgalError {
    /// C++ ran out of memory.
    #[error("no memory for the {stage}: C++ ran out of it")]
    Memory {
        /// The step of the computation.
        stage: &'static str,
    },
    /// CGAL threw. This is a fault of walpha or CGAL, not of the input.
    #[error("CGAL failed in the {stage} stage: {text}")]
    Thrown {
        /// The step of the computation.
        stage: &'static str,
        /// The message of the exception.
        text: String,
    },
    /// No engine of another crate was given ([`ShapeOptions::classifier`](crate::ShapeOptions::classifier)).
    #[error("there is no engine cgal: this program was built without it, or does not hand it over")]
    Absent,
}

impl Advise for CgalError {
    fn advice(&self) -> Option<Advice> {
        let advice = match self {
            Self::Memory { .. } => "allow more, use the native engine, or select fewer points",
            Self::Thrown { .. } => "please report this with the input",
            Self::Absent => {
                "use the native engine, which gives the same, or build walpha with the feature `cgal`"
            }
        };
        Some(advice.into())
    }

    fn category(&self) -> Category {
        match self {
            Self::Memory { .. } => Category::Memory,
            Self::Thrown { .. } => Category::Program,
            Self::Absent => Category::Input,
        }
    }
}
