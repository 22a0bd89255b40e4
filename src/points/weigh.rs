use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::{Points, PointsError};

/// Where the weights ω of points come from. Weights are **squared** lengths, as α is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Weighting {
    /// ω = C for all: the shape at α is the unweighted one at α + C.
    Common(f64),
    /// ω = α·(L − Lmin)/(Lmax − Lmin), all 0 where Lmax = Lmin (equation 4.1).
    MinMax,
    /// ω = α·L/ΣL, all 0 where ΣL = 0 (equation 4.2, literally). The mean weight is α/N, too
    /// little to change a shape of many points.
    Barycentric,
    /// N times the barycentric weights, so that the mean weight is α. Not in the paper.
    BarycentricN,
    /// A column of the input.
    Column,
}

/// What a shape is made of: places and their weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WeightedPoints {
    /// Coordinates (x, y, z).
    pub positions: Vec<[f64; 3]>,
    /// Weights ω, squared lengths, one each.
    pub weights: Vec<f64>,
    /// Values F, one each, where known.
    pub values: Option<Vec<f64>>,
}

/// The range of weights.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WeightSummary {
    /// The smallest.
    pub min: f64,
    /// The mean.
    pub mean: f64,
    /// The largest.
    pub max: f64,
}

impl Weighting {
    /// Whether weights come from the differences L.
    pub fn needs_differences(self) -> bool {
        matches!(self, Self::MinMax | Self::Barycentric | Self::BarycentricN)
    }
}

impl WeightedPoints {
    /// The number of points.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Smallest, mean and largest weight; all 0 where there is no point.
    pub fn summary(&self) -> WeightSummary {
        if self.weights.is_empty() {
            return WeightSummary { min: 0.0, mean: 0.0, max: 0.0 };
        }
        let (min, max) = range(&self.weights);
        let mean = self.weights.iter().sum::<f64>() / self.weights.len() as f64;
        WeightSummary { min, mean, max }
    }
}

/// Gives points their weights. `alpha_squared` is the α of the shape, or the α at which weights
/// are frozen, a squared length; common and column weights do not depend on it. O(n).
///
/// # Errors
/// α is infinite or NaN where weights are proportional to it; points without differences
/// (of scattered ones see [`scattered_difference`](super::scattered_difference)) or without a column of weights where these are asked for; a weight that is
/// no finite number.
pub fn weigh(
    points: &Points,
    weighting: Weighting,
    alpha_squared: f64,
) -> Result<WeightedPoints, PointsError> {
    let differences = || {
        if !alpha_squared.is_finite() {
            return Err(PointsError::UnboundedAlpha { weighting, alpha: alpha_squared });
        }
        points.differences.as_deref().ok_or(PointsError::NoDifferences { weighting })
    };
    let weights = match weighting {
        Weighting::Common(weight) => vec![weight; points.len()],
        Weighting::Column => points.weights.clone().ok_or(PointsError::NoColumn)?,
        Weighting::MinMax => {
            let differences = differences()?;
            let (min, max) = range(differences);
            shares(differences, alpha_squared, min, max - min)
        }
        Weighting::Barycentric | Weighting::BarycentricN => {
            let differences = differences()?;
            let n = if weighting == Weighting::BarycentricN { points.len() as f64 } else { 1.0 };
            shares(differences, alpha_squared * n, 0.0, differences.iter().sum())
        }
    };
    if let Some(index) = weights.iter().position(|weight| !weight.is_finite()) {
        return Err(PointsError::Weight { index, weight: weights[index] });
    }
    Ok(WeightedPoints {
        positions: points.positions.clone(),
        weights,
        values: points.values.clone(),
    })
}

/// factor·((L − base)/whole), or all 0 where the whole is.
fn shares(differences: &[f64], factor: f64, base: f64, whole: f64) -> Vec<f64> {
    let share = |l: &f64| if whole == 0.0 { 0.0 } else { factor * ((l - base) / whole) };
    differences.iter().map(share).collect()
}

fn range(numbers: &[f64]) -> (f64, f64) {
    let ends = |(low, high): (f64, f64), &v: &f64| (low.min(v), high.max(v));
    numbers.iter().fold((f64::INFINITY, f64::NEG_INFINITY), ends)
}

impl fmt::Display for Weighting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Common(weight) => write!(f, "common={weight}"),
            Self::MinMax => f.write_str("min-max"),
            Self::Barycentric => f.write_str("barycentric"),
            Self::BarycentricN => f.write_str("barycentric-n"),
            Self::Column => f.write_str("column"),
        }
    }
}

/// A text that names no weighting.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{0:?} names no weights: give common=C (C a squared length), min-max, barycentric, \
     barycentric-n or column"
)]
pub struct UnknownWeighting(String);

impl FromStr for Weighting {
    type Err = UnknownWeighting;

    fn from_str(text: &str) -> Result<Self, UnknownWeighting> {
        let unknown = || UnknownWeighting(text.into());
        match text {
            "min-max" => Ok(Self::MinMax),
            "barycentric" => Ok(Self::Barycentric),
            "barycentric-n" => Ok(Self::BarycentricN),
            "column" => Ok(Self::Column),
            _ => {
                let weight = text.strip_prefix("common=").ok_or_else(unknown)?;
                let weight: f64 = weight.parse().map_err(|_| unknown())?;
                if weight.is_finite() { Ok(Self::Common(weight)) } else { Err(unknown()) }
            }
        }
    }
}
