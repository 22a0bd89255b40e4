//! Points and their weights.

use walpha_complex::Alpha;

use super::weighting::{Differences, Rule, Shares, Weighting};
use super::{Points, PointsError, WeightedPoints};

/// Gives points their weights, as [`weights`] computes them.
///
/// # Errors
/// The errors of [`weights`].
pub fn weigh(
    mut points: Points,
    weighting: Weighting,
    alpha: Alpha,
) -> Result<WeightedPoints, PointsError> {
    let weights = match weighting {
        Weighting::Column => finite(points.weights.take().ok_or(PointsError::NoColumn)?)?,
        _ => weights(&points, weighting, alpha)?,
    };
    Ok(WeightedPoints { positions: points.positions, weights, values: points.values })
}

/// The weights of points. `alpha` is that of the shape, or the one at which weights are
/// frozen; common and column weights do not depend on it. O(n).
///
/// # Errors
/// α is infinite or NaN where weights are proportional to it; points without differences (those of
/// scattered points are [`scattered_difference`](super::scattered_difference)s) or without a column of
/// weights, where these are needed; a weight that is not a finite number.
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

/// Weights, all of which are finite numbers.
fn finite(weights: Vec<f64>) -> Result<Vec<f64>, PointsError> {
    match weights.iter().position(|weight| !weight.is_finite()) {
        Some(index) => Err(PointsError::Weight { index, weight: weights[index] }),
        None => Ok(weights),
    }
}

impl Weighting {
    /// How weights in proportion to differences come from these.
    ///
    /// # Errors
    /// α is infinite or NaN; the weights are of another kind.
    pub(crate) fn shares(
        self,
        differences: &Differences,
        alpha: Alpha,
    ) -> Result<Shares, PointsError> {
        let Rule::Proportional(rule) = self.kind().rule else { return Err(PointsError::NoColumn) };
        if !alpha.squared().is_finite() {
            return Err(PointsError::UnboundedAlpha { weighting: self, alpha });
        }
        Ok(rule(differences, alpha.squared()))
    }
}
