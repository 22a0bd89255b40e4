use std::borrow::Cow;

use walpha_base::shown::shown;

use super::lines::Numbered;
use super::off::position;
use super::text::text;
use super::{CellCount, Points, PointsError};
use crate::volume::OpenFile;

/// Reads the vertices (`v x y z …`) of a Wavefront OBJ file; everything else is skipped. A fourth number is the weight of a
/// rational curve, and no divisor (OBJ specification, B1-15); six numbers are a place and a colour.
pub(crate) fn read(file: &OpenFile) -> Result<Points, PointsError> {
    let (path, text) = (file.path(), text(file)?);
    let mut points = Points::default();
    let mut weighted = 0;
    for (number, line) in statements(&text) {
        let mut words = line.split_whitespace();
        if words.next() == Some("v") {
            let (w, others) = (words.clone().nth(3), words.clone().count());
            weighted += usize::from(others == 4 && w.and_then(|w| w.parse().ok()) != Some(1.0));
            points.positions.push(position(path, number, words)?);
        }
    }
    if weighted > 0 {
        tracing::warn!(
            "{}: {weighted} vertices have a weight w for rational curves, which is passed over: x, y and z are not \
             divided by it",
            shown(path)
        );
    }
    Ok(points)
}

/// The numbers of faces and lines.
pub(crate) fn cells(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let mut counts = [CellCount::new("faces", 0), CellCount::new("lines", 0)];
    for (_, line) in statements(&text(file)?) {
        match line.split_whitespace().next() {
            Some("f") => counts[0].count += 1,
            Some("l") => counts[1].count += 1,
            _ => {}
        }
    }
    Ok(counts.into())
}

/// Lines, with those that a backslash at their end continues.
fn statements(text: &str) -> impl Iterator<Item = (u64, Cow<'_, str>)> {
    let mut lines = Numbered::new(text);
    std::iter::from_fn(move || {
        let (number, line) = lines.next()?;
        let mut line = Cow::Borrowed(line);
        while let Some(begun) = line.trim_end().strip_suffix('\\') {
            let next = lines.next().map(|(_, next)| next).unwrap_or_default();
            line = format!("{begun} {next}").into();
        }
        Some((number, line))
    })
}
