//! Unstructured grids in legacy VTK files, as text and in binary (VTK User's Guide, "VTK File Formats"). Cells come as
//! rows that begin with their lengths, or from version 5 on as offsets and corners.
//!
//! In the data of points, `weight`, or the square of `radius`, is a weight; `alpha` in the field data is α, and `class` in the
//! data of cells is their class.

use std::str;

use super::grid::Grid;
use super::scan::{Form, Scan, WRITE_AGAIN, shown};
use super::{Mesh, MeshError};
use crate::Alpha;

pub(super) fn read(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let mut scan = Scan::new(bytes);
    let first = scan.line();
    if !first.starts_with(b"# vtk DataFile") {
        let error = MeshError::new(
            "the file does not begin with # vtk DataFile: it is not a legacy VTK file",
        );
        return Err(error.with_advice("give another format its own extension"));
    }
    let version = first.rsplit(u8::is_ascii_whitespace).next().unwrap_or_default();
    let version: f64 = scan.value(version, "a version")?;
    let _title = scan.line();
    let numbers = match scan.expect("ASCII or BINARY")? {
        b"ASCII" => Form::Text,
        b"BINARY" => Form::Big,
        other => return Err(scan.fault(format!("{:?} is neither ASCII nor BINARY", shown(other)))),
    };
    match (scan.expect("DATASET")?, scan.expect("the kind of dataset")?) {
        (b"DATASET", b"UNSTRUCTURED_GRID") => {}
        (_, other) => {
            let why = format!(
                "the dataset is {}, and cells are read from UNSTRUCTURED_GRID",
                shown(other)
            );
            return Err(scan.fault(why).with_advice("write the cells as an unstructured grid"));
        }
    }
    let mut reader =
        Reader { scan, numbers, offsets: version >= 5.0, grid: Grid::default(), radii: None };
    while let Some(word) = reader.scan.word() {
        reader.section(word)?;
    }
    let Reader { mut grid, radii, .. } = reader;
    if let (None, Some(radii)) = (&grid.weights, radii) {
        grid.weights = Some(radii.into_iter().map(|radius| radius * radius).collect());
    }
    if grid.points.is_empty() {
        return Err(MeshError::new("the file lists no points").with_advice(WRITE_AGAIN));
    }
    if grid.types.is_empty() {
        return Err(MeshError::new("the file lists no cells")
            .with_advice("write the cells of the volume, too"));
    }
    let mesh = grid.mesh()?;
    Ok(if numbers == Form::Text { mesh.with_decimal_note() } else { mesh })
}

/// The owner of the arrays that follow.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Of {
    Points,
    Cells,
    /// The whole dataset.
    All,
}

struct Reader<'a> {
    scan: Scan<'a>,
    numbers: Form,
    /// Whether cells are offsets and corners.
    offsets: bool,
    grid: Grid,
    radii: Option<Vec<f64>>,
}

impl Reader<'_> {
    /// Reads a section before the data, and then all data.
    fn section(&mut self, keyword: &[u8]) -> Result<(), MeshError> {
        match keyword {
            b"POINTS" => {
                let count = self.scan.size("the number of points")?;
                let kind = self.kind()?;
                let numbers = self.array(kind, count.saturating_mul(3), "coordinates")?;
                numbers.iter().try_for_each(|&x| self.scan.finite(x).map(drop))?;
                self.grid.points = numbers.as_chunks().0.to_vec();
            }
            b"CELLS" if self.offsets => self.offsets_and_corners()?,
            b"CELLS" => self.rows()?,
            b"CELL_TYPES" => {
                let count = self.scan.size("the number of cells")?;
                let types = self.array(Kind::INT, count, "types of cells")?;
                self.grid.types = types.into_iter().map(|kind| kind as u8).collect();
            }
            b"FIELD" => self.field(Of::All)?,
            b"METADATA" => self.metadata(),
            b"POINT_DATA" => self.data(Of::Points)?,
            b"CELL_DATA" => self.data(Of::Cells)?,
            other => {
                let why = format!("{:?} stands where a section should begin", shown(other));
                return Err(self.scan.fault(why));
            }
        }
        Ok(())
    }

    /// Cells as rows of a length and as many corners.
    fn rows(&mut self) -> Result<(), MeshError> {
        let count = self.scan.size("the number of cells")?;
        let size = self.scan.size("the number of all their numbers")?;
        let numbers = self.array(Kind::INT, size, "numbers of cells")?;
        // Each cell has its length among the numbers.
        let mut ends = self.scan.room(count.min(size), 0, "cells")?;
        let mut corners = self.scan.room(size, 0, "corners")?;
        let mut left = &numbers[..];
        while let Some((&length, rest)) = left.split_first() {
            let Some((row, rest)) = rest.split_at_checked(length as usize) else { break };
            corners.extend_from_slice(row);
            ends.push(corners.len() as f64);
            left = rest;
        }
        if !left.is_empty() || ends.len() as u64 != count {
            let why = format!("the {size} numbers of cells are not those of {count} cells");
            return Err(self.scan.fault(why));
        }
        (self.grid.ends, self.grid.corners) = (ends, corners);
        Ok(())
    }

    /// Cells as two arrays: the start of each cell, with one more number for the end, and all corners.
    fn offsets_and_corners(&mut self) -> Result<(), MeshError> {
        let offsets = self.scan.size("the number of offsets")?;
        let corners = self.scan.size("the number of corners")?;
        for (name, count) in [(&b"OFFSETS"[..], offsets), (b"CONNECTIVITY", corners)] {
            let found = self.scan.expect("OFFSETS or CONNECTIVITY")?;
            if found != name {
                let why = format!("{:?} stands where {} should", shown(found), shown(name));
                return Err(self.scan.fault(why));
            }
            let kind = self.kind()?;
            let numbers = self.array(kind, count, "numbers of cells")?;
            if name == b"OFFSETS" {
                self.grid.ends = numbers.get(1..).unwrap_or_default().to_vec();
            } else {
                self.grid.corners = numbers;
            }
        }
        Ok(())
    }

    /// Reads the data of points or cells, up to the end or to the data of the other.
    fn data(&mut self, of: Of) -> Result<(), MeshError> {
        let count = self.scan.size("the number of points or cells")?;
        let (points, cells) = (self.grid.points.len(), self.grid.types.len());
        let expected = if of == Of::Points { points } else { cells };
        if count != expected as u64 {
            return Err(self
                .scan
                .fault(format!("the data are those of {count}, and there are {expected}")));
        }
        while self.scan.peek().is_some_and(|word| !word.ends_with(b"_DATA")) {
            let keyword = self.scan.expect("a keyword")?;
            match keyword {
                b"METADATA" => self.metadata(),
                b"FIELD" => self.field(of)?,
                b"LOOKUP_TABLE" => {
                    self.scan.expect("a name")?;
                    let colours = self.scan.size("the number of colours")?;
                    self.array(Kind::BYTE, colours.saturating_mul(4), "colours")?;
                }
                b"COLOR_SCALARS" => {
                    self.scan.expect("a name")?;
                    let each = self.scan.size("the number of components")?;
                    self.array(Kind::BYTE, count.saturating_mul(each), "colours")?;
                }
                _ => self.attribute(keyword, of, count)?,
            }
        }
        Ok(())
    }

    /// Reads an attribute that has its own keyword.
    fn attribute(&mut self, keyword: &[u8], of: Of, count: u64) -> Result<(), MeshError> {
        let name = self.scan.expect("a name")?;
        let mut components = match keyword {
            b"SCALARS" | b"GLOBAL_IDS" | b"PEDIGREE_IDS" => 1,
            b"VECTORS" | b"NORMALS" => 3,
            b"TENSORS" => 9,
            b"TENSORS6" => 6,
            b"TEXTURE_COORDINATES" => self.scan.size("the number of components")?,
            other => {
                let why = format!("{:?} stands where data should begin", shown(other));
                return Err(self.scan.fault(why));
            }
        };
        let kind = self.kind()?;
        if keyword == b"SCALARS" {
            if self.scan.peek().is_some_and(|word| word != b"LOOKUP_TABLE") {
                components = self.scan.size("the number of components")?;
            }
            let table = self.scan.expect("LOOKUP_TABLE")?;
            if table != b"LOOKUP_TABLE" {
                let why = format!(
                    "{:?} stands where LOOKUP_TABLE should, below SCALARS {}",
                    shown(table),
                    shown(name)
                );
                return Err(self.scan.fault(why));
            }
            self.scan.expect("the name of a table")?;
        }
        let values = self.array(kind, count.saturating_mul(components), "values")?;
        self.keep(name, of, components, values);
        Ok(())
    }

    /// Reads arrays with names.
    fn field(&mut self, of: Of) -> Result<(), MeshError> {
        self.scan.expect("a name")?;
        let arrays = self.scan.size("the number of arrays")?;
        for _ in 0..arrays {
            while self.scan.peek() == Some(b"METADATA") {
                self.scan.expect("METADATA")?;
                self.metadata();
            }
            let name = self.scan.expect("a name")?;
            let components = self.scan.size("the number of components")?;
            let count = self.scan.size("the number of values")?.saturating_mul(components);
            let kind = self.scan.expect("a type of numbers")?;
            if kind == b"string" {
                self.skip_texts(count)?;
                continue;
            }
            let kind = self.kind_of(kind)?;
            let values = self.array(kind, count, "values")?;
            self.keep(name, of, components, values);
        }
        Ok(())
    }

    /// Keeps an array that describes the complex.
    fn keep(&mut self, name: &[u8], of: Of, components: u64, values: Vec<f64>) {
        let is_named = |wanted: &[u8]| components == 1 && name.eq_ignore_ascii_case(wanted);
        match of {
            Of::Points if is_named(b"weight") => self.grid.weights = Some(values),
            Of::Points if is_named(b"radius") => self.radii = Some(values),
            Of::Cells if is_named(b"class") => self.grid.classes = Some(values),
            Of::All if is_named(b"alpha") => {
                let alpha = values.first().and_then(|&alpha| Alpha::from_squared(alpha).ok());
                self.grid.alpha = alpha.or(self.grid.alpha);
            }
            _ => {}
        }
    }

    /// Skips the description of an array, which ends at an empty line.
    fn metadata(&mut self) {
        self.scan.skip_line();
        while !self.scan.line().is_empty() {}
    }

    /// Skips texts: lines, or in binary each after its length, which has 6, 14, 30 or 62 bits, as the first two bits of the first
    /// byte say.
    fn skip_texts(&mut self, count: u64) -> Result<(), MeshError> {
        self.scan.skip_line();
        for _ in 0..count {
            if self.numbers == Form::Text {
                self.scan.line();
                continue;
            }
            let first = self.scan.take(1, "a text")?[0];
            let more = match first >> 6 {
                3 => 0,
                2 => 1,
                1 => 3,
                _ => 7,
            };
            let rest = self.scan.take(more, "a text")?;
            let start = usize::from(first & 0x3f);
            let length = rest.iter().fold(start, |length, &byte| length << 8 | usize::from(byte));
            self.scan.take(length, "a text")?;
        }
        Ok(())
    }

    fn kind(&mut self) -> Result<Kind, MeshError> {
        let word = self.scan.expect("a type of numbers")?;
        self.kind_of(word)
    }

    fn kind_of(&self, word: &[u8]) -> Result<Kind, MeshError> {
        let name = str::from_utf8(word).unwrap_or_default().to_ascii_lowercase();
        Kind::of(&name).ok_or_else(|| {
            self.scan.fault(format!("{:?} is not a type of numbers that is read", shown(word)))
        })
    }

    /// Reads an array.
    fn array(&mut self, kind: Kind, count: u64, what: &str) -> Result<Vec<f64>, MeshError> {
        if self.numbers == Form::Text {
            let mut values = self.scan.room(count, 1, what)?;
            for _ in 0..count {
                let word = self.scan.expect(what)?;
                values.push(self.scan.value(word, "a number")?);
            }
            return Ok(values);
        }
        self.scan.skip_line();
        let mut values = self.scan.room(count, kind.bytes as u64, what)?;
        let bytes = self.scan.take(count as usize * kind.bytes, what)?;
        values.extend(bytes.chunks_exact(kind.bytes).map(kind.decode));
        Ok(values)
    }
}

/// A type of numbers in binary.
#[derive(Clone, Copy)]
struct Kind {
    bytes: usize,
    decode: fn(&[u8]) -> f64,
}

/// The type of numbers with this name in Rust.
macro_rules! kind {
    ($type:ty) => {
        Kind {
            bytes: size_of::<$type>(),
            decode: |bytes| {
                <$type>::from_be_bytes(bytes.try_into().expect("the bytes of one number")) as f64
            },
        }
    };
}

#[expect(clippy::cast_lossless, reason = "one rule for all types, of which some are lossy")]
impl Kind {
    const BYTE: Self = kind!(u8);
    const INT: Self = kind!(i32);

    /// The type with this name in VTK. `long` has 64 bits on the systems where these files are usual.
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "unsigned_char" => Self::BYTE,
            "char" | "signed_char" => kind!(i8),
            "unsigned_short" => kind!(u16),
            "short" => kind!(i16),
            "unsigned_int" => kind!(u32),
            "int" | "vtkidtype" => Self::INT,
            "unsigned_long" | "vtktypeuint64" => kind!(u64),
            "long" | "vtktypeint64" => kind!(i64),
            "float" => kind!(f32),
            "double" => kind!(f64),
            _ => return None,
        })
    }
}
