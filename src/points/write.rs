use std::io::{self, Write};

use ndarray::Array2;
use ndarray_npy::{WriteNpyError, WriteNpyExt};

use super::WeightedPoints;

/// Writes points as CSV with the columns x, y, z, weight and, if known, value. Each number has the shortest
/// form that reads back as the same double.
///
/// # Errors
/// Errors of the writer.
pub(super) fn csv(points: &WeightedPoints, writer: &mut dyn Write) -> io::Result<()> {
    let value = if points.values().is_some() { ",value" } else { "" };
    writeln!(writer, "x,y,z,weight{value}")?;
    for (i, ([x, y, z], weight)) in points.positions().iter().zip(points.weights()).enumerate() {
        write!(writer, "{x},{y},{z},{weight}")?;
        if let Some(values) = points.values() {
            write!(writer, ",{}", values[i])?;
        }
        writeln!(writer)?;
    }
    writer.flush()
}

/// Writes points as an NPY array of doubles, n×4 (x, y, z, weight) or, if values are known, n×5.
///
/// # Errors
/// Errors of the writer.
pub(super) fn npy(points: &WeightedPoints, mut writer: &mut dyn Write) -> io::Result<()> {
    let columns = if points.values().is_some() { 5 } else { 4 };
    let rows = Array2::from_shape_fn((points.len(), columns), |(i, column)| match column {
        3 => points.weights()[i],
        4 => points.values().map_or(0.0, |values| values[i]),
        axis => points.positions()[i][axis],
    });
    rows.write_npy(&mut writer).map_err(|error| match error {
        WriteNpyError::Io(error) => error,
        other => io::Error::other(other),
    })?;
    writer.flush()
}
