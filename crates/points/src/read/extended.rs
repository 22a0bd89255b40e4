//! The second line of extended XYZ, which gives the columns and the unit cell of periodic points.

use std::path::Path;

use super::{COLUMNS, Columns, PointsError, format};
use crate::Cell;
use walpha_volume::Reason;

/// The content of the line.
#[derive(Default)]
pub(super) struct Comment {
    /// The columns from `Properties=species:S:1:pos:R:3:…`.
    pub columns: Option<Columns>,
    /// The column of `species:S:1` among these, or of the atomic numbers `Z:I:1`.
    pub species: Option<usize>,
    /// The cell from `Lattice="…"`, unless `pbc` states that the points do not repeat.
    pub cell: Option<Cell>,
}

impl Comment {
    /// Reads the pairs of a line; the rest of the line is a free-form title.
    pub(super) fn read(path: &Path, line: &str) -> Result<Self, PointsError> {
        let mut comment = Self::default();
        let mut repeats = [true; 3];
        for (key, value) in pairs(line) {
            match key.to_ascii_lowercase().as_str() {
                "properties" => {
                    let (columns, species) = columns(path, value)?;
                    (comment.columns, comment.species) = (Some(columns), species);
                }
                "lattice" if comment.cell.is_some() => {
                    return Err(format(path, Reason::content("has Lattice twice", "remove one")));
                }
                "lattice" => comment.cell = Some(cell(path, value)?),
                "pbc" => {
                    repeats = directions(value).ok_or_else(|| {
                        let what = format!("has pbc=\"{value}\", which is not three times T or F");
                        format(path, Reason::content(what, "correct its second line"))
                    })?;
                }
                _ => {}
            }
        }
        // Along vectors that are 0 nothing repeats, as in a cluster or a slab.
        comment.cell = comment.cell.map(|cell| Cell {
            repeats: [0, 1, 2].map(|k| repeats[k] && cell.vectors[k] != [0.0; 3]),
            ..cell
        });
        comment.cell.take_if(|cell| cell.repeats == [false; 3]);
        Ok(comment)
    }
}

/// The pairs `key=value` of a line. Values with white space are in quotes, braces or brackets.
fn pairs(line: &str) -> Vec<(&str, &str)> {
    let mut pairs = Vec::new();
    let mut rest = line;
    while let Some((before, behind)) = rest.split_once('=') {
        let key = before.split_whitespace().next_back().unwrap_or_default();
        let behind = behind.trim_start();
        let close = match behind.chars().next() {
            Some('"') => Some('"'),
            Some('\'') => Some('\''),
            Some('{') => Some('}'),
            Some('[') => Some(']'),
            _ => None,
        };
        let (value, next) = match close {
            Some(close) => behind[1..].split_once(close).unwrap_or((&behind[1..], "")),
            None => behind.split_once(char::is_whitespace).unwrap_or((behind, "")),
        };
        pairs.push((key, value));
        rest = next;
    }
    pairs
}

/// The columns, from properties that each have a name, a type and a number of columns; and which of them has species.
fn columns(path: &Path, text: &str) -> Result<(Columns, Option<usize>), PointsError> {
    let wrong = |what: &str| {
        let what = format!("has Properties={text}, {what}");
        Err(format(path, Reason::content(what, "correct its second line")))
    };
    let words: Vec<&str> = text.split(':').collect();
    let (properties, []) = words.as_chunks::<3>() else {
        return wrong("which are not names, types and numbers");
    };
    let (mut columns, mut names, mut species) = (Vec::new(), Vec::new(), None);
    for [name, kind, count] in properties {
        let Some(count) = count.parse().ok().filter(|count| (1..=1 << 10).contains(count)) else {
            return wrong("which are not names, types and numbers");
        };
        let known = COLUMNS[3..].iter().position(|column| column.eq_ignore_ascii_case(name));
        match (name.to_ascii_lowercase().as_str(), known, count) {
            ("pos", _, 3) => columns.extend([Some(0), Some(1), Some(2)]),
            (_, Some(place), 1) => columns.push(Some(3 + place)),
            ("species", _, 1) => {
                species = Some(columns.len());
                columns.push(None);
            }
            // Atomic numbers.
            ("z", _, 1) if *kind == "I" => {
                species = species.or(Some(columns.len()));
                columns.push(None);
            }
            _ => columns.extend(std::iter::repeat_n(None, count)),
        }
        let own = |k: usize| if count == 1 { (*name).to_owned() } else { format!("{name}_{k}") };
        names.extend((0..count).map(own));
    }
    let times = |place| columns.iter().filter(|&&column| column == Some(place)).count();
    if times(0) != 1 || (3..COLUMNS.len()).any(|place| times(place) > 1) {
        return wrong("without pos:R:3, or with something twice");
    }
    Ok((Columns { places: columns, names }, species))
}

fn cell(path: &Path, text: &str) -> Result<Cell, PointsError> {
    let numbers: Vec<f64> =
        text.split([' ', '\t', ',']).filter_map(|word| word.parse().ok()).collect();
    match numbers.as_chunks() {
        (&[a, b, c], []) if numbers.iter().all(|number| number.is_finite()) => {
            Ok(Cell { vectors: [a, b, c], repeats: [true; 3] })
        }
        _ => {
            let what = format!("has Lattice=\"{text}\", which is not nine numbers");
            Err(format(path, Reason::content(what, "correct its second line")))
        }
    }
}

/// Whether the points repeat along each vector of the cell: T or F, or 1 or 0, of each or once for all.
fn directions(text: &str) -> Option<[bool; 3]> {
    let yes = |word: &str| match word.to_ascii_lowercase().as_str() {
        "t" | "true" | "1" => Some(true),
        "f" | "false" | "0" => Some(false),
        _ => None,
    };
    let words = text.split([' ', '\t', ',', '[', ']']).filter(|word| !word.is_empty());
    match words.map(yes).collect::<Option<Vec<bool>>>()?[..] {
        [all] => Some([all; 3]),
        [a, b, c] => Some([a, b, c]),
        _ => None,
    }
}
