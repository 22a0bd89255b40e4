use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use super::described::{Described, Encoding, frame};
use super::lines::Lines;
use super::{format_error, io_error, text};
use crate::volume::{Coordinates, Dims, Dtype, Endian, Volume, VolumeError};

/// The first bytes of each legacy VTK file.
pub(super) const MAGIC: &[u8] = b"# vtk DataFile";

/// Words that may follow the samples of the first attribute.
const KEYWORDS: [&str; 14] = [
    "METADATA",
    "SCALARS",
    "COLOR_SCALARS",
    "LOOKUP_TABLE",
    "VECTORS",
    "NORMALS",
    "TEXTURE_COORDINATES",
    "TENSORS",
    "TENSORS6",
    "FIELD",
    "GLOBAL_IDS",
    "PEDIGREE_IDS",
    "POINT_DATA",
    "CELL_DATA",
];

/// Reads the legacy VTK format (VTK User's Guide, "VTK File Formats"), text or binary (big endian):
/// the first attribute of a `STRUCTURED_POINTS` dataset, which must be one scalar a point or cell.
///
/// Samples of cells stand at their centres.
pub(super) fn read(path: &Path) -> Result<Volume, VolumeError> {
    let file = File::open(path).map_err(io_error(path))?;
    let length = file.metadata().map_err(io_error(path))?.len();
    let mut lines = Lines::new(BufReader::new(file));
    let (described, colours) = header(path, &mut lines)?;
    let left = length - lines.bytes();
    let mut reader = lines.into_inner();
    if described.encoding == Encoding::Text {
        let mut text = Vec::new();
        reader.read_to_end(&mut text).map_err(io_error(path))?;
        let end = end_of_numbers(&text);
        if colours {
            let count = described.dims.samples() as u64;
            let mut shares: Vec<f32> = text::numbers(&text[..end], end as u64, Dtype::F32, count)
                .map_err(|what| format_error(path, what))?;
            shares.iter_mut().for_each(|share| *share = (*share * 255.0).round());
            return described.volume(shares);
        }
        return described.read(path, &text[..end], end as u64);
    }
    let bytes = described.bytes();
    if left < bytes {
        return described.read(path, reader, left);
    }
    let volume = described.read(path, (&mut reader).take(bytes), bytes)?;
    if !at_keyword(&mut reader).map_err(io_error(path))? {
        let what = format!(
            "has {} bytes behind the {bytes} of its samples: it is too long or mislabelled",
            left - bytes
        );
        return Err(format_error(path, what));
    }
    Ok(volume)
}

/// Reads up to the samples. Says too whether they are `COLOR_SCALARS`, as VTK calls bytes, which
/// text gives as shares of 255.
fn header(
    path: &Path,
    lines: &mut Lines<BufReader<File>>,
) -> Result<(Described, bool), VolumeError> {
    let said = |what: String| format_error(path, what);
    let first = lines.next().map_err(io_error(path))?.unwrap_or_default();
    if !first.as_bytes().starts_with(MAGIC) {
        return Err(said("is no legacy VTK file: it does not begin with # vtk DataFile".into()));
    }
    lines.next().map_err(io_error(path))?;
    let mut grid = Grid::default();
    while let Some(line) = lines.next().map_err(io_error(path))? {
        let words: Vec<&str> = line.split_whitespace().collect();
        let Some(keyword) = words.first() else { continue };
        match keyword.to_ascii_uppercase().as_str() {
            "ASCII" => grid.text = Some(true),
            "BINARY" => grid.text = Some(false),
            "DATASET" if words.get(1) == Some(&"STRUCTURED_POINTS") => grid.named = true,
            "DATASET" => {
                return Err(said(format!(
                    "holds a dataset {}: of legacy VTK files only STRUCTURED_POINTS are read",
                    words.get(1).unwrap_or(&"without a name")
                )));
            }
            "DIMENSIONS" => grid.dims = Some(numbers(path, &words)?),
            "ORIGIN" => grid.origin = numbers(path, &words)?,
            "SPACING" | "ASPECT_RATIO" => grid.spacing = numbers(path, &words)?,
            // VTK writes the matrix row after row.
            "DIRECTION" => {
                let rows: [f64; 9] = numbers(path, &words)?;
                grid.direction = [0, 1, 2].map(|r| [0, 1, 2].map(|c| rows[3 * r + c]));
            }
            "POINT_DATA" => grid.cells = false,
            "CELL_DATA" => grid.cells = true,
            "SCALARS" => {
                let components = words.get(3).unwrap_or(&"1");
                let dtype = scalar(path, words.get(2), components)?;
                let table = lines.next().map_err(io_error(path))?.unwrap_or_default();
                if !table.starts_with("LOOKUP_TABLE") {
                    return Err(said(
                        "has no LOOKUP_TABLE line below SCALARS: it is damaged".into(),
                    ));
                }
                return Ok((grid.described(path, dtype)?, false));
            }
            "COLOR_SCALARS" => {
                let components = words.get(2).unwrap_or(&"(missing)");
                let dtype = scalar(path, Some(&"unsigned_char"), components)?;
                return Ok((grid.described(path, dtype)?, true));
            }
            "FIELD" => {
                // VTK writes here whatever is not its active attribute.
                let array = lines.next().map_err(io_error(path))?.unwrap_or_default();
                let words: Vec<&str> = array.split_whitespace().collect();
                let &[_, components, count, name] = words.as_slice() else {
                    return Err(said(format!("has a FIELD with a line {array:?}: it is damaged")));
                };
                let dtype = scalar(path, Some(&name), components)?;
                let described = grid.described(path, dtype)?;
                if count.parse() != Ok(described.dims.samples() as u64) {
                    return Err(said(format!(
                        "has a field of {count} values for {} samples",
                        described.dims
                    )));
                }
                return Ok((described, false));
            }
            "METADATA" => {
                while lines.next().map_err(io_error(path))?.is_some_and(|line| !line.is_empty()) {}
            }
            other => {
                return Err(said(format!(
                    "has {other:?} where SCALARS are expected: only a scalar first attribute is read"
                )));
            }
        }
    }
    Err(said("ends before any SCALARS: it is truncated, or holds no samples".into()))
}

struct Grid {
    text: Option<bool>,
    named: bool,
    dims: Option<[f64; 3]>,
    origin: [f64; 3],
    spacing: [f64; 3],
    direction: [[f64; 3]; 3],
    cells: bool,
}

impl Default for Grid {
    fn default() -> Self {
        Self {
            text: None,
            named: false,
            dims: None,
            origin: [0.0; 3],
            spacing: [1.0; 3],
            direction: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            cells: false,
        }
    }
}

impl Grid {
    fn described(&self, path: &Path, dtype: Dtype) -> Result<Described, VolumeError> {
        let damaged =
            |what: &str| format_error(path, format!("has no {what} line before its samples"));
        let text = self.text.ok_or_else(|| damaged("ASCII or BINARY"))?;
        if !self.named {
            return Err(damaged("DATASET"));
        }
        let dims = self.dims.ok_or_else(|| damaged("DIMENSIONS"))?;
        if dims.iter().any(|&size| size < 0.0 || size.fract() != 0.0) {
            return Err(format_error(path, format!("has DIMENSIONS {dims:?}: they are no sizes")));
        }
        let mut dims = dims.map(|size| size as u64);
        let axes = [0, 1, 2].map(|c| [0, 1, 2].map(|r| self.direction[r][c] * self.spacing[c]));
        let mut origin = self.origin;
        if self.cells {
            to_centres(&mut dims, &mut origin, axes);
        }
        let encoding = if text { Encoding::Text } else { Encoding::Raw };
        let frame = frame(path, origin, axes, Coordinates::default())?;
        let dims = Dims::new(dims[0], dims[1], dims[2])?;
        Ok(Described { dims, dtype, endian: Endian::Big, frame, encoding })
    }
}

/// From the points of a grid to the centres of its cells. An axis of one point has cells of no
/// thickness on it.
pub(super) fn to_centres(dims: &mut [u64; 3], origin: &mut [f64; 3], axes: [[f64; 3]; 3]) {
    for (size, axis) in dims.iter_mut().zip(axes).filter(|(size, _)| **size > 1) {
        *size -= 1;
        for (component, step) in origin.iter_mut().zip(axis) {
            *component += 0.5 * step;
        }
    }
}

/// The numbers behind a keyword.
fn numbers<const N: usize>(path: &Path, words: &[&str]) -> Result<[f64; N], VolumeError> {
    let numbers: Option<Vec<f64>> = words[1..].iter().map(|word| word.parse().ok()).collect();
    numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| {
        format_error(path, format!("has {:?}, which is not {N} numbers", words.join(" ")))
    })
}

fn scalar(path: &Path, name: Option<&&str>, components: &str) -> Result<Dtype, VolumeError> {
    if components != "1" {
        return Err(format_error(
            path,
            format!(
                "has {components} values a voxel: only scalar volumes are read; extract one first"
            ),
        ));
    }
    let name = name.copied().unwrap_or("(missing)");
    Ok(match name {
        "unsigned_char" => Dtype::U8,
        "char" | "signed_char" => Dtype::I8,
        "unsigned_short" => Dtype::U16,
        "short" => Dtype::I16,
        "unsigned_int" => Dtype::U32,
        "int" => Dtype::I32,
        // As on all systems but Windows; there VTK writes vtktypeint64.
        "unsigned_long" | "vtktypeuint64" => Dtype::U64,
        "long" | "vtktypeint64" | "vtkIdType" => Dtype::I64,
        "float" => Dtype::F32,
        "double" => Dtype::F64,
        _ => {
            return Err(format_error(
                path,
                format!("holds samples of type {name}, which is not read"),
            ));
        }
    })
}

/// Where the text of numbers ends: at its end, or at a line that begins with a keyword.
fn end_of_numbers(text: &[u8]) -> usize {
    let mut start = 0;
    for line in text.split_inclusive(|&byte| byte == b'\n') {
        if KEYWORDS.iter().any(|keyword| line.starts_with(keyword.as_bytes())) {
            return start;
        }
        start += line.len();
    }
    text.len()
}

/// Whether nothing but white space follows, or a keyword.
fn at_keyword(reader: &mut impl BufRead) -> std::io::Result<bool> {
    let mut rest = Vec::new();
    reader.take(4096).read_to_end(&mut rest)?;
    let rest = rest.trim_ascii_start();
    Ok(rest.is_empty() || KEYWORDS.iter().any(|keyword| rest.starts_with(keyword.as_bytes())))
}
