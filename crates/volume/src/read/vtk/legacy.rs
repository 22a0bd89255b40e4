//! Volumes in the legacy VTK format.

use std::io::{BufRead, Read};
use std::path::Path;

use walpha_base::Monitor;
use walpha_base::advice::{Setting, advice};
use walpha_base::sort::sort_by_key;

use super::ghosts;
use super::legacy_arrays::{self as arrays, Array};
use crate::error::{format_error, io_error};
use crate::formats::is_vtk;
use crate::read::OpenFile;
use crate::read::frames::FrameChoice;
use crate::read::layout::{Encoding, Layout, frame};
use crate::read::text::{self, Lines};
use crate::{Coordinates, Dims, Dtype, Endian, Reason, Volume, VolumeError};

/// Reads the legacy VTK format (VTK User's Guide, "VTK File Formats"), text or binary (big endian): the scalars of this name in a
/// `STRUCTURED_POINTS` dataset; or else the first scalars of its points, or of its cells, located at the cells' centres.
pub(crate) fn read(
    file: &OpenFile,
    wanted: Option<&str>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let fail = |reason: Reason| format_error(path, reason);
    let mut lines = Lines::new(file.reader()?);
    let (grid, arrays) = header(path, &mut lines)?;
    let (ghosts, mut arrays): (Vec<Array>, Vec<Array>) =
        arrays.into_iter().partition(|array| array.name == ghosts::NAME);
    // Without a name, only scalars are considered if there are any, and those of points come first.
    if wanted.is_none() && arrays.iter().any(|array| array.components == 1) {
        arrays.retain(|array| array.components == 1);
    }
    sort_by_key(&mut arrays, |array| array.cells);
    let names: Vec<(&str, bool)> =
        arrays.iter().map(|array| (array.name.as_str(), array.cells)).collect();
    let array = arrays.swap_remove(choice(&names, wanted).map_err(fail)?);
    let volume = read_array(file, &grid, &array, monitor)?;
    let Some(ghosts) = ghosts.iter().find(|ghosts| ghosts.cells == array.cells) else {
        return Ok(volume);
    };
    let ghosts = read_array(file, &grid, ghosts, monitor)?;
    let mut samples = volume.as_slice().to_vec();
    let hidden = ghosts::hide(path, &mut samples, ghosts.as_slice(), array.cells)?;
    Ok(grid.layout(path, &array)?.volume(samples)?.with_missing(hidden))
}

fn read_array(
    file: &OpenFile,
    grid: &Grid,
    array: &Array,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let (path, length) = (file.path(), file.length());
    let layout = grid.layout(path, array)?;
    if array.values != layout.dims.samples() as u64 {
        let what = format!("has {} values for {} samples", array.values, layout.dims);
        return Err(format_error(path, Reason::header(what)));
    }
    let reader = file.reader_at(array.start)?;
    let left = array.end.unwrap_or(length).saturating_sub(array.start);
    match layout.encoding {
        Encoding::Text => read_text(path, layout, array, reader.take(left), monitor),
        _ => read_binary(path, layout, array, reader, length - array.start, monitor),
    }
}

fn read_text(
    path: &Path,
    layout: Layout,
    array: &Array,
    mut reader: impl Read,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let mut text = Vec::new();
    reader.read_to_end(&mut text).map_err(io_error(path))?;
    let end = end_of_numbers(&text);
    if !array.colours {
        return layout.read(path, &text[..end], end as u64, monitor);
    }
    let count = layout.dims.samples() as u64;
    let mut shares: Vec<f32> = text::numbers(path, &text[..end], end as u64, Dtype::F32, count)
        .map_err(|reason| format_error(path, reason))?;
    shares.iter_mut().for_each(|share| *share = (*share * 255.0).round());
    layout.volume(shares)
}

fn read_binary(
    path: &Path,
    layout: Layout,
    array: &Array,
    mut reader: impl BufRead,
    left: u64,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let bytes = layout.bytes();
    if left < bytes {
        return layout.read(path, reader, left, monitor);
    }
    let volume = layout.read(path, (&mut reader).take(bytes), bytes, monitor)?;
    if array.last && !at_keyword(&mut reader).map_err(io_error(path))? {
        let reason = Reason::header(format!(
            "has {} bytes behind the {bytes} of its samples: it is too long or mislabelled",
            left - bytes
        ));
        return Err(format_error(path, reason));
    }
    Ok(volume)
}

/// Chooses among arrays, each with its name and whether it belongs to cells: the one with the wanted name, or else the first. If
/// there are others, the choice is reported.
pub(super) fn choice(arrays: &[(&str, bool)], wanted: Option<&str>) -> Result<usize, Reason> {
    let shown = |&(name, cells): &(&str, bool)| {
        if cells { format!("{name} (of cells)") } else { name.to_owned() }
    };
    let all = || arrays.iter().map(shown).collect::<Vec<_>>().join(", ");
    if let Some(wanted) = wanted {
        return arrays.iter().position(|(name, _)| *name == wanted).ok_or_else(|| {
            Reason::choice(
                Setting::Array,
                format!("has no array {wanted:?}, but {}", all()),
                advice!["give one of these to ", Setting::Array],
            )
        });
    }
    match arrays {
        [] => Err(Reason::content(
            "has no array of one value a voxel: there is no volume in it",
            "name another file",
        )),
        [_] => Ok(0),
        _ => {
            tracing::warn!("of the arrays {} the first is read; `array` names another", all());
            Ok(0)
        }
    }
}

/// Reads the grid and finds the arrays.
fn header(path: &Path, lines: &mut Lines<impl BufRead>) -> Result<(Grid, Vec<Array>), VolumeError> {
    let fail = |reason: Reason| format_error(path, reason);
    let first = lines.read_line().map_err(io_error(path))?.unwrap_or_default();
    if !is_vtk(first.as_bytes()) {
        return Err(fail(Reason::other(
            "is not a legacy VTK file: it does not begin with # vtk DataFile",
        )));
    }
    lines.read_line().map_err(io_error(path))?;
    let no_text = || fail(Reason::header("has no ASCII or BINARY line before its samples"));
    let is_structured_points = |name: Option<&&str>| {
        name.is_some_and(|name| name.eq_ignore_ascii_case("STRUCTURED_POINTS"))
    };
    let mut grid = Grid::default();
    while let Some(line) = lines.read_line().map_err(io_error(path))? {
        let words: Vec<&str> = line.split_whitespace().collect();
        let Some(keyword) = words.first() else { continue };
        match keyword.to_ascii_uppercase().as_str() {
            "ASCII" => grid.text = Some(true),
            "BINARY" => grid.text = Some(false),
            "DATASET" if is_structured_points(words.get(1)) => grid.named = true,
            "DATASET" => {
                return Err(fail(Reason::unsupported(
                    format!(
                        "holds a dataset {}: of legacy VTK files only STRUCTURED_POINTS are read as volumes",
                        words.get(1).unwrap_or(&"without a name")
                    ),
                    "convert it first",
                )));
            }
            "DIMENSIONS" => grid.dims = Some(numbers(path, &words)?),
            "ORIGIN" => grid.origin = numbers(path, &words)?,
            "SPACING" | "ASPECT_RATIO" => grid.spacing = numbers(path, &words)?,
            // VTK writes the matrix row by row.
            "DIRECTION" => {
                let rows: [f64; 9] = numbers(path, &words)?;
                grid.direction = [0, 1, 2].map(|r| [0, 1, 2].map(|c| rows[3 * r + c]));
            }
            // Field data of the whole dataset, such as its time.
            "FIELD" | "METADATA" => {
                let text = grid.text.ok_or_else(no_text)?;
                arrays::pass_section(path, lines, &line, text)?;
            }
            "POINT_DATA" | "CELL_DATA" => {
                let text = grid.text.ok_or_else(no_text)?;
                return Ok((grid, arrays::find(path, lines, &line, text)?));
            }
            other => {
                return Err(fail(Reason::header(format!(
                    "has {other:?} where POINT_DATA or CELL_DATA are expected"
                ))));
            }
        }
    }
    Err(fail(Reason::claims_more(arrays::NO_SCALARS)))
}

struct Grid {
    text: Option<bool>,
    named: bool,
    dims: Option<[f64; 3]>,
    origin: [f64; 3],
    spacing: [f64; 3],
    direction: [[f64; 3]; 3],
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
        }
    }
}

impl Grid {
    fn layout(&self, path: &Path, array: &Array) -> Result<Layout, VolumeError> {
        let damaged = |what: &str| {
            format_error(path, Reason::header(format!("has no {what} line before its samples")))
        };
        let text = self.text.ok_or_else(|| damaged("ASCII or BINARY"))?;
        if !self.named {
            return Err(damaged("DATASET"));
        }
        let dims = self.dims.ok_or_else(|| damaged("DIMENSIONS"))?;
        if dims.iter().any(|&size| size < 0.0 || size.fract() != 0.0) {
            return Err(format_error(
                path,
                Reason::header(format!("has DIMENSIONS {dims:?}: they are not sizes")),
            ));
        }
        let mut dims = dims.map(|size| size as u64);
        let axes = [0, 1, 2].map(|c| [0, 1, 2].map(|r| self.direction[r][c] * self.spacing[c]));
        let mut origin = self.origin;
        if array.cells {
            to_centres(&mut dims, &mut origin, axes);
        }
        let encoding = if text { Encoding::Text } else { Encoding::Raw };
        let frame = frame(path, origin, axes, Coordinates::default())?;
        let dims = Dims::new(dims[0], dims[1], dims[2])?;
        let dtype = arrays::scalar(path, &array.kind, array.components)?;
        let (endian, frames) = (Endian::Big, FrameChoice::ONE);
        Ok(Layout { dims, dtype, endian, frame, encoding, frames })
    }
}

/// Moves a grid from its points to the centres of its cells. Along an axis of one point, cells have no thickness.
pub(super) fn to_centres(dims: &mut [u64; 3], origin: &mut [f64; 3], axes: [[f64; 3]; 3]) {
    for (size, axis) in dims.iter_mut().zip(axes).filter(|(size, _)| **size > 1) {
        *size -= 1;
        for (component, step) in origin.iter_mut().zip(axis) {
            *component += 0.5 * step;
        }
    }
}

/// The numbers after a keyword.
fn numbers<const N: usize>(path: &Path, words: &[&str]) -> Result<[f64; N], VolumeError> {
    let numbers: Option<Vec<f64>> = words[1..].iter().map(|word| word.parse().ok()).collect();
    numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| {
        format_error(
            path,
            Reason::header(format!("has {:?}, which is not {N} numbers", words.join(" "))),
        )
    })
}

/// The end of the text of numbers: the end of the text, or a line that begins with a keyword.
fn end_of_numbers(text: &[u8]) -> usize {
    let mut start = 0;
    for line in text.split_inclusive(|&byte| byte == b'\n') {
        if arrays::begins_section(line) {
            return start;
        }
        start += line.len();
    }
    text.len()
}

/// Whether a keyword follows, or nothing but white space.
fn at_keyword(reader: &mut impl BufRead) -> std::io::Result<bool> {
    let mut rest = Vec::new();
    reader.take(4096).read_to_end(&mut rest)?;
    let rest = rest.trim_ascii_start();
    Ok(rest.is_empty() || arrays::begins_section(rest))
}
