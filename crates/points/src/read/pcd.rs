use std::io::Read;
use std::ops::Range;
use std::path::Path;

use walpha_base::shown::shown;

use super::columns::places;
use super::content::{Content, HeaderLines};
use super::{COLUMNS, Points, PointsError, RADIUS, format, take_radii};
use walpha_volume::{OpenFile, Reason, io_error};

/// Reads PCD, the Point Cloud Library's format: text, binary or compressed, with the fields x, y and z, optionally weight or
/// radius, and value or else intensity. Points without a position (NaN, as scanners write them) are left out. If the number of
/// points is missing, it is width times height.
pub(crate) fn read(file: &OpenFile) -> Result<Points, PointsError> {
    let path = file.path();
    let fail = |reason: Reason| format(path, reason);
    let Content { reader, length } = Content::of(file)?;
    let mut lines = HeaderLines::new(reader);
    let mut header = Header::default();
    let data = loop {
        let line = lines.read().map_err(io_error(path))?;
        let line = line.ok_or_else(|| {
            fail(Reason::truncated("ends inside its PCD header: it is truncated"))
        })?;
        let mut words = line.split_whitespace();
        if words.next() == Some("DATA") {
            break words.collect::<Vec<_>>().join(" ");
        }
        header.parse_line(&line).map_err(fail)?;
    };
    let points = header.check(length).map_err(fail)?;
    if let Some(viewpoint) = &header.viewpoint {
        tracing::warn!(
            "{}: the sensor stood at VIEWPOINT {viewpoint}, which is passed over: coordinates are as stored",
            shown(path)
        );
    }
    let mut bytes = Vec::new();
    lines.into_inner().read_to_end(&mut bytes).map_err(io_error(path))?;
    let rows = match data.as_str() {
        "ascii" => header.text(&String::from_utf8_lossy(&bytes), points),
        "binary" => header.binary(&bytes, points, false),
        "binary_compressed" => {
            unpacked(&bytes).and_then(|bytes| header.binary(&bytes, points, true))
        }
        other => Err(Reason::unsupported(
            format!("has DATA {other}: ascii, binary and binary_compressed are read"),
            "convert it first",
        )),
    };
    points_of(path, &rows.map_err(fail)?)
}

#[derive(Default)]
struct Header {
    names: Vec<String>,
    sizes: Vec<usize>,
    types: Vec<String>,
    /// The number of numbers of each field.
    counts: Vec<usize>,
    width: Option<usize>,
    height: Option<usize>,
    points: Option<usize>,
    /// The position and direction of the sensor, unless they are the defaults.
    viewpoint: Option<String>,
}

/// A column to read: its index in the lists of the header, and its offset within a point, in numbers or bytes.
struct Field {
    index: usize,
    offset: usize,
}

/// The advice about a header that contradicts itself or the data.
const HEADER: &str = "correct its header, or write it again";

impl Header {
    fn parse_line(&mut self, line: &str) -> Result<(), Reason> {
        let damaged = || {
            let what = format!("has a header line {line:?}, which is not understood");
            Reason::content(what, HEADER)
        };
        let mut words = line.split_whitespace();
        let key = words.next().unwrap_or("#");
        let numbers = || words.clone().map(str::parse).collect::<Result<Vec<usize>, _>>();
        let number = || words.clone().next().and_then(|n| n.parse().ok()).ok_or_else(damaged);
        match key {
            // Version 0.5 calls them COLUMNS.
            "FIELDS" | "COLUMNS" => self.names = words.map(str::to_ascii_lowercase).collect(),
            "TYPE" => self.types = words.map(str::to_ascii_uppercase).collect(),
            "SIZE" => self.sizes = numbers().map_err(|_| damaged())?,
            "COUNT" => self.counts = numbers().map_err(|_| damaged())?,
            "WIDTH" => self.width = Some(number()?),
            "HEIGHT" => self.height = Some(number()?),
            "POINTS" => self.points = Some(number()?),
            "VIEWPOINT" => {
                let place: Option<Vec<f64>> = words.clone().map(|word| word.parse().ok()).collect();
                let place = place.ok_or_else(damaged)?;
                let text = words.collect::<Vec<_>>().join(" ");
                let is_identity = place == [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
                self.viewpoint = (!is_identity).then_some(text);
            }
            _ => {}
        }
        Ok(())
    }

    /// The number of points. Refuses lists of different lengths, huge fields, and more points than the file can contain.
    fn check(&mut self, length: u64) -> Result<usize, Reason> {
        let fields = self.names.len();
        if self.counts.is_empty() {
            self.counts = vec![1; fields];
        }
        let lengths = [self.sizes.len(), self.types.len(), self.counts.len()];
        if lengths != [fields; 3] || fields == 0 {
            let [sizes, types, counts] = lengths;
            let what =
                format!("has {fields} FIELDS, but {sizes} SIZE, {types} TYPE and {counts} COUNT");
            return Err(Reason::content(what, HEADER));
        }
        let (most, sizes) = (1 << 16, &self.sizes);
        if self.counts.iter().any(|&n| n > most) || sizes.iter().any(|n| !(1..=most).contains(n)) {
            let what = "has fields of no bytes, or of more than 65536 bytes or numbers";
            return Err(Reason::content(what, HEADER));
        }
        let product = match (self.width, self.height) {
            (Some(width), height) => Some(width.saturating_mul(height.unwrap_or(1))),
            (None, _) => None,
        };
        let points = match (self.points, product) {
            (Some(points), Some(product)) if points != product => {
                let what = format!("claims {points} POINTS, but {product} by WIDTH and HEIGHT");
                return Err(Reason::content(what, HEADER));
            }
            (points, product) => points.or(product).ok_or_else(|| {
                Reason::content("says neither POINTS nor WIDTH in its header", HEADER)
            })?,
        };
        // A point takes at least a byte, and LZF packs at most 264 bytes into 3, so 256 points per byte is generous.
        if points as u64 > length.saturating_mul(256) {
            return Err(Reason::claims_more(format!(
                "claims {points} points, which {length} bytes cannot hold: it is truncated, or the \
                 number is wrong"
            )));
        }
        Ok(points)
    }

    /// The size in bytes, or else the number of numbers, of some fields of a point; the largest `usize` if it is larger, as it
    /// may be in 32 bits.
    fn width(&self, fields: Range<usize>, bytes: bool) -> usize {
        let width = |k: usize| self.counts[k].saturating_mul(if bytes { self.sizes[k] } else { 1 });
        fields.map(width).fold(0, usize::saturating_add)
    }

    /// The fields x, y, z, weight, value and radius, each with an offset in bytes or else in numbers.
    fn fields(&self, bytes: bool) -> Result<[Option<Field>; 6], Reason> {
        let names: Vec<&str> = self.names.iter().map(String::as_str).collect();
        let places = places(&names);
        let mut fields = [const { None }; 6];
        for (index, place) in places.iter().enumerate() {
            let Some(place) = *place else { continue };
            let name = &self.names[index];
            let wrong = match (self.counts[index], &fields[place]) {
                (1, None) => None,
                (1, Some(_)) => Some(format!("has two fields for {}", COLUMNS[place])),
                (count, _) => {
                    Some(format!("has COUNT {count} for the field {name}, which is 1 number"))
                }
            };
            if let Some(what) = wrong {
                return Err(Reason::content(what, HEADER));
            }
            fields[place] = Some(Field { index, offset: self.width(0..index, bytes) });
        }
        if fields[..3].iter().all(Option::is_some) {
            return Ok(fields);
        }
        let what = format!("has the fields {}, without x, y or z", self.names.join(", "));
        Err(Reason::content(what, "name another file"))
    }

    fn text(&self, text: &str, points: usize) -> Result<Vec<[Option<f64>; 6]>, Reason> {
        let fields = self.fields(false)?;
        let width = self.width(0..self.counts.len(), false);
        let lines = text.split(['\n', '\r']).map(str::trim).filter(|line| !line.is_empty());
        let lines: Vec<&str> = lines.collect();
        let what = format!("claims {points} points, but has {} lines of them", lines.len());
        if lines.len() < points {
            let what = format!("{what}: it is truncated, or the number is wrong");
            return Err(Reason::claims_more(what));
        }
        if lines.len() > points {
            return Err(Reason::content(what, HEADER));
        }
        let mut rows = Vec::new();
        for line in lines {
            let words: Vec<&str> = line.split_whitespace().collect();
            if words.len() != width {
                return Err(Reason::value(format!(
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
    fn binary(
        &self,
        bytes: &[u8],
        points: usize,
        by_field: bool,
    ) -> Result<Vec<[Option<f64>; 6]>, Reason> {
        let fields = self.fields(true)?;
        let width = self.width(0..self.counts.len(), true);
        let needed = width.saturating_mul(points);
        if bytes.len() < needed {
            return Err(Reason::claims_more(format!(
                "claims {points} points of {width} bytes, and has {}: it is truncated, or the number \
                 is wrong",
                bytes.len()
            )));
        }
        let behind = &bytes[needed..];
        if behind.iter().any(|byte| *byte != 0 && !byte.is_ascii_whitespace()) {
            let more = behind.len();
            let what = format!("goes on for {more} bytes behind its {points} points");
            return Err(Reason::content(what, HEADER));
        }
        let at = |row: usize, field: &Field| {
            let own = self.sizes[field.index] * self.counts[field.index];
            let start = if by_field {
                points * field.offset + row * own
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
        (0..points).map(row).collect()
    }
}

/// The points that have a position.
fn points_of(path: &Path, rows: &[[Option<f64>; 6]]) -> Result<Points, PointsError> {
    let placed = |row: &&[Option<f64>; 6]| row[..3].iter().all(|c| c.is_some_and(|c| !c.is_nan()));
    let kept: Vec<_> = rows.iter().filter(placed).collect();
    let left_out = rows.len() - kept.len();
    if kept.is_empty() && left_out > 0 {
        let what = format!("holds {left_out} points, none of which has a position (NaN)");
        return Err(format(path, Reason::content(what, "name another file")));
    }
    if left_out > 0 {
        tracing::warn!(
            "{left_out} of {} points have no position (NaN) and are left out",
            rows.len()
        );
    }
    let column = |k: usize| kept.iter().map(|row| row[k]).collect();
    let mut points = Points {
        positions: kept.iter().map(|row| [0, 1, 2].map(|k| row[k].unwrap_or(f64::NAN))).collect(),
        weights: column(3),
        values: column(4),
        ..Points::default()
    };
    take_radii(path, &mut points, column(RADIUS))?;
    Ok(points)
}

/// A little-endian number.
fn number(kind: &str, bytes: &[u8]) -> Result<f64, Reason> {
    Ok(match (kind, bytes) {
        ("F", &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
        ("F", &[a, b, c, d, e, f, g, h]) => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
        ("U", bytes @ ([_] | [_, _] | [_, _, _, _] | [_, _, _, _, _, _, _, _])) => {
            double(bytes.iter().rev().fold(0, |n, &byte| n << 8 | i128::from(byte)))?
        }
        ("I", &[a]) => f64::from(i8::from_le_bytes([a])),
        ("I", &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
        ("I", &[a, b, c, d]) => f64::from(i32::from_le_bytes([a, b, c, d])),
        ("I", &[a, b, c, d, e, f, g, h]) => {
            double(i64::from_le_bytes([a, b, c, d, e, f, g, h]).into())?
        }
        _ => {
            let what = format!("has a field of type {kind} and {} bytes", bytes.len());
            return Err(Reason::content(what, HEADER));
        }
    })
}

/// The double that equals an integer.
fn double(integer: i128) -> Result<f64, Reason> {
    let nearest = integer as f64;
    if nearest as i128 == integer {
        return Ok(nearest);
    }
    Err(Reason::content(
        format!("has the integer {integer}, which no double holds"),
        "subtract an offset before it is written",
    ))
}

/// Unpacks LZF, which follows its packed and its unpacked size. If these are equal, some writers stored data that they could not
/// compress.
fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, Reason> {
    let cut = || Reason::truncated("ends inside its compressed data: it is truncated");
    let sizes = bytes.first_chunk::<8>().ok_or_else(cut)?;
    let size = |k: usize| u32::from_le_bytes([sizes[k], sizes[k + 1], sizes[k + 2], sizes[k + 3]]);
    let (packed, whole) = (size(0) as usize, size(4) as usize);
    let data = bytes[8..].get(..packed).ok_or_else(cut)?;
    match from_lzf(data, whole) {
        Err(_) if packed == whole => Ok(data.to_vec()),
        unpacked => unpacked,
    }
}

/// Decodes LZF: literals, and references to earlier output.
fn from_lzf(mut rest: &[u8], whole: usize) -> Result<Vec<u8>, Reason> {
    let damaged = || Reason::damaged("has compressed data that are damaged");
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

    /// Tests references to near and far output, of the greatest length, and overlapping their own output.
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
        let sizes = 5u32.to_le_bytes();
        let stored = [&sizes[..], &sizes, b"\xff\xff\xff\xff\xff"].concat();
        assert_eq!(unpacked(&stored).ok(), Some(vec![0xff; 5]));
    }
}
