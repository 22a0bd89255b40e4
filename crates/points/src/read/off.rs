use std::iter::once;
use std::path::Path;

use super::dialect::number;
use super::lines::{Numbered, words};
use super::text::text;
use super::{COLUMNS, CellCount, Points, PointsError, format};
use walpha_volume::{OpenFile, Reason};

/// Reads the vertices of an OFF file in text, with normals, colours or texture coordinates (NOFF, COFF, STOFF) or without: the
/// first three numbers of each. There must be as many faces as the file claims. Ends of lines have no meaning, except that a
/// colour may follow a vertex or a face in its line.
pub(crate) fn read(file: &OpenFile) -> Result<Points, PointsError> {
    let path = file.path();
    let text = text(file)?;
    let header = header(&text).map_err(|reason| format(path, reason))?;
    let width = header.width().map_err(|reason| format(path, reason))?;
    let mut words = header.words;
    let mut points = Points::default();
    for _ in 0..header.vertices {
        let Some((line, first)) = words.next() else { break };
        let mut rest = words.by_ref().map(|(_, word)| word);
        points.positions.push(position(path, line, once(first).chain(rest.by_ref()))?);
        rest.take(width - 3).for_each(drop);
    }
    Ok(points)
}

/// The number of faces.
pub(crate) fn cells(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let text = text(file)?;
    let header = header(&text).map_err(|reason| format(file.path(), reason))?;
    Ok(vec![CellCount::new("faces", header.faces)])
}

/// The header of a file, and the words behind it.
struct Header<W> {
    vertices: usize,
    faces: usize,
    /// The number of numbers of a vertex, without those of a colour.
    base: usize,
    /// Whether each vertex has a colour.
    coloured: bool,
    /// The words after the header, each with its line.
    words: W,
}

/// Reads the kind, which may have a count directly behind it, and the counts. The count of edges may be left out.
fn header(text: &str) -> Result<Header<impl Iterator<Item = (u64, &str)> + Clone>, Reason> {
    let contents = Numbered::new(text)
        .map(|(number, line)| (number, line.split('#').next().unwrap_or_default()));
    let mut words = words(contents).peekable();
    let (mut base, mut coloured, mut glued) = (3, false, None);
    let kind = words.peek().map(|&(_, word)| word).unwrap_or_default();
    if let Some(end) = kind.to_ascii_uppercase().find("OFF") {
        let (letters, count) = (&kind[..end], &kind[end + "OFF".len()..]);
        let line = words.next().map_or(0, |(line, _)| line);
        glued = Some((line, count)).filter(|_| !count.is_empty());
        if words.peek().is_some_and(|&(_, word)| word == "BINARY") {
            return Err(Reason::unsupported("is binary: OFF is read as text", "convert it"));
        }
        let dimension = if letters.contains('n') { words.next() } else { None };
        if letters.contains('4') || dimension.is_some_and(|(_, dimension)| dimension != "3") {
            let what = format!("is {kind}: only points of three coordinates are read");
            return Err(Reason::unsupported(what, "convert it first"));
        }
        coloured = letters.contains('C');
        base += 3 * usize::from(letters.contains('N')) + 2 * usize::from(letters.contains("ST"));
    }
    let mut count = || {
        let (line, word) = glued.take().or_else(|| words.next())?;
        Some((line, word.parse::<usize>().ok()?))
    };
    let (Some((_, vertices)), Some((line, faces))) = (count(), count()) else {
        let what = "does not say how many vertices and faces it has";
        return Err(Reason::content(what, "begin it with OFF, and a line with these counts"));
    };
    // The count of edges is beside the other counts or alone in a line.
    let mut ahead = words.clone();
    if let Some((own, word)) = ahead.next()
        && word.parse::<u64>().is_ok()
        && (own == line || ahead.next().is_none_or(|(next, _)| next != own))
    {
        words.next();
    }
    Ok(Header { vertices, faces, base, coloured, words })
}

impl<'a, W: Iterator<Item = (u64, &'a str)> + Clone> Header<W> {
    /// The number of numbers of a vertex: that of its line, if all vertices and faces are in separate lines, or else the one of
    /// the kind. The error says how the words differ from the counts.
    fn width(&self) -> Result<usize, Reason> {
        let (base, coloured) = (self.base, [self.base + 3, self.base + 4]);
        let Some((line, _, found)) = self.lines().next() else {
            return self.holds(base).map(|()| base);
        };
        let is_known = found == 3 || found == base || coloured.contains(&found);
        if is_known && self.is_in_lines(found) {
            return Ok(found);
        }
        let free = if self.coloured { &coloured[..] } else { &[base] };
        if let Some(&width) = free.iter().find(|&&width| self.holds(width).is_ok()) {
            return Ok(width);
        }
        let are_alike = self.lines().take(self.vertices).all(|(.., own)| own == found);
        if are_alike && !is_known {
            let [least, most] = coloured;
            let what = format!(
                "has {found} numbers in line {line}, where a vertex has {base}, or {least} or {most} with a colour"
            );
            return Err(Reason::value(what));
        }
        let width = if are_alike { found } else { free[0] };
        self.holds(width).map(|()| width)
    }

    /// The lines: the number of each, its first word, and the number of its words.
    fn lines(&self) -> impl Iterator<Item = (u64, &'a str, usize)> {
        let mut words = self.words.clone().peekable();
        std::iter::from_fn(move || {
            let (line, first) = words.next()?;
            let mut count = 1;
            while words.next_if(|(own, _)| *own == line).is_some() {
                count += 1;
            }
            Some((line, first, count))
        })
    }

    /// Whether there is a line of `width` numbers for each vertex, and a line for each face, with a number of corners, these
    /// corners, and perhaps a colour.
    fn is_in_lines(&self, width: usize) -> bool {
        let (mut lines, vertices, faces) = (self.lines(), self.vertices, self.faces);
        let is_face = |corners: &str, found: usize| corners.parse().is_ok_and(|n: usize| n < found);
        lines.by_ref().take(vertices).filter(|&(.., found)| found == width).count() == vertices
            && lines.by_ref().take(faces).filter(|&(_, n, found)| is_face(n, found)).count()
                == faces
            && lines.next().is_none()
    }

    /// Compares the words with those of vertices with `width` numbers, and of faces without colours.
    fn holds(&self, width: usize) -> Result<(), Reason> {
        let Self { vertices, faces, .. } = *self;
        let cut = || {
            Reason::claims_more(format!(
                "ends before its {vertices} vertices and {faces} faces: it is truncated, or a count is wrong"
            ))
        };
        let mut words = self.words.clone();
        let numbers = vertices.saturating_mul(width);
        if words.by_ref().take(numbers).count() < numbers {
            return Err(cut());
        }
        for _ in 0..faces {
            let (line, word) = words.next().ok_or_else(cut)?;
            let corners = word.parse::<usize>().map_err(|_| {
                Reason::value(format!(
                    "line {line}: {word:?} is not the number of corners of a face"
                ))
            })?;
            if words.by_ref().take(corners).count() < corners {
                return Err(cut());
            }
        }
        let Some((line, _)) = words.next() else { return Ok(()) };
        let what =
            format!("goes on in line {line}, behind its {vertices} vertices and {faces} faces");
        Err(Reason::content(what, "correct its counts, or remove what follows"))
    }
}

/// Converts the first three words of a line to coordinates.
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
