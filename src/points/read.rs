use std::io::Read;
use std::path::Path;

use super::{Points, PointsError};
use crate::volume::{NPY_MAGIC, NpyFile, VolumeError};

/// The columns of a point file that are read.
const COLUMNS: [&str; 5] = ["x", "y", "z", "weight", "value"];

/// Whether a file's name, or the header of an NPY file, says that it holds points rather than a
/// volume: `.csv`, or an NPY array of two axes.
///
/// # Errors
/// An NPY file that cannot be read.
pub fn is_point_file(path: &Path) -> Result<bool, PointsError> {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    if extension == "csv" {
        return Ok(true);
    }
    Ok(extension == "npy" && NpyFile::open(path)?.shape.len() == 2)
}

/// Reads points: an NPY array n×4 (x, y, z, weight) or n×5 (x, y, z, weight, value), or a CSV file
/// whose first line names its columns, x, y and z among them, perhaps weight and value, in any order
/// and case; other columns are passed over. Points are counted from 0.
///
/// # Errors
/// The file cannot be read, a column is missing or named twice, a field is no finite number (the
/// message has its line and column), or the file holds no point.
pub fn read_points(path: &Path) -> Result<Points, PointsError> {
    let mut start = Vec::new();
    let io = |source| VolumeError::Io { path: path.into(), source };
    let file = std::fs::File::open(path).map_err(io)?;
    file.take(NPY_MAGIC.len() as u64).read_to_end(&mut start).map_err(io)?;
    let points = if start == NPY_MAGIC { read_npy(path)? } else { read_csv(path)? };
    if points.is_empty() {
        return Err(format(path, "holds no point: there is nothing to shape".into()));
    }
    Ok(points)
}

fn format(path: &Path, what: String) -> PointsError {
    PointsError::Format { path: path.into(), what }
}

fn read_npy(path: &Path) -> Result<Points, PointsError> {
    let file = NpyFile::open(path)?;
    let columns = match file.shape.as_slice() {
        &[_, columns @ (4 | 5)] => columns as usize,
        other => {
            let what = format!(
                "is an array of shape {other:?}: points are n×4 (x, y, z, weight) or n×5 (…, value)"
            );
            return Err(format(path, what));
        }
    };
    let (fortran, rows) = (file.fortran, file.shape[0] as usize);
    let numbers: Vec<f64> = file.values(path)?;
    let at = |row: usize, column: usize| {
        numbers[if fortran { column * rows + row } else { row * columns + column }]
    };
    for row in 0..rows {
        if let Some(column) = (0..columns).find(|&column| !at(row, column).is_finite()) {
            let (name, value) = (COLUMNS[column], at(row, column));
            let what = format!("row {row}: {name} is {value}, and must be a finite number");
            return Err(format(path, what));
        }
    }
    let column = |column| (0..rows).map(|row| at(row, column)).collect();
    Ok(Points {
        positions: (0..rows).map(|row| [at(row, 0), at(row, 1), at(row, 2)]).collect(),
        weights: Some(column(3)),
        values: (columns == 5).then(|| column(4)),
        differences: None,
    })
}

fn read_csv(path: &Path) -> Result<Points, PointsError> {
    let said = |error: csv::Error| format(path, format!("is no CSV file of points: {error}"));
    let mut reader =
        csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path).map_err(said)?;
    let header = reader.headers().map_err(said)?.clone();
    let mut places = [None; COLUMNS.len()];
    for (place, name) in header.iter().enumerate() {
        let name = name.trim_start_matches('\u{feff}');
        let Some(column) = COLUMNS.iter().position(|c| c.eq_ignore_ascii_case(name)) else {
            continue;
        };
        if places[column].replace(place).is_some() {
            return Err(format(path, format!("names column {name} twice in its first line")));
        }
    }
    let [Some(x), Some(y), Some(z), weight, value] = places else {
        let names = header.iter().collect::<Vec<_>>().join(",");
        let what = format!(
            "its first line must name the columns x, y and z, and may name weight and value; it is \
             {names:?}"
        );
        return Err(format(path, what));
    };
    let mut points = Points {
        weights: weight.map(|_| Vec::new()),
        values: value.map(|_| Vec::new()),
        ..Points::default()
    };
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(said)? {
        let line = record.position().map_or(0, csv::Position::line);
        let number = |place: usize| match record[place].parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                let (name, text) = (&header[place], &record[place]);
                let what = format!("line {line}, column {name}: {text:?} is no finite number");
                Err(format(path, what))
            }
        };
        points.positions.push([number(x)?, number(y)?, number(z)?]);
        for (column, place) in [(&mut points.weights, weight), (&mut points.values, value)] {
            if let (Some(column), Some(place)) = (column, place) {
                column.push(number(place)?);
            }
        }
    }
    Ok(points)
}
