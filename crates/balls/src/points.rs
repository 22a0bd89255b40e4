//! The balls of a shape: centres, weights and α, at a size where products stay in the range of doubles.

use std::borrow::Cow;

use walpha_base::vector::V3;
use walpha_regular::internals::Scaled;
use walpha_shape::{Alpha, AlphaShape, Torus, WeightedPoints};

use crate::BallsError;
use crate::real::{Bounded, Single};
use crate::simplex::Ball;

/// Balls whose radii are larger by that of a probe, and the α of their weights, 0. Without a probe nothing changes, and nothing is
/// rounded.
///
/// # Errors
/// A point without a ball: its squared radius α + ω is negative.
#[expect(clippy::missing_panics_doc, reason = "there is a weight for each point")]
pub fn with_probe(
    points: WeightedPoints,
    alpha: Alpha,
    probe: f64,
) -> Result<(WeightedPoints, Alpha), BallsError> {
    if probe == 0.0 {
        return Ok((points, alpha));
    }
    let (positions, mut weights, _) = points.into_parts();
    for (row, weight) in weights.iter_mut().enumerate() {
        let squared = alpha.squared() + *weight;
        if squared < 0.0 {
            return Err(BallsError::NoRadius { row, squared });
        }
        *weight = (squared.sqrt() + probe).powi(2);
    }
    let points = WeightedPoints::new(positions, weights).expect("a weight for each point");
    Ok((points, Alpha::ZERO))
}

/// The balls of a shape, by input index.
#[derive(Debug)]
pub(crate) struct Points<'a> {
    pub positions: Cow<'a, [V3]>,
    weights: Cow<'a, [f64]>,
    pub alpha: f64,
    torus: Option<Torus>,
    /// The unit of lengths: a power of two, in the unit of the shape.
    unit: f64,
}

impl<'a> Points<'a> {
    pub(crate) fn of(shape: &'a AlphaShape) -> Self {
        let (positions, weights) = (shape.points().positions(), shape.power_weights());
        let alpha = shape.power_alpha().squared();
        let torus = shape.nearest();
        let scaled = Scaled::of(positions, weights).filter(|_| torus.is_none());
        let scaled = scaled.and_then(|scaled| Some((scaled.square(alpha)?, scaled)));
        let Some((alpha, scaled)) = scaled else {
            let (positions, weights) = (positions.into(), weights.into());
            return Self { positions, weights, alpha, torus, unit: 1.0 };
        };
        let unit = 1.0 / scaled.factor();
        let Scaled { positions, weights, .. } = scaled;
        let (positions, weights) = (Cow::Owned(positions), Cow::Owned(weights));
        Self { positions, weights, alpha, torus, unit }
    }

    pub(crate) fn into_owned(self) -> Points<'static> {
        Points {
            positions: Cow::Owned(self.positions.into_owned()),
            weights: Cow::Owned(self.weights.into_owned()),
            ..self
        }
    }

    /// The same balls at another α, in the unit of the shape.
    pub(crate) fn at(&self, alpha: f64) -> Points<'_> {
        Points {
            positions: Cow::Borrowed(&self.positions),
            weights: Cow::Borrowed(&self.weights),
            alpha: alpha / self.unit / self.unit,
            ..*self
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.positions.len()
    }

    /// The balls of a simplex; on a torus the first in the box, and of each other the copy nearest to it.
    #[inline(always)]
    pub(crate) fn balls<const N: usize>(&self, simplex: [u32; N]) -> [Ball; N] {
        let first = self.positions[simplex[0] as usize];
        simplex.map(|v| self.near(first, v))
    }

    /// The copy of a ball that is nearest to a place in the box.
    #[inline(always)]
    pub(crate) fn near(&self, place: V3, v: u32) -> Ball {
        let centre = self.positions[v as usize];
        let centre = self.torus.map_or(centre, |torus| torus.near(place, centre));
        Ball { centre, weight: self.weights[v as usize] }
    }

    /// The squared radius of a ball.
    pub(crate) fn squared_radius<N: crate::real::Real>(&self, v: u32) -> N {
        N::sum(self.alpha, self.weights[v as usize])
    }

    /// The unit of lengths: a power of two, in the unit of the shape.
    pub(crate) fn unit(&self) -> f64 {
        self.unit
    }

    /// A length to this power in the unit of the balls, from one in the unit of the shape.
    pub(crate) fn unscaled(&self, number: Bounded, power: i32) -> Single {
        let Bounded { value, bound } = number.scaled(self.unit.powi(-power));
        Single { value, error: bound }
    }

    /// A result in the unit of the shape: a length to this power.
    pub(crate) fn bounded(&self, number: Single, power: i32) -> Bounded {
        number.bounded().scaled(self.unit.powi(power))
    }
}
