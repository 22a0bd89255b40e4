use serde::{Deserialize, Serialize};
use walpha_base::Sum;
use walpha_base::advice::Advise;

/// Weighted points, with values where they are known; as many weights, and values, as positions.
///
/// They are made from the available data: a `Vec` of positions is taken over, borrowed positions are copied, 24 bytes each.
/// Without weights all are 0. The numbers are checked when they are used.
///
/// ```
/// use walpha_shape::{Alpha, ShapeOptions, WeightedPoints, alpha_shape};
///
/// let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let weights = [0.25; 4];
/// let options = ShapeOptions::new(Alpha::from_squared(0.75)?);
/// let shape = alpha_shape(&points, &options)?;
/// let weighted = alpha_shape(WeightedPoints::try_from((&points, &weights))?, &options)?;
/// assert_eq!(shape.measures(), weighted.measures());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// An n×3 `ndarray` array can be converted, too, alone or with weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WeightedPoints {
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) weights: Vec<f64>,
    pub(crate) values: Option<Vec<f64>>,
}

/// A column whose number of entries is not the number of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{given} {column} for {points} points: each point needs one")]
#[non_exhaustive]
pub struct LengthsError {
    /// The content of the column.
    pub column: &'static str,
    /// Its number of entries.
    pub given: usize,
    /// The number of points.
    pub points: usize,
}

/// The range of weights. This struct is not `#[non_exhaustive]` because it consists of plain numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WeightSummary {
    /// The smallest.
    pub min: f64,
    /// The mean.
    pub mean: f64,
    /// The largest.
    pub max: f64,
}

impl Advise for LengthsError {}

impl LengthsError {
    /// Checks that a column has as many entries as there are points.
    ///
    /// # Errors
    /// [`LengthsError`] if it does not.
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

    /// Sets the values F of the points, or removes them.
    ///
    /// # Errors
    /// The numbers of points and values differ.
    pub fn with_values(self, values: impl Into<Option<Vec<f64>>>) -> Result<Self, LengthsError> {
        let values = values.into();
        LengthsError::unless_equal(
            "values",
            values.as_ref().map_or(self.len(), Vec::len),
            self.len(),
        )?;
        Ok(Self { values, ..self })
    }

    /// Coordinates (x, y, z).
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Weights ω, squared lengths, one for each point.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Values F, one for each point, if they are known.
    pub fn values(&self) -> Option<&[f64]> {
        self.values.as_deref()
    }

    /// The coordinates, to change in place.
    pub fn positions_mut(&mut self) -> &mut [[f64; 3]] {
        &mut self.positions
    }

    /// The weights, to change in place.
    pub fn weights_mut(&mut self) -> &mut [f64] {
        &mut self.weights
    }

    /// The values, to change in place.
    pub fn values_mut(&mut self) -> Option<&mut [f64]> {
        self.values.as_deref_mut()
    }

    /// Positions, weights, and values if they are known.
    pub fn into_parts(self) -> (Vec<[f64; 3]>, Vec<f64>, Option<Vec<f64>>) {
        (self.positions, self.weights, self.values)
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

/// Points without weights.
impl From<Vec<[f64; 3]>> for WeightedPoints {
    fn from(positions: Vec<[f64; 3]>) -> Self {
        Self::unweighted(positions)
    }
}

/// Copies points without weights from a slice, a `Vec` or an array.
impl<P: AsRef<[[f64; 3]]> + ?Sized> From<&P> for WeightedPoints {
    fn from(positions: &P) -> Self {
        Self::unweighted(positions.as_ref().to_vec())
    }
}

/// A copy.
impl From<&Self> for WeightedPoints {
    fn from(points: &Self) -> Self {
        points.clone()
    }
}

/// Copies of points and their weights ω, squared lengths.
impl<P, W> TryFrom<(&P, &W)> for WeightedPoints
where
    P: AsRef<[[f64; 3]]> + ?Sized,
    W: AsRef<[f64]> + ?Sized,
{
    type Error = LengthsError;

    fn try_from((positions, weights): (&P, &W)) -> Result<Self, LengthsError> {
        Self::new(positions.as_ref().to_vec(), weights.as_ref().to_vec())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POSITIONS: [[f64; 3]; 2] = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];

    #[test]
    fn points_are_made_of_what_is_at_hand() {
        let expected = WeightedPoints::unweighted(POSITIONS.to_vec());
        assert_eq!(expected.weights(), [0.0; 2]);
        let owned = POSITIONS.to_vec();
        assert_eq!(WeightedPoints::from(&owned), expected);
        assert_eq!(WeightedPoints::from(&owned[..]), expected);
        assert_eq!(WeightedPoints::from(&POSITIONS), expected);
        assert_eq!(WeightedPoints::from(&expected), expected);
        assert_eq!(WeightedPoints::from(owned), expected);
        let weighted = WeightedPoints::try_from((&POSITIONS, &[7.0, 8.0])).unwrap();
        assert_eq!((weighted.positions(), weighted.weights()), (&POSITIONS[..], &[7.0, 8.0][..]));
    }

    #[test]
    fn columns_of_other_lengths_are_refused() {
        let error = WeightedPoints::try_from((&POSITIONS[..], &[1.0])).unwrap_err();
        assert_eq!(error.to_string(), "1 weights for 2 points: each point needs one");
        let points = WeightedPoints::from(&POSITIONS);
        assert!(points.clone().with_values(vec![0.0; 3]).is_err());
        assert_eq!(points.clone().with_values(None), Ok(points.clone()));
        let (positions, weights, values) = points.with_values(vec![0.5, 1.5]).unwrap().into_parts();
        assert_eq!((positions.len(), weights.len(), values), (2, 2, Some(vec![0.5, 1.5])));
    }
}
