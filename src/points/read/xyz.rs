use std::io::{BufRead, BufReader};
use std::path::Path;

use super::rows::Rows;
use super::{COLUMNS, Columns, Points, PointsError, format};
use crate::volume::{Lines, Reason, io_error};

/// What a first line with nothing but a count means.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Counted {
    /// Chemistry's XYZ: a line of words, then an element and the coordinates of each atom, and
    /// whatever follows these.
    Atoms,
    /// PWN: the points, and then as many normals.
    PointsThenNormals,
}

/// Reads lines of numbers between white space (or commas). A first line of names, optionally after `#` or
/// `//`, says what they are; other lines that begin so are remarks.
pub(crate) fn read(
    path: &Path,
    columns: Option<&Columns>,
    counted: Counted,
) -> Result<Points, PointsError> {
    let file = std::fs::File::open(path).map_err(io_error(path))?;
    let mut lines = Lines::new(BufReader::new(file));
    let mut rows = Rows::new(path, columns.cloned());
    let (mut number, mut first) = (0, true);
    while let Some(line) = lines.next().map_err(io_error(path))? {
        number += 1;
        let remark = line.trim_start().starts_with(['#', '/']);
        let words = words(line.trim_start_matches(['\u{feff}', '#', '/', ' ', '\t']));
        if words.is_empty() {
            continue;
        }
        if first {
            if let Ok(named) = Columns::named(&words) {
                rows.are(named);
                first = false;
                continue;
            }
            if let ([count], false) = (words.as_slice(), remark)
                && let Ok(count) = count.parse()
            {
                return match counted {
                    Counted::Atoms => atoms(path, lines, count),
                    Counted::PointsThenNormals => points_then_normals(path, lines, count),
                };
            }
        }
        if !remark {
            first = false;
            rows.push(number, &words)?;
        }
    }
    rows.finish()
}

fn words(line: &str) -> Vec<&str> {
    line.split([' ', '\t', ',']).filter(|word| !word.is_empty()).collect()
}

fn finite(path: &Path, line: u64, name: &str, word: &str) -> Result<f64, PointsError> {
    word.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| {
        format(
            path,
            Reason::value(format!("line {line}, column {name}: {word:?} is not a finite number")),
        )
    })
}

/// Reads atoms, after the line that counts them.
fn atoms(path: &Path, mut lines: Lines<impl BufRead>, count: u64) -> Result<Points, PointsError> {
    let mut points = Points::default();
    let mut number = 1;
    while let Some(line) = lines.next().map_err(io_error(path))? {
        number += 1;
        let words: Vec<&str> = line.split_whitespace().collect();
        if number == 2 || words.is_empty() {
            continue;
        }
        let [_, x, y, z, ..] = words[..] else {
            let reason = Reason::value(format!("line {number} is not an element with x, y and z"));
            return Err(format(path, reason));
        };
        let axis = |axis: usize, word| finite(path, number, COLUMNS[axis], word);
        points.positions.push([axis(0, x)?, axis(1, y)?, axis(2, z)?]);
    }
    if points.len() as u64 != count {
        let found = points.len();
        let reason = Reason::truncated(format!(
            "claims {count} atoms, but has {found}: it is truncated or mislabelled"
        ));
        return Err(format(path, reason));
    }
    Ok(points)
}

/// Reads so many points, and as many normals, which are passed over.
fn points_then_normals(
    path: &Path,
    mut lines: Lines<impl BufRead>,
    count: u64,
) -> Result<Points, PointsError> {
    let mut points = Points::default();
    let (mut number, mut found) = (1, 0);
    while let Some(line) = lines.next().map_err(io_error(path))? {
        number += 1;
        let words = words(&line);
        if words.is_empty() {
            continue;
        }
        let [x, y, z] = words[..] else {
            return Err(format(
                path,
                Reason::value(format!("line {number} has {} columns, not 3", words.len())),
            ));
        };
        let axis = |axis: usize, word| finite(path, number, COLUMNS[axis], word);
        let vector = [axis(0, x)?, axis(1, y)?, axis(2, z)?];
        if found < count {
            points.positions.push(vector);
        }
        found += 1;
    }
    if found != count && Some(found) != count.checked_mul(2) {
        let reason = Reason::truncated(format!(
            "claims {count} points and as many normals, but has {found} lines: it is \
                 truncated or mislabelled"
        ));
        return Err(format(path, reason));
    }
    Ok(points)
}
