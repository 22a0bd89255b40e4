use std::io::Read;
use std::path::Path;

use walpha_check::meshes::{Grid, Mesh};

use super::columns::places;
use super::content::{Content, HeaderLines};
use super::{
    COLUMNS, CellCount, Points, PointsError, RADIUS, format, mesh_error, no_complex, take_radii,
};
use crate::{Attributes, Column};
use walpha_volume::{Dtype, Element as _, Endian, OpenFile, Reason, io_error};

/// Reads the vertices of a PLY file, text or binary of either byte order: properties x, y and z, optionally weight or radius, and
/// value. All other elements must be as the header declares.
pub(crate) fn read(file: &OpenFile, attributes: &Attributes) -> Result<Points, PointsError> {
    Ok(content(file, &mut None, attributes)?.0)
}

/// Reads the vertices and the tetrahedra. In an element with one of [these names](TETRAHEDRA), the corners are the list
/// `vertex_indices` or `vertex_index`, or else the first list.
pub(crate) fn read_complex(file: &OpenFile) -> Result<Mesh, PointsError> {
    let mut corners = Some(Corners::default());
    let (points, header) = content(file, &mut corners, &Attributes::None)?;
    let Some(corners) = corners.filter(|corners| !corners.ends.is_empty()) else {
        return Err(no_complex(file.path()));
    };
    let others =
        header.cells().into_iter().filter(|cells| cells.kind != Grid::kind_of(Grid::TETRA));
    let ignored: Vec<_> = others.map(|cells| (cells.kind, cells.count as u64)).collect();
    let grid = Grid {
        points: points.positions,
        weights: points.weights,
        types: vec![Grid::TETRA; corners.ends.len()],
        ends: corners.ends,
        corners: corners.numbers,
        ..Grid::default()
    };
    let mesh = grid.mesh().map_err(|error| mesh_error(file.path(), &error))?.with_ignored(&ignored);
    Ok(if header.endian.is_none() { mesh.with_decimal_note() } else { mesh })
}

/// The corners of all tetrahedra, and the end of each tetrahedron's corners.
#[derive(Default)]
struct Corners {
    numbers: Vec<f64>,
    ends: Vec<f64>,
}

/// The names of elements that are tetrahedra. `VCGlib` uses `tetra`.
const TETRAHEDRA: [&str; 5] = ["tetra", "tet", "tetrahedra", "tetrahedron", "cell"];

/// Reads the points, the header and, if they are requested, the tetrahedra.
fn content(
    file: &OpenFile,
    corners: &mut Option<Corners>,
    attributes: &Attributes,
) -> Result<(Points, Header), PointsError> {
    let path = file.path();
    let fail = |reason: Reason| format(path, reason);
    let Content { reader, length } = Content::of(file)?;
    let mut lines = HeaderLines::new(reader);
    let header = Header::read(path, &mut lines)?;
    let left = length.saturating_sub(lines.bytes());
    let mut reader = lines.into_inner();
    let mut numbers = if let Some(endian) = header.endian {
        Numbers::Binary(reader, endian)
    } else {
        let mut text = String::new();
        reader.read_to_string(&mut text).map_err(io_error(path))?;
        Numbers::Text(Words { text, at: 0, row: 0, wrong: None })
    };
    let mut points = None;
    for element in &header.elements {
        element.fits(header.endian.is_some(), left).map_err(fail)?;
        if element.name == "vertex" && points.is_none() {
            points = Some(vertices(path, element, attributes, &mut numbers)?);
        } else if element.name == "vertex" {
            let reason = Reason::content("has two elements vertex", "write one of them alone");
            return Err(fail(reason));
        } else if let Some(corners) = corners
            && TETRAHEDRA.contains(&element.name.as_str())
        {
            corners.read(element, &mut numbers).map_err(fail)?;
        } else {
            element.skip(&mut numbers).map_err(fail)?;
        }
    }
    if !numbers.at_end() {
        let what = "continues after its last element: a count in its header is too low";
        let reason = Reason::content(what, "correct its header, or remove what follows");
        return Err(fail(numbers.wrong_row().unwrap_or(reason)));
    }
    let points = points.ok_or_else(|| {
        fail(Reason::content("has no element vertex, and so no points", "name another file"))
    })?;
    Ok((points, header))
}

impl Corners {
    /// Reads an element of tetrahedra.
    fn read(&mut self, element: &Element, numbers: &mut Numbers<impl Read>) -> Result<(), Reason> {
        let is_list = |property: &Property| matches!(property, Property::List(..));
        let is_named = |property: &Property| match property {
            Property::List(name, ..) => name == "vertex_indices" || name == "vertex_index",
            Property::Scalar(..) => false,
        };
        let lists = &element.properties;
        let list = lists.iter().position(is_named).or_else(|| lists.iter().position(is_list));
        let Some(list) = list else { return element.skip(numbers) };
        for _ in 0..element.count {
            for (place, property) in element.properties.iter().enumerate() {
                let mut keep = |number| {
                    if place == list {
                        self.numbers.push(number);
                    }
                };
                property.read(numbers, &mut keep)?;
            }
            self.ends.push(self.numbers.len() as f64);
            numbers.end_row()?;
        }
        Ok(())
    }
}

/// The numbers of faces, edges and so on that the header declares.
pub(crate) fn cells(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let mut lines = HeaderLines::new(Content::of(file)?.reader);
    Ok(Header::read(file.path(), &mut lines)?.cells())
}

fn vertices(
    path: &Path,
    element: &Element,
    attributes: &Attributes,
    numbers: &mut Numbers<impl Read>,
) -> Result<Points, PointsError> {
    let fail = |reason: Reason| format(path, reason);
    let name = |property: &'_ Property| match property {
        Property::Scalar(name, _) => name.clone(),
        Property::List(..) => String::new(),
    };
    let names: Vec<String> = element.properties.iter().map(name).collect();
    let columns = places(&names.iter().map(String::as_str).collect::<Vec<_>>());
    for (place, name) in COLUMNS.iter().enumerate() {
        let count = columns.iter().filter(|&&column| column == Some(place)).count();
        if count > 1 || (count == 0 && place < 3) {
            let what = format!("has {count} vertex properties {name}, and needs one");
            return Err(fail(Reason::content(what, "correct its header, or write it again")));
        }
    }
    let mut points = Points::default();
    let has = |column| columns.contains(&Some(column));
    (points.weights, points.values) = (has(3).then(Vec::new), has(4).then(Vec::new));
    let mut radii = has(RADIUS).then(Vec::new);
    let kept = |place: usize| columns[place].is_none() && attributes.keeps(&names[place]);
    let mut others: Vec<Option<Column>> = (0..names.len())
        .map(|place| {
            let is_kept = kept(place) && !names[place].is_empty();
            is_kept.then(|| Column { name: names[place].clone(), values: Vec::new() })
        })
        .collect();
    for _ in 0..element.count {
        let mut position = [0.0; 3];
        for ((property, column), other) in element.properties.iter().zip(&columns).zip(&mut others)
        {
            let number = property.read(numbers, &mut |_| ()).map_err(fail)?;
            match *column {
                Some(3) => points.weights.get_or_insert_default().push(number),
                Some(4) => points.values.get_or_insert_default().push(number),
                Some(RADIUS) => radii.get_or_insert_default().push(number),
                Some(axis) => position[axis] = number,
                None => other.iter_mut().for_each(|other| other.values.push(number)),
            }
        }
        points.positions.push(position);
        numbers.end_row().map_err(fail)?;
    }
    points.columns = others.into_iter().flatten().collect();
    take_radii(path, &mut points, radii)?;
    Ok(points)
}

struct Header {
    /// The byte order; `None` for text.
    endian: Option<Endian>,
    elements: Vec<Element>,
}

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

enum Property {
    /// A number, given by its name and type.
    Scalar(String, Dtype),
    /// A list, given by its name and the types of its length and of its items.
    List(String, Dtype, Dtype),
}

impl Header {
    /// The numbers of faces, edges and so on.
    fn cells(&self) -> Vec<CellCount> {
        let count = |element: &Element| {
            let kind = match element.name.as_str() {
                "face" => "faces",
                "tristrips" => "triangle strips",
                "edge" => "edges",
                name if TETRAHEDRA.contains(&name) => "tetrahedra",
                _ => return None,
            };
            Some(CellCount::new(kind, usize::try_from(element.count).unwrap_or(usize::MAX)))
        };
        self.elements.iter().filter_map(count).collect()
    }

    fn read(path: &Path, lines: &mut HeaderLines<'_>) -> Result<Self, PointsError> {
        let fail = |reason: Reason| format(path, reason);
        let mut line = || lines.read().map_err(io_error(path));
        if line()?.as_deref().map(str::trim_end) != Some("ply") {
            return Err(fail(Reason::other(
                "is not a PLY file: it does not begin with a line ply",
            )));
        }
        let mut endian = None;
        let mut elements: Vec<Element> = Vec::new();
        while let Some(line) = line()? {
            let words: Vec<&str> = line.split_whitespace().collect();
            let damaged = || {
                let what = format!("has a header line {line:?}, which is not understood");
                fail(Reason::content(what, "correct its header"))
            };
            match words[..] {
                ["end_header"] => {
                    let endian = endian.ok_or_else(|| {
                        fail(Reason::content("has no format in its header", "correct its header"))
                    })?;
                    return Ok(Self { endian, elements });
                }
                ["comment" | "obj_info", ..] | [] => {}
                ["format", "ascii", "1.0"] => endian = Some(None),
                ["format", "binary_little_endian", "1.0"] => endian = Some(Some(Endian::Little)),
                ["format", "binary_big_endian", "1.0"] => endian = Some(Some(Endian::Big)),
                ["element", name, count] => elements.push(Element {
                    name: name.into(),
                    count: count.parse().map_err(|_| damaged())?,
                    properties: Vec::new(),
                }),
                ["property", ref property @ ..] => {
                    let property = match *property {
                        ["list", count, item, ref name @ ..] if name.len() < 2 => Property::List(
                            name.concat(),
                            scalar_type(count).ok_or_else(damaged)?,
                            scalar_type(item).ok_or_else(damaged)?,
                        ),
                        [kind, name] => {
                            Property::Scalar(name.into(), scalar_type(kind).ok_or_else(damaged)?)
                        }
                        _ => return Err(damaged()),
                    };
                    elements.last_mut().ok_or_else(damaged)?.properties.push(property);
                }
                _ => return Err(damaged()),
            }
        }
        Err(fail(Reason::truncated("ends inside its PLY header: it is truncated")))
    }
}

impl Element {
    /// Refuses more elements of this kind than the bytes after the header can contain.
    fn fits(&self, binary: bool, left: u64) -> Result<(), Reason> {
        let least = |property: &Property| match (binary, property) {
            (true, Property::Scalar(_, dtype) | Property::List(_, dtype, _)) => dtype.size() as u64,
            (false, _) => 1,
        };
        let row: u64 = self.properties.iter().map(least).sum();
        if self.count.saturating_mul(row) > left {
            let Self { name, count, .. } = self;
            return Err(Reason::claims_more(format!(
                "claims {count} elements {name}, which {left} bytes cannot hold: it is \
                     truncated, or the count is wrong"
            )));
        }
        Ok(())
    }

    fn skip(&self, numbers: &mut Numbers<impl Read>) -> Result<(), Reason> {
        // Elements without properties take no bytes, whatever their number.
        let rows = if self.properties.is_empty() { 0 } else { self.count };
        for _ in 0..rows {
            for property in &self.properties {
                property.read(numbers, &mut |_| ())?;
            }
            numbers.end_row()?;
        }
        Ok(())
    }
}

impl Property {
    /// Reads a number, or the length of a list and its items, which are passed on.
    fn read(
        &self,
        numbers: &mut Numbers<impl Read>,
        item_of_list: &mut impl FnMut(f64),
    ) -> Result<f64, Reason> {
        match *self {
            Self::Scalar(_, dtype) => numbers.next(dtype),
            Self::List(_, count, item) => {
                let count = numbers.next(count)?;
                if !(count >= 0.0 && count.fract() == 0.0) {
                    return Err(Reason::damaged(format!("has a list of {count} items")));
                }
                (0..count as u64).try_for_each(|_| numbers.next(item).map(&mut *item_of_list))?;
                Ok(count)
            }
        }
    }
}

/// The most bytes of padding behind the last element.
const MOST_PADDING: u64 = 1 << 16;

/// The numbers after a header.
enum Numbers<R> {
    Text(Words),
    Binary(R, Endian),
}

/// Numbers as text. A row may continue in further lines, and a line may contain several rows. But if a row begins within a line
/// and continues in the next, the lines do not match the header.
struct Words {
    text: String,
    at: usize,
    /// The start of the row.
    row: usize,
    /// The start and the end of the first row that began at the start of a line and ended within one.
    wrong: Option<(usize, usize)>,
}

impl Words {
    fn next(&mut self) -> Option<&str> {
        let rest = self.text[self.at..].trim_start();
        let word = rest.split_whitespace().next()?;
        self.at = self.text.len() - rest.len() + word.len();
        Some(word)
    }

    /// Compares a row with its lines; returns `false` if the lines cannot match the header.
    fn end_row(&mut self) -> bool {
        const ENDS: [char; 2] = ['\n', '\r'];
        let read = &self.text[self.row..self.at];
        let (blank, words) = read.split_at(read.len() - read.trim_start().len());
        let begins_line = self.row == 0 || blank.contains(ENDS);
        let behind = self.text[self.at..].trim_start_matches([' ', '\t']);
        let ends_line = behind.is_empty() || behind.starts_with(ENDS);
        if begins_line && !ends_line && self.wrong.is_none() {
            self.wrong = Some((self.row + blank.len(), self.at));
        }
        let fits = begins_line || !words.contains(ENDS);
        self.row = self.at;
        fits
    }

    /// The error for the first row that did not end with its line.
    fn wrong_row(&self) -> Option<Reason> {
        let (start, end) = self.wrong?;
        let (before, rest) = self.text.split_at(start);
        let line = 1 + before.matches('\n').count().max(before.matches('\r').count());
        let found = rest.split(['\n', '\r']).next().unwrap_or_default().split_whitespace().count();
        let declared = self.text[start..end].split_whitespace().count();
        let what = format!(
            "has {found} numbers in line {line} behind its header, which declares {declared} there"
        );
        Some(Reason::header(what))
    }
}

impl<R: Read> Numbers<R> {
    fn next(&mut self, dtype: Dtype) -> Result<f64, Reason> {
        let cut = || {
            Reason::claims_more(
                "ends before all its elements: it is truncated, or a count is wrong",
            )
        };
        match self {
            Self::Text(words) => {
                let Some(word) = words.next() else {
                    return Err(words.wrong_row().unwrap_or_else(cut));
                };
                if let Some(number) = word.parse().ok().filter(|&number| dtype.holds(number)) {
                    return Ok(number);
                }
                let invalid = Reason::value(format!("has {word:?}, which is not a valid {dtype}"));
                Err(words.wrong_row().unwrap_or(invalid))
            }
            Self::Binary(reader, endian) => {
                let mut bytes = [0; 8];
                let bytes = &mut bytes[..dtype.size()];
                reader.read_exact(bytes).map_err(|error| match error.kind() {
                    std::io::ErrorKind::UnexpectedEof => cut(),
                    _ => Reason::damaged(format!("cannot be read: {error}")),
                })?;
                let mut number = [0.0];
                f64::decode(bytes, dtype, *endian, &mut number);
                Ok(number[0])
            }
        }
    }

    /// Ends a row of an element.
    fn end_row(&mut self) -> Result<(), Reason> {
        let Self::Text(words) = self else { return Ok(()) };
        if words.end_row() { Ok(()) } else { words.wrong_row().map_or(Ok(()), Err) }
    }

    fn wrong_row(&self) -> Option<Reason> {
        let Self::Text(words) = self else { return None };
        words.wrong_row()
    }

    fn at_end(&mut self) -> bool {
        match self {
            Self::Text(words) => words.text[words.at..].trim().is_empty(),
            // Some writers end binary files with a line end, or fill blocks with zeros.
            Self::Binary(reader, _) => {
                let mut rest = Vec::new();
                let whole = reader.take(MOST_PADDING).read_to_end(&mut rest);
                let is_padding = |byte: &u8| *byte == 0 || byte.is_ascii_whitespace();
                whole.is_ok_and(|found| (found as u64) < MOST_PADDING)
                    && rest.iter().all(is_padding)
            }
        }
    }
}

fn scalar_type(name: &str) -> Option<Dtype> {
    Some(match name {
        "char" | "int8" => Dtype::I8,
        "uchar" | "uint8" => Dtype::U8,
        "short" | "int16" => Dtype::I16,
        "ushort" | "uint16" => Dtype::U16,
        "int" | "int32" => Dtype::I32,
        "uint" | "uint32" => Dtype::U32,
        "float" | "float32" => Dtype::F32,
        "double" | "float64" => Dtype::F64,
        _ => return None,
    })
}
