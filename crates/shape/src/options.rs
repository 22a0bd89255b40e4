use std::fmt;
use std::num::NonZeroUsize;

use serde::{Deserialize, Serialize};
use walpha_base::setters;
use walpha_regular::internals::Sites;

use super::{Alpha, Complex, ShapeError, Torus, Whole};

/// An engine of another crate. From sites and α, a squared length, it computes the whole triangulation with the class of each
/// simplex at α, in canonical order, by input indices. It is not called for points in one plane or on one line.
#[derive(Clone, Copy)]
pub struct Classifier(pub fn(&Sites<'_>, f64) -> Result<Complex, ShapeError>);

/// Engines give the same answer, so options are equal regardless of the available engine.
impl PartialEq for Classifier {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl fmt::Debug for Classifier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Classifier").finish_non_exhaustive()
    }
}

/// The implementation that computes the shape; the result is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Engine {
    /// Native. A recipe takes CGAL for what the paper computes, up to 20 000 points selected from a volume.
    #[default]
    Auto,
    /// CGAL's `Regular_triangulation_3` and `Fixed_alpha_shape_3`, as in the paper, on one thread: the crate `walpha` has them.
    Cgal,
    /// Triangulation and classes in Rust: without C++, on all cores, in bounded memory, and the fastest.
    Native,
    /// Both, one after the other: the shape of the native engine, and an error if a simplex differs
    /// ([`Disagreement`](super::Disagreement)).
    Both,
}

impl Engine {
    /// Whether CGAL runs.
    pub fn asks_cgal(self) -> bool {
        matches!(self, Self::Cgal | Self::Both)
    }
}

/// The ball that a point of weight ω is at parameter α.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Balls {
    /// A ball of squared radius α + ω: the usual definition (Edelsbrunner 1992; CGAL), the default.
    #[default]
    Power,
    /// A ball of radius α + ω, following a sentence of the paper's section 4.2: the power weight (α + ω)² at parameter 0.
    Radius,
}

impl Balls {
    /// The α that belongs to the power weights.
    pub fn power_alpha(self, alpha: Alpha) -> Alpha {
        match self {
            Self::Power => alpha,
            Self::Radius => Alpha::ZERO,
        }
    }

    /// The radius of the ball of a point with weight ω: 0 if a power ball is empty.
    pub fn radius(self, alpha: Alpha, weight: f64) -> f64 {
        match self {
            Self::Power => (alpha.squared() + weight).max(0.0).sqrt(),
            Self::Radius => (alpha.squared() + weight).abs(),
        }
    }

    /// Power weights that replace these: (α + ω)² for [`Balls::Radius`], otherwise `None`.
    ///
    /// # Errors
    /// [`ShapeError::Radius`] for a negative or infinite radius, with the position of its weight.
    pub fn power_weights(
        self,
        weights: &[f64],
        alpha: Alpha,
    ) -> Result<Option<Vec<f64>>, ShapeError> {
        if self == Self::Power {
            return Ok(None);
        }
        let squared = |(index, weight): (usize, &f64)| {
            let radius = alpha.squared() + weight;
            // NaN compares false, so it is refused, too.
            if radius >= 0.0 && radius.is_finite() {
                Ok(radius * radius)
            } else {
                Err(ShapeError::Radius { index, radius })
            }
        };
        weights.iter().enumerate().map(squared).collect::<Result<_, _>>().map(Some)
    }
}

/// Options for the computation of the shape of weighted points.
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
    /// The meaning of α + ω.
    pub balls: Balls,
    /// The implementation that computes the shape.
    pub engine: Engine,
    /// Whether the simplices outside the shape are listed, too: the whole triangulation, which requires one block.
    pub exterior: bool,
    /// Whether hidden points are listed ([`AlphaShape::hidden`](super::AlphaShape::hidden)), which also requires the whole
    /// triangulation.
    pub hidden: bool,
    /// The number of blocks that the points are cut into, at most one per point; by default the smallest number that keeps all
    /// threads busy and respects the bound on memory. One block is the whole triangulation.
    pub blocks: Option<NonZeroUsize>,
    /// A bound on memory in bytes, for which the number of blocks is chosen.
    pub memory: Option<u64>,
    /// Whether points in one plane, on one line, or fewer than four are an error. Otherwise their shape
    /// is the one in their plane or on their line, without cells.
    pub refuse_flat: bool,
    /// The periodic box, if there is one: points and shape are those of a torus.
    pub periodic: Option<Torus>,
    /// The engine of another crate, which [`Engine::Cgal`] and [`Engine::Both`] ask for.
    pub classifier: Option<Classifier>,
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
            classifier: None,
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
        classifier: Option<Classifier>,
    }

    /// Checks that the options are compatible, as [`alpha_shape`](super::alpha_shape()) does first.
    ///
    /// # Errors
    /// [`ShapeError::Unbounded`] and [`ShapeError::Divided`]: blocks, or a bound on memory, for options that require the whole
    /// triangulation; [`ShapeError::Unrepeated`].
    pub fn check(&self) -> Result<(), ShapeError> {
        if self.periodic.is_some() && self.engine.asks_cgal() {
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
            Some(_) if self.engine.asks_cgal() => unbounded(Whole::Cgal),
            Some(_) if self.power_alpha() == Alpha::INFINITE => unbounded(Whole::Hull),
            Some(_) => listed.map_or(Ok(()), unbounded),
            None => Ok(()),
        }
    }

    /// The α that belongs to the power weights: 0 for [`Balls::Radius`].
    pub fn power_alpha(&self) -> Alpha {
        self.balls.power_alpha(self.alpha)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball may be a point, and no less.
    #[test]
    fn weights_of_radii_are_their_squares() {
        let alpha = Alpha::from_squared(1.0).unwrap();
        let squared = |weights: &[f64]| Balls::Radius.power_weights(weights, alpha);
        assert_eq!(squared(&[0.5, -1.0, 2.0]).unwrap(), Some(vec![2.25, 0.0, 9.0]));
        assert_eq!(Balls::Power.power_weights(&[-9.0], alpha), Ok(None));
        for (weight, radius) in [(-1.5, -0.5), (f64::INFINITY, f64::INFINITY)] {
            match squared(&[0.0, weight]) {
                Err(ShapeError::Radius { index: 1, radius: found }) => assert_eq!(found, radius),
                other => panic!("{other:?}"),
            }
        }
    }
}
