use std::borrow::Cow;

use walpha_base::shown::shown;

use super::lines::Numbered;
use super::off::position;
use super::text::text;
use super::{CellCount, Points, PointsError};
use walpha_volume::OpenFile;

/// Reads the vertices (`v x y z …`) of a Wavefront OBJ file; everything else is skipped. A fourth number is the weight of a
/// rational curve, and not a divisor (OBJ specification, B1-15); six numbers are a position and a colour.
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

/// The lines without comments. A line that ends with a backslash is joined with the next.
fn statements(text: &str) -> impl Iterator<Item = (u64, Cow<'_, str>)> {
    let mut lines = Numbered::new(text);
    std::iter::from_fn(move || {
        let (number, line) = lines.next()?;
        let (begun, mut goes_on) = content(line);
        let mut statement = Cow::Borrowed(begun);
        while goes_on {
            let Some((_, line)) = lines.next() else { break };
            let next;
            (next, goes_on) = content(line);
            statement = format!("{statement} {next}").into();
        }
        Some((number, statement))
    })
}

/// A line without its comment, or without the backslash that continues it, and whether it is continued. A `#` begins a comment at
/// the start of a word; a backslash in a comment does not continue the line.
fn content(line: &str) -> (&str, bool) {
    let begins = |&(at, _): &(usize, &str)| at == 0 || line[..at].ends_with([' ', '\t']);
    match line.match_indices('#').find(begins) {
        Some((at, _)) => (&line[..at], false),
        None => match line.trim_end().strip_suffix('\\') {
            Some(begun) => (begun, true),
            None => (line, false),
        },
    }
}
