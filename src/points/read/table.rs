use std::io::BufReader;
use std::path::Path;

use super::{COLUMNS, Points, PointsError, format};
use crate::volume::{Lines, io_error};

/// Reads CSV, or TSV, whose fields are separated by tabs; the first line names the columns.
pub(super) fn read(path: &Path) -> Result<Points, PointsError> {
    let said =
        |error: csv::Error| format(path, format!("is no CSV or TSV file of points: {error}"));
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter(path)?)
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(said)?;
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

/// A tab where the first line has one and no comma.
fn delimiter(path: &Path) -> Result<u8, PointsError> {
    let file = std::fs::File::open(path).map_err(io_error(path))?;
    let line = Lines::new(BufReader::new(file)).next().map_err(io_error(path))?;
    let line = line.unwrap_or_default();
    Ok(if line.contains('\t') && !line.contains(',') { b'\t' } else { b',' })
}
