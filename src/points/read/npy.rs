use super::{Points, PointsError, format};
use crate::volume::{NpyFile, OpenFile, Reason};
use walpha_base::Monitor;

/// Reads an array n×3 (x, y, z), n×4 (…, weight) or n×5 (…, value).
pub(crate) fn read(file: &OpenFile) -> Result<Points, PointsError> {
    let path = file.path();
    let file = NpyFile::open(file)?;
    let columns = match file.shape.as_slice() {
        &[_, columns @ 3..=5] => columns as usize,
        other => {
            let reason = Reason::header(format!(
                "is an array of shape {other:?}: points are n×3 (x, y, z), n×4 (…, weight) or n×5 (…, value)"
            ));
            return Err(format(path, reason));
        }
    };
    let (fortran, rows) = (file.fortran, file.shape[0] as usize);
    let numbers: Vec<f64> = file.values(path, &Monitor::noop())?;
    let at = |row: usize, column: usize| {
        numbers[if fortran { column * rows + row } else { row * columns + column }]
    };
    let column = |column| (0..rows).map(|row| at(row, column)).collect();
    Ok(Points {
        positions: (0..rows).map(|row| [at(row, 0), at(row, 1), at(row, 2)]).collect(),
        weights: (columns > 3).then(|| column(3)),
        values: (columns > 4).then(|| column(4)),
        ..Points::default()
    })
}
