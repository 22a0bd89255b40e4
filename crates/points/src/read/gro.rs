//! GRO: molecules of GROMACS, in lines of fixed columns, in nanometres (GROMACS reference manual, "gro file format").

use std::path::Path;

use super::text::text;
use super::{COLUMNS, Points, PointsError, first_frame, format};
use crate::molecule::{Atom, Element, Found};
use crate::{Cell, ModelMetadata, PointOptions};
use walpha_volume::{OpenFile, Reason};

/// Columns of the number and name of a residue, of the name and number of an atom, and the first of the coordinates.
const RESIDUE_NUMBER: std::ops::Range<usize> = 0..5;
const RESIDUE: std::ops::Range<usize> = 5..10;
const NAME: std::ops::Range<usize> = 10..15;
const PLACE: usize = 20;

/// What to do about a line that is wrong.
const NEXT: &str = "correct it, or write the file anew, as `gmx editconf` does";

/// Reads the atoms of a frame and its box. Places are made ångströms, exactly as decimals. Velocities are passed by.
///
/// # Errors
/// A line is too short, or has text in place of a number; the file ends early.
pub(crate) fn read(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let text = text(file)?;
    let frames = frames(path, &text)?;
    let Frame { rows, cell } = frames[first_frame(path, frames.len(), options.frame)?];
    let mut found = Found::default();
    let lines = (rows.line..).zip(rows.text.lines());
    for (number, line) in lines {
        atom(path, number, line, &mut found)?;
    }
    found.cell = cell;
    found.select(path, &options.atoms, options)
}

/// A part of a text, and the number of its first line.
#[derive(Clone, Copy)]
struct Part<'a> {
    line: u64,
    text: &'a str,
}

/// The lines of atoms, and the box.
#[derive(Clone, Copy)]
struct Frame<'a> {
    rows: Part<'a>,
    cell: Option<Cell>,
}

/// Divides a text into its frames: a title, the number of atoms, their lines, and the box.
fn frames<'a>(path: &Path, text: &'a str) -> Result<Vec<Frame<'a>>, PointsError> {
    let mut rest = Part { line: 1, text };
    let mut frames = Vec::new();
    while frames.is_empty() || !rest.text.trim().is_empty() {
        let first = rest.line;
        let title = take(&mut rest, 1);
        let count = take(&mut rest, 1).and_then(|count| count.text.trim().parse::<u64>().ok());
        let (Some(_), Some(count)) = (title, count) else {
            let what = format!(
                "has no number of atoms in line {}, behind the title that GRO begins with",
                first + 1
            );
            return Err(format(path, Reason::other(what)));
        };
        let (Some(rows), Some(edges)) = (take(&mut rest, count), take(&mut rest, 1)) else {
            let what = format!(
                "claims {count} atoms and a box in line {}, and ends before these: it is truncated",
                first + 1
            );
            return Err(format(path, Reason::claims_more(what)));
        };
        if count == 0 {
            let what = format!("claims 0 atoms in line {}", first + 1);
            return Err(format(path, Reason::content(what, "name another file")));
        }
        frames.push(Frame { rows, cell: box_of(path, edges)? });
    }
    Ok(frames)
}

/// Takes as many lines from a text; `None` if there are fewer.
fn take<'a>(rest: &mut Part<'a>, count: u64) -> Option<Part<'a>> {
    let mut end = 0;
    for _ in 0..count {
        if end >= rest.text.len() {
            return None;
        }
        end += rest.text[end..].find('\n').map_or(rest.text.len() - end, |at| at + 1);
    }
    let taken = Part { line: rest.line, text: &rest.text[..end] };
    *rest = Part { line: rest.line + count, text: &rest.text[end..] };
    Some(taken)
}

fn wrong(path: &Path, number: u64, what: &str) -> PointsError {
    format(path, Reason::content(format!("line {number} {what}"), NEXT))
}

fn atom(path: &Path, number: u64, line: &str, found: &mut Found) -> Result<(), PointsError> {
    let wrong = |what: &str| wrong(path, number, what);
    if !line.is_ascii() || line.contains('\t') {
        return Err(wrong("has a tab or a character that is not ASCII, and columns are counted"));
    }
    // Numbers have as many columns as there are from one decimal point to the next.
    let places = line.get(PLACE..).unwrap_or_default();
    let mut points = places.match_indices('.').map(|(at, _)| at);
    let (Some(first), Some(second)) = (points.next(), points.next()) else {
        return Err(wrong("has no two numbers with decimal points from column 21 on"));
    };
    let width = second - first;
    let mut position = [0.0; 3];
    for (k, x) in position.iter_mut().enumerate() {
        let text = places.get(k * width..(k + 1) * width).unwrap_or_default().trim();
        *x = angstroms(text).ok_or_else(|| {
            wrong(&format!(
                "has {text:?} as {}, in columns {} to {}, which is not a number",
                COLUMNS[k],
                PLACE + k * width + 1,
                PLACE + (k + 1) * width
            ))
        })?;
    }
    let of_residue = line[RESIDUE_NUMBER].trim();
    let Ok(of_residue) = (match of_residue {
        "" => Ok(None),
        text => text.parse().map(Some),
    }) else {
        return Err(wrong(&format!("has {of_residue:?} as the number of a residue")));
    };
    let (residue, name) = (line[RESIDUE].trim(), line[NAME].trim());
    let atom = Atom {
        element: Element::of_name(name, None, residue),
        name: found.name(name),
        residue: found.name(residue),
        number: of_residue,
        model: 1,
        ..Atom::default()
    };
    Ok(found.push(position, atom)?)
}

/// The number of ångströms of a decimal number of nanometres: the double next to it, which ten times the double next to the number
/// need not be.
fn angstroms(text: &str) -> Option<f64> {
    let is_decimal = text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.".contains(&byte));
    if !is_decimal || text.is_empty() {
        return None;
    }
    format!("{text}e1").parse().ok().filter(|number: &f64| number.is_finite())
}

/// The box: lengths along the axes, and for one that is not along them the other six coordinates of its vectors. It does not
/// repeat along vectors of 0; `None` where all are, as without a box.
fn box_of(path: &Path, edges: Part<'_>) -> Result<Option<Cell>, PointsError> {
    let numbers: Option<Vec<f64>> = edges.text.split_whitespace().map(angstroms).collect();
    let vectors = match numbers.as_deref() {
        Some(&[x, y, z]) => [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]],
        Some(&[ax, by, cz, ay, az, bx, bz, cx, cy]) => [[ax, ay, az], [bx, by, bz], [cx, cy, cz]],
        _ => {
            let text: String = edges.text.trim().chars().take(60).collect();
            let what = format!("has {text:?} as the box, which is not three or nine numbers");
            return Err(wrong(path, edges.line, &what));
        }
    };
    let repeats = vectors.map(|vector| vector != [0.0; 3]);
    Ok(repeats.contains(&true).then_some(Cell { vectors, repeats }))
}
