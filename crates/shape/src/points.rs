use serde::{Deserialize, Serialize};
use walpha_base::Sum;

/// Weighted points, with values where they are known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WeightedPoints {
    /// Coordinates (x, y, z).
    pub positions: Vec<[f64; 3]>,
    /// Weights ω, squared lengths, one for each point.
    pub weights: Vec<f64>,
    /// Values F, one for each point.
    pub values: Option<Vec<f64>>,
}

/// A column whose number of entries is not the number of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{given} {column} for {points} points: each point needs one")]
#[non_exhaustive]
pub struct LengthsError {
    /// What the column contains.
    pub column: &'static str,
    /// Its number of entries.
    pub given: usize,
    /// The number of points.
    pub points: usize,
}

/// The range of weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WeightSummary {
    /// The smallest.
    pub min: f64,
    /// The mean.
    pub mean: f64,
    /// The largest.
    pub max: f64,
}

impl LengthsError {
    /// Checks that a column has as many entries as there are points.
    ///
    /// # Errors
    /// [`LengthsError`] where it has not.
    pub fn unless_equal(column: &'static str, given: usize, points: usize) -> Result<(), Self> {
        if given == points { Ok(()) } else { Err(Self { column, given, points }) }
    }
}

impl WeightedPoints {
    /// Points at positions (x, y, z) with weights ω, squared lengths.
    ///
    /// # Errors
    /// The numbers of positions and weights differ.
    pub fn new(positions: Vec<[f64; 3]>, weights: Vec<f64>) -> Result<Self, LengthsError> {
        LengthsError::unless_equal("weights", weights.len(), positions.len())?;
        Ok(Self { positions, weights, values: None })
    }

    /// Points whose weights are all 0.
    pub fn unweighted(positions: Vec<[f64; 3]>) -> Self {
        Self { weights: vec![0.0; positions.len()], positions, values: None }
    }

    /// The same points with values F.
    ///
    /// # Errors
    /// The numbers of points and values differ.
    pub fn with_values(self, values: Vec<f64>) -> Result<Self, LengthsError> {
        LengthsError::unless_equal("values", values.len(), self.len())?;
        Ok(Self { values: Some(values), ..self })
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Smallest, mean and largest weight; all 0 without points.
    pub fn summary(&self) -> WeightSummary {
        if self.weights.is_empty() {
            return WeightSummary::default();
        }
        let ends = |(low, high): (f64, f64), &w: &f64| (low.min(w), high.max(w));
        let (min, max) = self.weights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), ends);
        // Summed exactly, so that the order and the number of threads do not matter.
        let sum: Sum = self.weights.iter().copied().collect();
        WeightSummary { min, mean: sum.value() / self.weights.len() as f64, max }
    }
}
