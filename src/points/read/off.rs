use std::io::BufRead;
use std::path::Path;

use super::{COLUMNS, CellCount, Points, PointsError, format};
use crate::volume::{Lines, OpenFile, Reason, io_error};

/// Reads the vertices of an OFF file in text, with normals, colours or texture coordinates (NOFF, COFF,
/// STOFF) or without: the first three numbers of each line. There must be as many faces as it claims.
pub(crate) fn read(file: &OpenFile) -> Result<Points, PointsError> {
    let path = file.path();
    let fail = |reason: Reason| format(path, reason);
    let (mut rows, vertices, faces) = read_counts(file)?;
    let cut = || {
        fail(Reason::truncated(format!(
            "ends before its {vertices} vertices and {faces} faces: it is truncated"
        )))
    };
    let mut points = Points::default();
    for _ in 0..vertices {
        let line = rows.next(path)?.ok_or_else(cut)?;
        points.positions.push(position(path, rows.number, line.split_whitespace())?);
    }
    for _ in 0..faces {
        rows.next(path)?.ok_or_else(cut)?;
    }
    Ok(points)
}

/// The number of faces.
pub(crate) fn cells(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let faces = read_counts(file)?.2;
    Ok(vec![CellCount::new("faces", usize::try_from(faces).unwrap_or(usize::MAX))])
}

/// Reads the header of a file: the lines after it, and the numbers of vertices and faces that it claims.
fn read_counts(file: &OpenFile) -> Result<(ContentLines<impl BufRead>, u64, u64), PointsError> {
    let path = file.path();
    let fail = |reason: Reason| format(path, reason);
    let mut rows = ContentLines { lines: Lines::new(file.reader()?), number: 0 };
    let head = rows.next(path)?.unwrap_or_default();
    let mut words = head.split_whitespace().peekable();
    if let Some(kind) = words.next_if(|word| word.ends_with("OFF")) {
        let prefix = kind.trim_end_matches("OFF").replace("ST", "").replace(['C', 'N'], "");
        if !prefix.is_empty() {
            return Err(fail(Reason::unsupported(
                format!("is {kind}: only points of three coordinates are read"),
                "convert it first",
            )));
        }
    }
    if words.peek() == Some(&"BINARY") {
        return Err(fail(Reason::unsupported("is binary: OFF is read as text", "convert it")));
    }
    let mut counts: Vec<u64> = words.map_while(|word| word.parse().ok()).collect();
    if counts.is_empty() {
        let line = rows.next(path)?.unwrap_or_default();
        counts = line.split_whitespace().map_while(|word| word.parse().ok()).collect();
    }
    let [vertices, faces, ..] = counts[..] else {
        return Err(fail(Reason::damaged(
            "does not say how many vertices and faces it has: it is damaged",
        )));
    };
    Ok((rows, vertices, faces))
}

/// The first three words of a line, as coordinates.
pub(super) fn position<'a>(
    path: &Path,
    line: u64,
    mut words: impl Iterator<Item = &'a str>,
) -> Result<[f64; 3], PointsError> {
    let mut position = [0.0; 3];
    for (number, name) in position.iter_mut().zip(COLUMNS) {
        let word = words.next().unwrap_or_default();
        let read = word.parse().ok().filter(|number: &f64| number.is_finite());
        *number = read.ok_or_else(|| {
            format(
                path,
                Reason::value(format!(
                    "line {line}: {name} is {word:?}, which is not a finite number"
                )),
            )
        })?;
    }
    Ok(position)
}

/// Lines without comments and empty lines.
struct ContentLines<R> {
    lines: Lines<R>,
    number: u64,
}

impl<R: BufRead> ContentLines<R> {
    fn next(&mut self, path: &Path) -> Result<Option<String>, PointsError> {
        while let Some(line) = self.lines.read_line().map_err(io_error(path))? {
            self.number += 1;
            let text = line.split('#').next().unwrap_or_default().trim();
            if !text.is_empty() {
                return Ok(Some(text.to_owned()));
            }
        }
        Ok(None)
    }
}
