use std::collections::HashSet;
use std::io::Read;
use std::path::Path;

use walpha_base::shown::shown;

use super::content::Content;
use super::lines::{Numbered, words};
use super::off::position;
use super::text::text;
use super::{CellCount, Points, PointsError, format};
use walpha_volume::{OpenFile, Reason, io_error};

/// The number of bytes before the facets of a binary STL file: a header, and the number of facets.
const HEAD: u64 = 84;
/// The size of a facet in bytes: its normal, its corners, and two attribute bytes.
const FACET: u64 = 50;

/// Reads the vertices of an STL file, binary or text: the corners of its facets, each position once.
pub(crate) fn read(file: &OpenFile) -> Result<Points, PointsError> {
    let path = file.path();
    let Content { mut reader, length } = Content::of(file)?;
    let Some(count) = binary_facets(path, &mut reader, length)? else {
        return Ok(in_text(file)?.0);
    };
    let mut corners = Corners::default();
    let (mut facet, mut coloured) = ([0; FACET as usize], false);
    for _ in 0..count {
        reader.read_exact(&mut facet).map_err(io_error(path))?;
        let (numbers, attribute) = facet.as_chunks();
        coloured |= attribute != [0, 0];
        let numbers: Vec<f64> =
            numbers.iter().map(|&bytes| f64::from(f32::from_le_bytes(bytes))).collect();
        numbers[3..].as_chunks().0.iter().for_each(|&corner| corners.add(corner));
    }
    if coloured {
        tracing::warn!("{}: attributes of its facets (colours) are passed over", shown(path));
    }
    let mut behind = Vec::new();
    reader.read_to_end(&mut behind).map_err(io_error(path))?;
    if behind.iter().any(|byte| *byte != 0 && !byte.is_ascii_whitespace()) {
        let bytes = behind.len();
        tracing::warn!("{}: {bytes} bytes behind its facets are passed over", shown(path));
    }
    Ok(corners.points)
}

/// The number of facets of a binary file, whose head is read; `None` for text. A binary file may begin with `solid`, too: it is
/// recognised by its length, or by a byte 0, which no text contains.
fn binary_facets(
    path: &Path,
    reader: &mut impl Read,
    length: u64,
) -> Result<Option<u64>, PointsError> {
    let fail = |reason: Reason| format(path, reason);
    let mut head = Vec::new();
    reader.take(HEAD).read_to_end(&mut head).map_err(io_error(path))?;
    let count = head.last_chunk().map_or(0, |&count| u64::from(u32::from_le_bytes(count)));
    let needed = HEAD + FACET * count;
    let is_whole = head.len() as u64 == HEAD && length == needed;
    if !is_whole && begins_solid(&head) && !head.contains(&0) {
        return Ok(None);
    }
    let claim = format!("claims {count} facets, {needed} bytes, but has {length}");
    if (head.len() as u64) < HEAD || length < needed {
        let reason = Reason::claims_more(format!("{claim}: it is truncated, or not an STL file"));
        return Err(fail(reason));
    }
    let behind = length - needed;
    if behind >= FACET && (behind.is_multiple_of(FACET) || count == 0) {
        let what = format!("{claim}: more facets follow than it counts");
        return Err(fail(Reason::content(what, "write it again, with the right count")));
    }
    Ok(Some(count))
}

/// Whether bytes begin with the first word of text files, in any letter case.
fn begins_solid(head: &[u8]) -> bool {
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
}

/// The number of facets.
pub(crate) fn cells(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let Content { mut reader, length } = Content::of(file)?;
    if let Some(count) = binary_facets(file.path(), &mut reader, length)? {
        return Ok(vec![CellCount::new("facets", count as usize)]);
    }
    Ok(vec![CellCount::new("facets", in_text(file)?.1)])
}

/// Reads all solids of a text, and counts their facets. Ends of lines have no meaning, except that a name ends at the end of its
/// line or before the first facet.
fn in_text(file: &OpenFile) -> Result<(Points, usize), PointsError> {
    let (path, text) = (file.path(), text(file)?);
    let mut corners = Corners::default();
    let (mut is_open, mut facets, mut vertices) = (false, 0, 0);
    let mut words = words(Numbered::new(&text)).peekable();
    while let Some((line, word)) = words.next() {
        let is_normal = |(_, next): &(u64, &str)| next.eq_ignore_ascii_case("normal");
        match word.to_ascii_lowercase().as_str() {
            "facet" if words.next_if(is_normal).is_some() => {
                facets += 1;
                is_open = true;
            }
            "vertex" => {
                vertices += 1;
                corners.add(position(path, line, words.by_ref().map(|(_, word)| word))?);
            }
            keyword @ ("solid" | "endsolid") => {
                is_open = keyword == "solid";
                while words.peek().is_some_and(|(own, _)| *own == line) {
                    let mut ahead = words.clone();
                    let is_facet =
                        ahead.next().is_some_and(|(_, w)| w.eq_ignore_ascii_case("facet"));
                    if is_facet && ahead.next().as_ref().is_some_and(is_normal) {
                        break;
                    }
                    words.next();
                }
            }
            _ => {}
        }
    }
    if is_open {
        return Err(format(path, Reason::truncated("ends before endsolid: it is truncated")));
    }
    if vertices != 3 * facets {
        tracing::warn!(
            "{}: has {vertices} vertices in {facets} facets, which have 3 each; all vertices are read",
            shown(path)
        );
    }
    Ok((corners.points, facets))
}

/// Distinct positions, in order of first appearance.
#[derive(Default)]
struct Corners {
    points: Points,
    seen: HashSet<[u64; 3]>,
}

impl Corners {
    fn add(&mut self, corner: [f64; 3]) {
        // Adding 0 turns −0 into 0, which is the same position.
        if self.seen.insert(corner.map(|c| (c + 0.0).to_bits())) {
            self.points.positions.push(corner);
        }
    }
}
