use std::collections::HashSet;

use walpha_base::keep;

use super::attributes::keep_rows;
use super::{Column, Molecule, PointsError};
use walpha_shape::LengthsError;

/// Points with their optional data: columns of equal length.
///
/// ```
/// use walpha_points::Points;
///
/// let points = Points::new(vec![[0.0; 3], [1.0, 0.0, 0.0]]).with_values(vec![10.0, 20.0])?;
/// assert!(points.with_weights(vec![0.5]).is_err());
/// # Ok::<(), walpha_points::PointsError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Points {
    /// Coordinates (x, y, z).
    pub positions: Vec<[f64; 3]>,
    /// Values F: original gray levels, or a column of the input.
    pub values: Option<Vec<f64>>,
    /// Differences L, of a voxel or of scattered values.
    pub differences: Option<Vec<f64>>,
    /// Weights ω of the input, as squared lengths.
    pub weights: Option<Vec<f64>>,
    /// Whether the weights are squares of radii, which the input has instead of weights.
    pub of_radii: bool,
    /// The atoms that the points are, if they are those of a molecule.
    pub molecule: Option<Molecule>,
    /// The other columns that were [kept](crate::Attributes).
    pub columns: Vec<Column>,
}

impl Points {
    /// Creates points at these positions (x, y, z), without other data.
    pub fn new(positions: Vec<[f64; 3]>) -> Self {
        Self { positions, ..Self::default() }
    }

    /// Sets the values F of the points.
    ///
    /// # Errors
    /// [`PointsError::Lengths`] unless there is one value for each point.
    pub fn with_values(self, values: Vec<f64>) -> Result<Self, PointsError> {
        let values = column("values", values, self.len())?;
        Ok(Self { values: Some(values), ..self })
    }

    /// Sets the differences L of the points.
    ///
    /// # Errors
    /// See [`with_values`](Self::with_values).
    pub fn with_differences(self, differences: Vec<f64>) -> Result<Self, PointsError> {
        let differences = column("differences", differences, self.len())?;
        Ok(Self { differences: Some(differences), ..self })
    }

    /// Sets the weights ω of the points, which are squared lengths.
    ///
    /// # Errors
    /// See [`with_values`](Self::with_values).
    pub fn with_weights(self, weights: Vec<f64>) -> Result<Self, PointsError> {
        let weights = column("weights", weights, self.len())?;
        Ok(Self { weights: Some(weights), ..self })
    }

    /// Keeps the first point in each cube of a grid with this side, in the order of the points. The grid starts at the least
    /// coordinates. O(n).
    ///
    /// # Errors
    /// The side is not a finite number above 0.
    pub fn thin(&mut self, side: f64) -> Result<(), PointsError> {
        Cubes::check(side)?;
        let [least, _] = bounding_box(&self.positions);
        let mut cubes = Cubes::new(least, side);
        let kept: Vec<bool> = self.positions.iter().map(|&place| cubes.takes(place)).collect();
        self.keep(&kept);
        Ok(())
    }

    /// Keeps only the marked points, with one mark for each. O(n).
    pub fn keep(&mut self, kept: &[bool]) {
        let columns = [&mut self.values, &mut self.differences, &mut self.weights];
        columns.into_iter().flatten().for_each(|column| keep(column, kept));
        if let Some(molecule) = &mut self.molecule {
            keep(&mut molecule.atoms, kept);
        }
        keep_rows(&mut self.columns, kept);
        keep(&mut self.positions, kept);
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }
}

/// Returns the column if it has an entry for each point.
fn column(name: &'static str, column: Vec<f64>, points: usize) -> Result<Vec<f64>, PointsError> {
    LengthsError::unless_equal(name, column.len(), points)?;
    Ok(column)
}

/// The cubes of a grid that have a point.
pub(crate) struct Cubes {
    least: [f64; 3],
    side: f64,
    taken: HashSet<[u64; 3]>,
}

impl Cubes {
    /// Cubes of this side from the least coordinates on, all of them empty.
    pub(crate) fn new(least: [f64; 3], side: f64) -> Self {
        Self { least, side, taken: HashSet::new() }
    }

    /// Refuses a side that is not a finite number above 0.
    pub(crate) fn check(side: f64) -> Result<(), PointsError> {
        if side > 0.0 && side.is_finite() {
            return Ok(());
        }
        let (what, need) = ("cubes of side", "a length above 0");
        Err(PointsError::Number { what, given: side, need })
    }

    /// Whether a position is the first one in its cube.
    pub(crate) fn takes(&mut self, place: [f64; 3]) -> bool {
        // Floats are used, as a side may be so small that the number of a cube fits no integer.
        let cube = |axis: usize| ((place[axis] - self.least[axis]) / self.side).floor().to_bits();
        self.taken.insert([0, 1, 2].map(cube))
    }
}

/// The least and the greatest corner of the box around some points, infinite without any. O(n).
pub fn bounding_box(positions: &[[f64; 3]]) -> [[f64; 3]; 2] {
    let none = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    positions.iter().fold(none, |[least, greatest], place| {
        [
            [0, 1, 2].map(|axis| least[axis].min(place[axis])),
            [0, 1, 2].map(|axis| greatest[axis].max(place[axis])),
        ]
    })
}
