use std::num::NonZeroUsize;

use serde::{Deserialize, Serialize};
use walpha_base::setters;

use super::{Alpha, ShapeError, Torus, Whole};

/// Which program computes the shape; all give the same answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Engine {
    /// Native; in the crate `walpha`, CGAL for up to 20 000 points, and native beyond and for what only it can do:
    /// blocks, a limit on memory, periodic boxes, a build without CGAL.
    #[default]
    Auto,
    /// CGAL's `Regular_triangulation_3` and `Fixed_alpha_shape_3`, as in the paper, on one thread, in the crate
    /// `walpha`.
    Cgal,
    /// Our own triangulation and classes: no C++, on all cores, in bounded memory, and the fastest.
    Native,
}

/// What a point with weight ω is at parameter α.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Balls {
    /// A ball of squared radius α + ω: the usual reading (Edelsbrunner 1992; CGAL), the default.
    #[default]
    Power,
    /// A ball of radius α + ω, as a sentence of the paper's section 4.2 reads: the power weight
    /// (α + ω)² at parameter 0.
    Radius,
}

/// How to make a shape of weighted points.
///
/// ```
/// use walpha_shape::{Alpha, Engine, ShapeOptions};
///
/// let options = ShapeOptions::new(Alpha::from_squared(2.5)?).engine(Engine::Native).exterior(true);
/// # Ok::<(), walpha_shape::AlphaError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShapeOptions {
    /// The parameter α.
    pub alpha: Alpha,
    /// What α + ω means.
    pub balls: Balls,
    /// Which program computes it.
    pub engine: Engine,
    /// Whether the simplices outside the shape are wanted too: the whole triangulation, which
    /// takes one block.
    pub exterior: bool,
    /// Whether the points that heavier ones hide are wanted ([`AlphaShape::hidden`](super::AlphaShape::hidden)),
    /// which takes the whole triangulation, too.
    pub hidden: bool,
    /// How many blocks the points are cut into, at most one for each; by default, as few as keep the
    /// threads at work and the memory bounded. One block is the whole triangulation.
    pub blocks: Option<NonZeroUsize>,
    /// Bytes of memory that the plan for the blocks keeps to.
    pub memory: Option<u64>,
    /// Whether points in one plane, on one line, or fewer than four are an error. Otherwise their shape
    /// is the one in their plane or on their line, without cells.
    pub refuse_flat: bool,
    /// The box that repeats, if one does: the points are those of a torus, of which the shape is.
    pub periodic: Option<Torus>,
}

impl ShapeOptions {
    /// The shape at α, with power balls, by the default engine, without exterior simplices or hidden points.
    pub fn new(alpha: Alpha) -> Self {
        Self {
            alpha,
            balls: Balls::default(),
            engine: Engine::default(),
            exterior: false,
            hidden: false,
            blocks: None,
            memory: None,
            refuse_flat: false,
            periodic: None,
        }
    }

    setters! {
        alpha: Alpha,
        balls: Balls,
        engine: Engine,
        exterior: bool,
        hidden: bool,
        blocks: Option<NonZeroUsize>,
        memory: Option<u64>,
        refuse_flat: bool,
        periodic: Option<Torus>,
    }

    /// Whether they go together, which [`alpha_shape`](super::alpha_shape()) looks at first.
    ///
    /// # Errors
    /// [`ShapeError::Unbounded`] and [`ShapeError::Divided`]: blocks, or a bound on memory, for what
    /// takes the whole triangulation; [`ShapeError::Unrepeated`].
    pub fn check(&self) -> Result<(), ShapeError> {
        if self.periodic.is_some() && self.engine == Engine::Cgal {
            return Err(ShapeError::Unrepeated);
        }
        let listed = match self {
            Self { exterior: true, .. } => Some(Whole::Exterior),
            Self { hidden: true, .. } => Some(Whole::Hidden),
            _ => None,
        };
        if let Some(blocks) = self.blocks.map(NonZeroUsize::get)
            && let Some(by) = listed
            && blocks > 1
        {
            return Err(ShapeError::Divided { by, blocks });
        }
        let unbounded = |by| Err(ShapeError::Unbounded { by });
        match self.memory {
            Some(_) if self.engine == Engine::Cgal => unbounded(Whole::Cgal),
            Some(_) if power_alpha(self) == Alpha::INFINITE => unbounded(Whole::Hull),
            Some(_) => listed.map_or(Ok(()), unbounded),
            None => Ok(()),
        }
    }
}

/// The parameter at which the power weights are judged.
pub(super) fn power_alpha(options: &ShapeOptions) -> Alpha {
    match options.balls {
        Balls::Power => options.alpha,
        Balls::Radius => Alpha::ZERO,
    }
}
