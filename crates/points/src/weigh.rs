//! Weights of points.

use walpha_complex::Alpha;

use super::weighting::{Differences, Rule, Shares, Weighting};
use super::{Points, PointsError, WeightedPoints};

/// Gives points their weights, as [`weights`] computes them.
///
/// # Errors
/// See [`weights`].
pub fn weigh(
    mut points: Points,
    weighting: Weighting,
    alpha: Alpha,
) -> Result<WeightedPoints, PointsError> {
    let weights = match weighting {
        Weighting::Column => finite(points.weights.take().ok_or(PointsError::NoColumn)?)?,
        _ => weights(&points, weighting, alpha)?,
    };
    Ok(WeightedPoints::new(points.positions, weights)?.with_values(points.values)?)
}

/// Computes the weights of points. `alpha` is the α of the shape, or the one at which weights are frozen; common and column
/// weights do not depend on it. O(n).
///
/// # Errors
/// α is infinite and weights are proportional to it; differences are missing (for scattered points they are
/// [`scattered_difference`](super::scattered_difference)s), or a column of weights is missing, and the weighting needs them; or a
/// weight is not finite.
pub fn weights(
    points: &Points,
    weighting: Weighting,
    alpha: Alpha,
) -> Result<Vec<f64>, PointsError> {
    finite(match (&weighting.kind().rule, weighting) {
        (Rule::Common, Weighting::Common(weight)) => vec![weight; points.len()],
        (Rule::Common | Rule::Column, _) => points.weights.clone().ok_or(PointsError::NoColumn)?,
        (Rule::Proportional(_), _) => {
            let differences =
                points.differences.as_deref().ok_or(PointsError::NoDifferences { weighting })?;
            let shares = weighting.shares(&Differences::of(differences), alpha)?;
            differences.iter().map(|&l| shares.of(l)).collect()
        }
    })
}

/// Returns the weights if all are finite.
fn finite(weights: Vec<f64>) -> Result<Vec<f64>, PointsError> {
    match weights.iter().position(|weight| !weight.is_finite()) {
        Some(index) => Err(PointsError::Weight { index, weight: weights[index] }),
        None => Ok(weights),
    }
}

impl Weighting {
    /// The formula of weights proportional to differences.
    ///
    /// # Errors
    /// α is infinite, or the weighting is of another kind.
    #[doc(hidden)]
    pub fn shares(self, differences: &Differences, alpha: Alpha) -> Result<Shares, PointsError> {
        let Rule::Proportional(rule) = self.kind().rule else { return Err(PointsError::NoColumn) };
        if !alpha.squared().is_finite() {
            return Err(PointsError::UnboundedAlpha { weighting: self, alpha });
        }
        Ok(rule(differences, alpha.squared()))
    }
}
