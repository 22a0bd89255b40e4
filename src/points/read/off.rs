use std::path::Path;

use super::dialect::number;
use super::lines::Numbered;
use super::text::text;
use super::{COLUMNS, CellCount, Points, PointsError, format};
use crate::volume::{OpenFile, Reason};

/// Reads the vertices of an OFF file in text, with normals, colours or texture coordinates (NOFF, COFF,
/// STOFF) or without: the first three numbers of each line. There must be as many faces as it claims.
pub(crate) fn read(file: &OpenFile) -> Result<Points, PointsError> {
    let path = file.path();
    let fail = |reason: Reason| format(path, reason);
    let text = text(file)?;
    let (mut rows, vertices, faces) = read_counts(path, &text)?;
    let cut = || {
        fail(Reason::claims_more(format!(
            "ends before its {vertices} vertices and {faces} faces: it is truncated, or a count is wrong"
        )))
    };
    let mut points = Points::default();
    for _ in 0..vertices {
        let (number, line) = rows.next().ok_or_else(cut)?;
        points.positions.push(position(path, number, line.split_whitespace())?);
    }
    for _ in 0..faces {
        rows.next().ok_or_else(cut)?;
    }
    match rows.next() {
        None => Ok(points),
        Some((line, _)) => {
            let what =
                format!("goes on in line {line}, behind its {vertices} vertices and {faces} faces");
            Err(fail(Reason::content(what, "correct its counts, or remove what follows")))
        }
    }
}

/// The number of faces.
pub(crate) fn cells(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let faces = read_counts(file.path(), &text(file)?)?.2;
    Ok(vec![CellCount::new("faces", usize::try_from(faces).unwrap_or(usize::MAX))])
}

/// Reads the header of a file: the lines after it, and the numbers of vertices and faces that it claims.
fn read_counts<'a>(
    path: &Path,
    text: &'a str,
) -> Result<(impl Iterator<Item = (u64, &'a str)> + use<'a>, u64, u64), PointsError> {
    let fail = |reason: Reason| format(path, reason);
    let mut rows = Numbered::new(text).filter_map(|(number, line)| {
        let content = line.split('#').next().unwrap_or_default().trim();
        (!content.is_empty()).then_some((number, content))
    });
    let mut words =
        rows.next().map(|(_, line)| line).unwrap_or_default().split_whitespace().peekable();
    let mut dimension = None;
    if let Some(kind) = words.next_if(|word| word.to_ascii_uppercase().ends_with("OFF")) {
        let prefix = kind[..kind.len() - "OFF".len()].replace("ST", "").replace(['C', 'N'], "");
        if words.next_if_eq(&"BINARY").is_some() {
            let what = "is binary: OFF is read as text";
            return Err(fail(Reason::unsupported(what, "convert it")));
        }
        if prefix.contains('n') {
            dimension = words.next();
            if dimension.is_none() {
                dimension = rows.next().map(|(_, line)| line);
            }
        }
        if prefix.contains('4') || dimension.is_some_and(|dimension| dimension.trim() != "3") {
            return Err(fail(Reason::unsupported(
                format!("is {kind}: only points of three coordinates are read"),
                "convert it first",
            )));
        }
    }
    let mut counts: Vec<u64> = words.map_while(|word| word.parse().ok()).collect();
    if counts.is_empty() {
        let line = rows.next().map(|(_, line)| line).unwrap_or_default();
        counts = line.split_whitespace().map_while(|word| word.parse().ok()).collect();
    }
    let [vertices, faces, ..] = counts[..] else {
        let what = "does not say how many vertices and faces it has";
        return Err(fail(Reason::content(what, "begin it with OFF, and a line with these counts")));
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
    for (place, name) in position.iter_mut().zip(COLUMNS) {
        let word = words.next().unwrap_or_default();
        let read = number(word, false).filter(|number| number.is_finite());
        *place = read.ok_or_else(|| {
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
