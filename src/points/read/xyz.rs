use std::io::{BufRead, BufReader};
use std::path::Path;

use super::{COLUMNS, Points, PointsError, format};
use crate::volume::{Lines, io_error};

/// Reads lines of numbers between white space (or commas): x, y, z and perhaps value. A first line of
/// names, perhaps behind `#` or `//`, says otherwise; other lines that begin so are remarks.
///
/// Chemistry's XYZ begins with the number of atoms and a line of words; an element stands before the
/// coordinates of each, and whatever follows them is passed over.
pub(super) fn read(path: &Path) -> Result<Points, PointsError> {
    let file = std::fs::File::open(path).map_err(io_error(path))?;
    let mut lines = Lines::new(BufReader::new(file));
    let mut number = 0;
    let mut columns: Option<Vec<Option<usize>>> = None;
    let mut points = Points::default();
    while let Some(line) = lines.next().map_err(io_error(path))? {
        number += 1;
        let remark = line.trim_start().starts_with(['#', '/']);
        let words: Vec<&str> = line
            .trim_start_matches(['\u{feff}', '#', '/', ' ', '\t'])
            .split([' ', '\t', ','])
            .filter(|word| !word.is_empty())
            .collect();
        if words.is_empty() {
            continue;
        }
        let Some(known) = &columns else {
            if let ([count], false) = (words.as_slice(), remark)
                && let Ok(count) = count.parse()
            {
                return atoms(path, lines, count);
            }
            let named: Vec<Option<usize>> = words
                .iter()
                .map(|word| COLUMNS.iter().position(|name| name.eq_ignore_ascii_case(word)))
                .collect();
            if [0, 1, 2].iter().all(|&axis| named.contains(&Some(axis))) {
                columns = Some(named);
            } else if !remark {
                columns = Some(match words.len() {
                    3 => [0, 1, 2].map(Some).to_vec(),
                    4 => [0, 1, 2, 4].map(Some).to_vec(),
                    count => {
                        let what = format!(
                            "line {number} has {count} columns: x y z or x y z value are read; name \
                             others in a first line such as # x y z weight value"
                        );
                        return Err(format(path, what));
                    }
                });
                push(path, number, &words, columns.as_ref().expect("set"), &mut points)?;
            }
            continue;
        };
        if !remark {
            push(path, number, &words, known, &mut points)?;
        }
    }
    Ok(points)
}

/// Adds the point of a line.
fn push(
    path: &Path,
    line: u64,
    words: &[&str],
    columns: &[Option<usize>],
    points: &mut Points,
) -> Result<(), PointsError> {
    if words.len() != columns.len() {
        let (found, expected) = (words.len(), columns.len());
        let what = format!("line {line} has {found} columns, but the first has {expected}");
        return Err(format(path, what));
    }
    let mut position = [0.0; 3];
    for (word, column) in words.iter().zip(columns) {
        let Some(column) = *column else { continue };
        let number = finite(path, line, COLUMNS[column], word)?;
        match column {
            3 => points.weights.get_or_insert_default().push(number),
            4 => points.values.get_or_insert_default().push(number),
            axis => position[axis] = number,
        }
    }
    points.positions.push(position);
    Ok(())
}

fn finite(path: &Path, line: u64, name: &str, word: &str) -> Result<f64, PointsError> {
    word.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| {
        format(path, format!("line {line}, column {name}: {word:?} is no finite number"))
    })
}

/// Reads atoms, behind the line that counts them.
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
            let what = format!("line {number} is no element with x, y and z");
            return Err(format(path, what));
        };
        let axis = |axis: usize, word| finite(path, number, COLUMNS[axis], word);
        points.positions.push([axis(0, x)?, axis(1, y)?, axis(2, z)?]);
    }
    if points.len() as u64 != count {
        let found = points.len();
        let what = format!("claims {count} atoms, but has {found}: it is truncated or mislabelled");
        return Err(format(path, what));
    }
    Ok(points)
}
