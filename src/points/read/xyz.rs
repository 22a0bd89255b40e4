use std::io::BufRead;
use std::path::Path;

use super::extended::Comment;
use super::rows::TextRows;
use super::{COLUMNS, Columns, Points, PointsError, format};
use crate::points::ModelMetadata;
use crate::volume::{Lines, OpenFile, Reason, io_error};

/// How lines of numbers are laid out, unless they have names.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum TextLayout {
    /// A first line with only a count begins chemistry's XYZ: a comment line, whose form extended XYZ defines,
    /// then for each atom an element, its coordinates, and possibly more columns.
    Atoms,
    /// As `Atoms`, but six columns are a position with a normal or colour.
    Vectors,
    /// PTS: a count may come first; seven columns are x y z, the intensity and a colour.
    Scan,
    /// PWN: a count, the points, and then as many normals.
    PointsThenNormals,
}

impl TextLayout {
    /// The columns without names, unless they are guessed from the numbers in them.
    fn default_columns(self) -> Option<Columns> {
        let axes = [Some(0), Some(1), Some(2)];
        match self {
            Self::Atoms | Self::PointsThenNormals => None,
            Self::Vectors => Some(Columns([axes, [None; 3]].concat())),
            Self::Scan => Some(Columns([&axes[..], &[Some(4)], &[None; 3]].concat())),
        }
    }
}

/// Reads lines of numbers separated by white space or commas. A first line may name the columns, optionally after
/// `#` or `//`; other lines that begin with `#` or `/` are comments.
pub(crate) fn read(
    file: &OpenFile,
    columns: Option<&Columns>,
    layout: TextLayout,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let mut lines = Lines::new(file.reader()?);
    let mut rows = TextRows::new(path, columns.cloned());
    rows.default_columns = layout.default_columns();
    let (mut number, mut first, mut claimed) = (0, true, None);
    while let Some(line) = lines.read_line().map_err(io_error(path))? {
        number += 1;
        let is_comment = line.trim_start().starts_with(['#', '/']);
        let words = words(line.trim_start_matches(['\u{feff}', '#', '/', ' ', '\t']));
        if words.is_empty() {
            continue;
        }
        if first {
            if let Ok(named) = Columns::named(&words) {
                rows.set_columns(named);
                first = false;
                continue;
            }
            if let ([count], false) = (words.as_slice(), is_comment)
                && let Ok(count) = count.parse()
            {
                match layout {
                    TextLayout::Atoms | TextLayout::Vectors => return atoms(path, lines, count),
                    TextLayout::PointsThenNormals => {
                        let points = points_then_normals(path, lines, count)?;
                        return Ok((points, ModelMetadata::default()));
                    }
                    TextLayout::Scan => claimed = Some(count),
                }
                continue;
            }
            if words[0].eq_ignore_ascii_case("ncols") {
                let what = "is a grid of heights (ESRI ASCII), not a list of points";
                return Err(format(path, Reason::unsupported(what, "convert it to x,y,z")));
            }
        }
        if !is_comment {
            first = false;
            rows.push(number, &words)?;
        }
    }
    let points = rows.finish()?;
    check_count(path, claimed, points.len(), "points")?;
    Ok((points, ModelMetadata::default()))
}

/// Refuses a number of items that differs from the claimed number, if there is one.
fn check_count(
    path: &Path,
    claimed: Option<u64>,
    found: usize,
    what: &str,
) -> Result<(), PointsError> {
    match claimed {
        Some(claimed) if claimed != found as u64 => {
            let reason = Reason::truncated(format!(
                "claims {claimed} {what}, but has {found}: it is truncated or mislabelled"
            ));
            Err(format(path, reason))
        }
        _ => Ok(()),
    }
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

/// Reads atoms, after the line with their number.
fn atoms(
    path: &Path,
    mut lines: Lines<impl BufRead>,
    count: u64,
) -> Result<(Points, ModelMetadata), PointsError> {
    let line = lines.read_line().map_err(io_error(path))?.unwrap_or_default();
    let Comment { columns, cell } = Comment::read(path, &line)?;
    let metadata = ModelMetadata { cell, ..ModelMetadata::default() };
    let mut points = Points::default();
    let mut rows = columns.map(|columns| TextRows::new(path, Some(columns)));
    let mut number = 2;
    while let Some(line) = lines.read_line().map_err(io_error(path))? {
        number += 1;
        let words: Vec<&str> = line.split_whitespace().collect();
        if words.is_empty() {
            continue;
        }
        if let Some(rows) = &mut rows {
            rows.push(number, &words)?;
            continue;
        }
        let [_, x, y, z, ..] = words[..] else {
            let reason = Reason::value(format!("line {number} is not an element with x, y and z"));
            return Err(format(path, reason));
        };
        let axis = |axis: usize, word| finite(path, number, COLUMNS[axis], word);
        points.positions.push([axis(0, x)?, axis(1, y)?, axis(2, z)?]);
    }
    if let Some(rows) = rows {
        points = rows.finish()?;
    }
    check_count(path, Some(count), points.len(), "atoms")?;
    Ok((points, metadata))
}

/// Reads `count` points, and as many normals, if any, which are skipped.
fn points_then_normals(
    path: &Path,
    mut lines: Lines<impl BufRead>,
    count: u64,
) -> Result<Points, PointsError> {
    let mut points = Points::default();
    let (mut number, mut found) = (1, 0);
    while let Some(line) = lines.read_line().map_err(io_error(path))? {
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
