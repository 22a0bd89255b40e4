use std::io::Read;
use std::ops::Range;
use std::path::Path;

use super::{Points, PointsError, RADIUS, format, take_radii};
use crate::volume::{Lines, OpenFile, Reason, io_error};

/// Reads PCD, the Point Cloud Library's format: text, binary or compressed, with the fields x, y and z,
/// optionally weight or radius, and value or else intensity. Points without a position (NaN, as scanners write them)
/// are left out.
pub(crate) fn read(file: &OpenFile) -> Result<Points, PointsError> {
    let path = file.path();
    let fail = |reason: Reason| format(path, reason);
    let mut lines = Lines::new(file.reader()?);
    let mut header = Header::default();
    let data = loop {
        let line = lines.read_line().map_err(io_error(path))?;
        let line = line.ok_or_else(|| {
            fail(Reason::truncated("ends inside its PCD header: it is truncated"))
        })?;
        if let Some(data) = line.strip_prefix("DATA ") {
            break data.trim().to_owned();
        }
        header.parse_line(&line).map_err(fail)?;
    };
    header.check(file.length()).map_err(fail)?;
    let mut bytes = Vec::new();
    lines.into_inner().read_to_end(&mut bytes).map_err(io_error(path))?;
    let rows = match data.as_str() {
        "ascii" => header.text(&String::from_utf8_lossy(&bytes)),
        "binary" => header.binary(&bytes, false),
        "binary_compressed" => unpacked(&bytes).and_then(|bytes| header.binary(&bytes, true)),
        other => Err(Reason::unsupported(
            format!("has DATA {other}: ascii, binary and binary_compressed are read"),
            "convert it first",
        )),
    };
    header.points(path, &rows.map_err(fail)?)
}

#[derive(Default)]
struct Header {
    names: Vec<String>,
    sizes: Vec<usize>,
    types: Vec<String>,
    /// How many numbers each field has.
    counts: Vec<usize>,
    points: usize,
}

/// A column to read: its index in the lists of the header, and its offset within a point, in numbers or bytes.
struct Field {
    index: usize,
    offset: usize,
}

impl Header {
    fn parse_line(&mut self, line: &str) -> Result<(), Reason> {
        let damaged =
            || Reason::header(format!("has a header line {line:?}, which is not understood"));
        let mut words = line.split_whitespace();
        let key = words.next().unwrap_or("#");
        let numbers = || words.clone().map(str::parse).collect::<Result<Vec<usize>, _>>();
        match key {
            "FIELDS" => self.names = words.map(str::to_ascii_lowercase).collect(),
            "TYPE" => self.types = words.map(str::to_owned).collect(),
            "SIZE" => self.sizes = numbers().map_err(|_| damaged())?,
            "COUNT" => self.counts = numbers().map_err(|_| damaged())?,
            "POINTS" => {
                self.points = words.next().and_then(|n| n.parse().ok()).ok_or_else(damaged)?;
            }
            _ => {}
        }
        Ok(())
    }

    /// Refuses lists of different lengths, empty or huge fields, and more points than the file can hold.
    fn check(&mut self, length: u64) -> Result<(), Reason> {
        let fields = self.names.len();
        if self.counts.is_empty() {
            self.counts = vec![1; fields];
        }
        if [self.sizes.len(), self.types.len(), self.counts.len()] != [fields; 3] || fields == 0 {
            return Err(Reason::damaged(
                "has FIELDS, SIZE, TYPE and COUNT of different lengths: it is damaged",
            ));
        }
        if self.sizes.iter().chain(&self.counts).any(|n| !(1..=1 << 16).contains(n)) {
            return Err(Reason::damaged(
                "has fields of no bytes or numbers, or of more than 65536: it is damaged",
            ));
        }
        // A point takes at least a byte, and LZF packs at most 264 bytes into 3, so 256 points per byte is generous.
        if self.points as u64 > length.saturating_mul(256) {
            let points = self.points;
            return Err(Reason::header(format!(
                "claims {points} points, which {length} bytes cannot hold"
            )));
        }
        Ok(())
    }

    /// The field with a name; its offset is in bytes, or else in numbers.
    fn field(&self, name: &str, bytes: bool) -> Option<Field> {
        let index = self.names.iter().position(|known| known == name)?;
        Some(Field { index, offset: self.width(0..index, bytes) })
    }

    /// The bytes, or else the numbers, of some fields of a point; the largest `usize` where they are more, as they may be in 32 bits.
    fn width(&self, fields: Range<usize>, bytes: bool) -> usize {
        let width = |k: usize| self.counts[k].saturating_mul(if bytes { self.sizes[k] } else { 1 });
        fields.map(width).fold(0, usize::saturating_add)
    }

    /// The fields x, y, z, weight, value and radius.
    fn fields(&self, bytes: bool) -> Result<[Option<Field>; 6], Reason> {
        let field = |name| self.field(name, bytes);
        let fields = [
            field("x"),
            field("y"),
            field("z"),
            field("weight"),
            field("value").or(field("intensity")),
            field("radius"),
        ];
        if fields[..3].iter().all(Option::is_some) {
            Ok(fields)
        } else {
            Err(Reason::header(format!(
                "has the fields {}, without x, y or z",
                self.names.join(", ")
            )))
        }
    }

    fn text(&self, text: &str) -> Result<Vec<[Option<f64>; 6]>, Reason> {
        let fields = self.fields(false)?;
        let width = self.width(0..self.counts.len(), false);
        let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
        if lines.len() != self.points {
            return Err(Reason::header(format!(
                "claims {} points, but has {} lines",
                self.points,
                lines.len()
            )));
        }
        let mut rows = Vec::new();
        for line in lines {
            let words: Vec<&str> = line.split_whitespace().collect();
            if words.len() != width {
                return Err(Reason::header(format!(
                    "has {} numbers in the line {line:?}, not {width}",
                    words.len()
                )));
            }
            let mut row = [None; 6];
            for (slot, field) in row.iter_mut().zip(&fields) {
                let Some(field) = field else { continue };
                let word = words[field.offset];
                *slot =
                    Some(word.parse().map_err(|_| {
                        Reason::value(format!("has {word:?}, which is not a number"))
                    })?);
            }
            rows.push(row);
        }
        Ok(rows)
    }

    /// Reads binary data, stored point by point, or field by field.
    fn binary(&self, bytes: &[u8], by_field: bool) -> Result<Vec<[Option<f64>; 6]>, Reason> {
        let fields = self.fields(true)?;
        let width = self.width(0..self.counts.len(), true);
        if bytes.len() < width.saturating_mul(self.points) {
            let points = self.points;
            return Err(Reason::header(format!(
                "claims {points} points of {width} bytes, and has {}",
                bytes.len()
            )));
        }
        let at = |row: usize, field: &Field| {
            let own = self.sizes[field.index] * self.counts[field.index];
            let start = if by_field {
                self.points * field.offset + row * own
            } else {
                row * width + field.offset
            };
            let kind = self.types[field.index].as_str();
            number(kind, &bytes[start..start + self.sizes[field.index]])
        };
        let row = |row: usize| {
            let mut numbers = [None; 6];
            for (slot, field) in numbers.iter_mut().zip(&fields) {
                *slot = field.as_ref().map(|field| at(row, field)).transpose()?;
            }
            Ok(numbers)
        };
        (0..self.points).map(row).collect()
    }

    fn points(&self, path: &Path, rows: &[[Option<f64>; 6]]) -> Result<Points, PointsError> {
        let placed =
            |row: &&[Option<f64>; 6]| row[..3].iter().all(|c| c.is_some_and(|c| !c.is_nan()));
        let kept: Vec<_> = rows.iter().filter(placed).collect();
        let left_out = self.points - kept.len();
        if left_out > 0 {
            tracing::warn!(
                "{left_out} of {} points have no position (NaN) and are left out",
                self.points
            );
        }
        let column = |k: usize| kept.iter().map(|row| row[k]).collect();
        let mut points = Points {
            positions: kept
                .iter()
                .map(|row| [0, 1, 2].map(|k| row[k].unwrap_or(f64::NAN)))
                .collect(),
            weights: column(3),
            values: column(4),
            ..Points::default()
        };
        take_radii(path, &mut points, column(RADIUS))?;
        Ok(points)
    }
}

/// A little-endian number.
fn number(kind: &str, bytes: &[u8]) -> Result<f64, Reason> {
    Ok(match (kind, bytes) {
        ("F", &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
        ("F", &[a, b, c, d, e, f, g, h]) => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
        ("U", bytes @ ([_] | [_, _] | [_, _, _, _])) => {
            bytes.iter().rev().fold(0.0, |n, &byte| 256.0 * n + f64::from(byte))
        }
        ("I", &[a]) => f64::from(i8::from_le_bytes([a])),
        ("I", &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
        ("I", &[a, b, c, d]) => f64::from(i32::from_le_bytes([a, b, c, d])),
        _ => {
            return Err(Reason::header(format!(
                "has a field of type {kind} and {} bytes",
                bytes.len()
            )));
        }
    })
}

/// Unpacks LZF: the packed and the unpacked size, then literals and references to earlier output.
fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, Reason> {
    let damaged = || Reason::damaged("has compressed data that are damaged or truncated");
    let sizes = bytes.first_chunk::<8>().ok_or_else(damaged)?;
    let size = |k: usize| u32::from_le_bytes([sizes[k], sizes[k + 1], sizes[k + 2], sizes[k + 3]]);
    let (packed, whole) = (size(0) as usize, size(4) as usize);
    let mut rest = bytes[8..].get(..packed).ok_or_else(damaged)?;
    let mut out = Vec::new();
    let mut take = |count: usize| {
        let (head, tail) = rest.split_at_checked(count)?;
        rest = tail;
        Some(head)
    };
    while let Some(&[control]) = take(1) {
        if control < 32 {
            out.extend(take(usize::from(control) + 1).ok_or_else(damaged)?);
            continue;
        }
        let mut length = usize::from(control >> 5) + 2;
        if length == 9 {
            length += usize::from(take(1).ok_or_else(damaged)?[0]);
        }
        let low = usize::from(take(1).ok_or_else(damaged)?[0]);
        let back = (usize::from(control & 31) << 8) + low + 1;
        let start = out.len().checked_sub(back).ok_or_else(damaged)?;
        // A reference may overlap its own output.
        (start..start + length).for_each(|from| out.push(out[from]));
        if out.len() > whole {
            return Err(damaged());
        }
    }
    if out.len() == whole { Ok(out) } else { Err(damaged()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// References to near and far output, of the greatest length, and overlapping their own output.
    #[test]
    fn pieces_repeat_what_came_before() {
        let literal: Vec<u8> = (0..320u32).map(|i| (i * i % 251) as u8).collect();
        let mut packed: Vec<u8> = literal.chunks(32).flat_map(|c| [&[31], c].concat()).collect();
        let mut expected = literal;
        for (control, more, back, length) in [
            (32, None, 1, 3),
            (33, None, 300, 3),
            (6 << 5, None, 7, 8),
            (7 << 5, Some(200), 10, 209),
        ] {
            packed.push(control);
            packed.extend(more);
            packed.push((back - 1) as u8);
            let start = expected.len() - back;
            (start..start + length).for_each(|from| expected.push(expected[from]));
        }
        let sizes = [packed.len(), expected.len()].map(|n| (n as u32).to_le_bytes()).concat();
        assert_eq!(unpacked(&[sizes, packed].concat()).ok(), Some(expected));
    }
}
