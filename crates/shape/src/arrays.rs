//! Points in arrays of `ndarray`.

use ndarray::{ArrayView1, ArrayView2};
use walpha_base::advice::{Advise, wrapped};

use crate::{LengthsError, WeightedPoints};

/// Why an array holds no points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ArrayError {
    /// The second axis is not that of x, y and z.
    #[error("the array is {rows}×{columns}: points are rows of 3 numbers, x, y and z")]
    Columns {
        /// Length of the first axis.
        rows: usize,
        /// Length of the second axis.
        columns: usize,
    },
    /// Another number of weights than of points.
    #[error(transparent)]
    Lengths(#[from] LengthsError),
}

impl Advise for ArrayError {
    wrapped!(Lengths);
}

/// Copies of points without weights: rows (x, y, z) of an n×3 array.
impl TryFrom<ArrayView2<'_, f64>> for WeightedPoints {
    type Error = ArrayError;

    fn try_from(positions: ArrayView2<'_, f64>) -> Result<Self, ArrayError> {
        rows(positions).map(Self::unweighted)
    }
}

/// Copies of points, rows (x, y, z) of an n×3 array, and their weights ω, squared lengths.
impl TryFrom<(ArrayView2<'_, f64>, ArrayView1<'_, f64>)> for WeightedPoints {
    type Error = ArrayError;

    fn try_from(
        (positions, weights): (ArrayView2<'_, f64>, ArrayView1<'_, f64>),
    ) -> Result<Self, ArrayError> {
        Ok(Self::new(rows(positions)?, weights.to_vec())?)
    }
}

fn rows(positions: ArrayView2<'_, f64>) -> Result<Vec<[f64; 3]>, ArrayError> {
    let (rows, columns) = positions.dim();
    if columns != 3 {
        return Err(ArrayError::Columns { rows, columns });
    }
    Ok(positions.outer_iter().map(|row| [row[0], row[1], row[2]]).collect())
}

#[cfg(test)]
mod tests {
    use ndarray::{Array2, array};

    use super::*;

    /// Whatever the order in memory.
    #[test]
    fn rows_are_points() {
        let rows = array![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
        let columns = array![[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]];
        let expected = WeightedPoints::from(&[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        assert_eq!(WeightedPoints::try_from(rows.view()), Ok(expected.clone()));
        assert_eq!(WeightedPoints::try_from(columns.t()), Ok(expected));
        let weighted = WeightedPoints::try_from((rows.view(), array![7.0, 8.0].view())).unwrap();
        assert_eq!(weighted.weights(), [7.0, 8.0]);
    }

    #[test]
    fn other_arrays_are_refused() {
        let flat = Array2::zeros((5, 2));
        let error = WeightedPoints::try_from(flat.view()).unwrap_err().to_string();
        assert_eq!(error, "the array is 5×2: points are rows of 3 numbers, x, y and z");
        let space = Array2::zeros((5, 3));
        let error = WeightedPoints::try_from((space.view(), array![0.0].view())).unwrap_err();
        assert!(matches!(error, ArrayError::Lengths(_)), "{error}");
        assert!(WeightedPoints::try_from(Array2::zeros((0, 3)).view()).unwrap().is_empty());
    }
}
