//! Points in legacy VTK files: those of polygons, unstructured grids and curved grids.

use std::io::{BufRead, Read};
use std::path::Path;

use walpha_base::Monitor;

use super::legacy_arrays::{self as arrays, Array, CellList, POINTS};
use crate::error::{format_error, io_error};
use crate::formats::is_vtk;
use crate::read::OpenFile;
use crate::read::payload::{Length, Payload, payload_error_of};
use crate::read::text::{self, Lines};
use crate::{Endian, Reason, VolumeError};

/// The datasets that list their points.
const LISTED: [&str; 3] = ["POLYDATA", "UNSTRUCTURED_GRID", "STRUCTURED_GRID"];

/// A legacy VTK file that lists points.
pub struct VtkPoints<'a> {
    file: &'a OpenFile,
    text: bool,
    arrays: Vec<Array>,
    /// The numbers of cells by kind, except vertices.
    pub cells: Vec<CellList>,
}

/// The first lines of a legacy VTK file.
struct Preamble {
    /// Whether cells are stored as two arrays, as from version 5 on.
    offsets: bool,
    text: bool,
    dataset: String,
}

impl<'a> VtkPoints<'a> {
    /// Whether a file lists points.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn lists_points(file: &OpenFile) -> Result<bool, VolumeError> {
        let preamble = preamble(file.path(), &mut Lines::new(file.reader()?))?;
        Ok(LISTED.contains(&preamble.dataset.as_str()))
    }

    /// Finds the points and their data.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn open(file: &'a OpenFile) -> Result<Self, VolumeError> {
        let path = file.path();
        let mut lines = Lines::new(file.reader()?);
        let Preamble { offsets, text, dataset } = preamble(path, &mut lines)?;
        if !LISTED.contains(&dataset.as_str()) {
            let what = format!("holds {dataset}: points are read from {}", LISTED.join(", "));
            return Err(format_error(path, Reason::unsupported(what, "convert it first")));
        }
        let (arrays, cells) = arrays::find_all(path, &mut lines, text, offsets)?;
        match arrays.first() {
            Some(Array { name, components: 3, .. }) if name == POINTS => {
                Ok(Self { file, text, arrays, cells })
            }
            _ => Err(format_error(path, Reason::damaged("has no POINTS: it is damaged"))),
        }
    }

    /// The number of points.
    fn count(&self) -> u64 {
        self.arrays[0].values / 3
    }

    /// The coordinates, three for each point.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn coordinates(&self) -> Result<Vec<f64>, VolumeError> {
        self.values(&self.arrays[0])
    }

    /// The numbers of the points in the array with this name, in any letter case.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn named(&self, name: &str) -> Result<Option<Vec<f64>>, VolumeError> {
        self.one(|array| array.name.eq_ignore_ascii_case(name))
    }

    /// The numbers of the points in the first active scalars whose name is not in `but`.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn active(&self, but: &[&str]) -> Result<Option<Vec<f64>>, VolumeError> {
        let is_among = |name: &str| but.iter().any(|but| but.eq_ignore_ascii_case(name));
        self.one(|array| array.active && !is_among(&array.name))
    }

    fn one(&self, is_it: impl Fn(&Array) -> bool) -> Result<Option<Vec<f64>>, VolumeError> {
        let mut of_points = self.arrays[1..].iter().filter(|a| !a.cells && a.components == 1);
        of_points.find(|array| is_it(array)).map(|array| self.values(array)).transpose()
    }

    fn values(&self, array: &Array) -> Result<Vec<f64>, VolumeError> {
        let (path, count) = (self.file.path(), array.values);
        if count != self.count().saturating_mul(array.components) {
            let (name, points) = (&array.name, self.count());
            let what = format!("has {count} values {name} for {points} points");
            return Err(format_error(path, Reason::header(what)));
        }
        let dtype = arrays::scalar(path, &array.kind, 1)?;
        let reader = self.file.reader_at(array.start)?;
        let left = array.end.unwrap_or(self.file.length()).saturating_sub(array.start);
        if self.text {
            return text::numbers(path, reader.take(left), left, dtype, count)
                .map_err(|reason| format_error(path, reason));
        }
        let bytes = count.saturating_mul(dtype.size() as u64).min(left);
        let length = Length::Exactly(bytes);
        let payload = Payload { reader: reader.take(bytes), length };
        let claim = format!("{count} numbers {} of type {dtype}", array.name);
        payload
            .samples(path, dtype, Endian::Big, count, &Monitor::noop())
            .map_err(|error| payload_error_of(path, &claim, error))
    }
}

/// Reads up to the line that names the dataset.
fn preamble(path: &Path, lines: &mut Lines<impl BufRead>) -> Result<Preamble, VolumeError> {
    let mut next = || lines.read_line().map_err(io_error(path));
    let first = next()?.unwrap_or_default();
    if !is_vtk(first.as_bytes()) {
        let what = "is not a legacy VTK file: it does not begin with # vtk DataFile";
        return Err(format_error(path, Reason::other(what)));
    }
    let version = first.split_whitespace().next_back().and_then(|word| word.parse::<f64>().ok());
    let offsets = version.is_some_and(|version| version >= 5.0);
    // This line is the title.
    next()?;
    let mut text = None;
    while let Some(line) = next()? {
        let words: Vec<String> = line.split_whitespace().map(str::to_ascii_uppercase).collect();
        match (words.first().map(String::as_str), words.get(1), text) {
            (Some("ASCII"), ..) => text = Some(true),
            (Some("BINARY"), ..) => text = Some(false),
            (Some("DATASET"), Some(dataset), Some(text)) => {
                return Ok(Preamble { offsets, text, dataset: dataset.clone() });
            }
            (None, ..) => {}
            _ => break,
        }
    }
    let what = "has no line ASCII or BINARY, or no line DATASET, where these belong";
    Err(format_error(path, Reason::header(what)))
}
