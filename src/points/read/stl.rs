use std::collections::HashSet;
use std::io::Read;

use super::off::position;
use super::{CellCount, Points, PointsError, format};
use crate::volume::{Lines, OpenFile, Reason, io_error};

/// Bytes before the facets of a binary STL file: a header, and the number of facets.
const HEAD: u64 = 84;
/// Bytes of a facet: its normal, its corners, and two attribute bytes.
const FACET: u64 = 50;

/// Reads the vertices of an STL file, binary or text: the corners of its facets, each position once.
pub(crate) fn read(file: &OpenFile) -> Result<Points, PointsError> {
    let (path, length) = (file.path(), file.length());
    let mut reader = file.reader()?;
    let mut head = Vec::new();
    (&mut reader).take(HEAD).read_to_end(&mut head).map_err(io_error(path))?;
    let count = head.last_chunk().map_or(0, |&count| u64::from(u32::from_le_bytes(count)));
    if is_text(&head, length, count) {
        return text(file);
    }
    if (head.len() as u64) < HEAD || length < HEAD + FACET * count {
        let reason = Reason::truncated(format!(
            "claims {count} facets, which {length} bytes cannot hold: it is truncated"
        ));
        return Err(format(path, reason));
    }
    let mut corners = Corners::default();
    let mut facet = [0; FACET as usize];
    for _ in 0..count {
        reader.read_exact(&mut facet).map_err(io_error(path))?;
        let (numbers, _) = facet.as_chunks();
        let numbers: Vec<f64> =
            numbers.iter().map(|&bytes| f64::from(f32::from_le_bytes(bytes))).collect();
        numbers[3..].as_chunks().0.iter().for_each(|&corner| corners.add(corner));
    }
    Ok(corners.points)
}

/// Whether a file is text. Binary files may begin with `solid` too, so their length decides.
fn is_text(head: &[u8], length: u64, count: u64) -> bool {
    head.starts_with(b"solid") && length != HEAD + FACET * count
}

/// The number of facets.
pub(crate) fn cells(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let (path, length) = (file.path(), file.length());
    let mut head = Vec::new();
    file.reader()?.take(HEAD).read_to_end(&mut head).map_err(io_error(path))?;
    let mut count = head.last_chunk().map_or(0, |&count| u64::from(u32::from_le_bytes(count)));
    if is_text(&head, length, count) {
        let mut lines = Lines::new(file.reader()?);
        count = 0;
        while let Some(line) = lines.read_line().map_err(io_error(path))? {
            count += u64::from(line.split_whitespace().next() == Some("facet"));
        }
    }
    Ok(vec![CellCount::new("facets", count as usize)])
}

fn text(file: &OpenFile) -> Result<Points, PointsError> {
    let path = file.path();
    let mut lines = Lines::new(file.reader()?);
    let mut corners = Corners::default();
    let (mut number, mut ended) = (0, false);
    while let Some(line) = lines.read_line().map_err(io_error(path))? {
        number += 1;
        let mut words = line.split_whitespace();
        match words.next() {
            Some("vertex") => corners.add(position(path, number, words)?),
            Some("endsolid") => ended = true,
            _ => {}
        }
    }
    if ended {
        Ok(corners.points)
    } else {
        Err(format(path, Reason::truncated("ends without endsolid: it is truncated")))
    }
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
