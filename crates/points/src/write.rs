use std::io::{self, Write};

use walpha_base::npy::MAGIC;

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

/// Writes points as a structured NPY array with the fields x, y, z, weight and, if known, value, all doubles.
///
/// # Errors
/// Errors of the writer.
pub(super) fn npy(points: &WeightedPoints, writer: &mut dyn Write) -> io::Result<()> {
    /// Bytes before the text of the header: the magic string, the version, and the length of the text.
    const BEFORE: usize = 10;
    let value = if points.values().is_some() { ", ('value', '<f8')" } else { "" };
    let mut header = format!(
        "{{'descr': [('x', '<f8'), ('y', '<f8'), ('z', '<f8'), ('weight', '<f8'){value}], \
         'fortran_order': False, 'shape': ({},), }}",
        points.len()
    );
    // NumPy aligns the elements to 64 bytes; a line end comes last.
    let length = BEFORE + header.len() + 1;
    header += &" ".repeat(length.next_multiple_of(64) - length);
    header.push('\n');
    writer.write_all(MAGIC)?;
    writer.write_all(&[1, 0])?;
    writer.write_all(&(header.len() as u16).to_le_bytes())?;
    writer.write_all(header.as_bytes())?;
    for (i, (place, weight)) in points.positions().iter().zip(points.weights()).enumerate() {
        let value = points.values().map(|values| values[i]);
        for number in place.iter().chain([weight]).chain(value.as_ref()) {
            writer.write_all(&number.to_le_bytes())?;
        }
    }
    writer.flush()
}
