//! Finds the arrays of a legacy VTK file before one is read.

use std::io::BufRead;
use std::path::Path;

use crate::error::{format_error, io_error};
use crate::read::text::Lines;
use crate::{Dtype, Reason, VolumeError};

/// The keywords that begin a section after the grid. VTK reads them in any letter case.
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

/// Whether a text begins with a keyword.
pub(super) fn begins_section(text: &[u8]) -> bool {
    KEYWORDS.iter().any(|keyword| {
        let start = text.get(..keyword.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(keyword.as_bytes()))
    })
}

/// The error for a file that contains only a grid.
pub(super) const NO_SCALARS: &str = "ends before any SCALARS: it is truncated, or holds no samples";

/// The name of the array of positions.
pub(super) const POINTS: &str = "POINTS";

/// The type of texts.
const TEXTS: &str = "string";

/// An array of points or cells.
#[expect(clippy::struct_excessive_bools, reason = "each is an answer of its own")]
pub(super) struct Array {
    pub name: String,
    pub cells: bool,
    /// The number of values for each point or cell.
    pub components: u64,
    /// The number of values in all.
    pub values: u64,
    /// The type by its name in VTK.
    pub kind: String,
    /// Whether the array is `COLOR_SCALARS`, VTK's name for bytes, which are shares of 255 in text.
    pub colours: bool,
    /// Whether the array is `SCALARS`, VTK's name for the data to show.
    pub active: bool,
    /// The positions of the first value and of the end of the values, as far as it is known.
    pub start: u64,
    pub end: Option<u64>,
    /// Whether no other array follows without a keyword before it.
    pub last: bool,
}

/// Finds the arrays. `line` begins the data of points or cells.
///
/// After the first array, the scan ends at anything that cannot be parsed, with a warning. Texts are not samples, and are found
/// only if there is nothing else.
pub(super) fn find(
    path: &Path,
    lines: &mut Lines<impl BufRead>,
    line: &str,
    text: bool,
) -> Result<Vec<Array>, VolumeError> {
    let mut scanner = Scanner::new(path, lines, text, false);
    scanner.all(Some(line.to_owned()))?;
    let mut found = scanner.found;
    if found.iter().any(|array| array.kind != TEXTS) {
        found.retain(|array| array.kind != TEXTS);
    }
    Ok(found)
}

/// Skips a section of the whole dataset, which `line` begins.
pub(super) fn pass_section(
    path: &Path,
    lines: &mut Lines<impl BufRead>,
    line: &str,
    text: bool,
) -> Result<(), VolumeError> {
    Scanner::new(path, lines, text, false).section(line).map(|_| ())
}

/// The number of cells that a keyword lists, with its name in the plural.
pub(super) type CellList = (&'static str, u64);

/// Finds the positions and the arrays behind the line DATASET, and the cells, except single points. If cells are stored as
/// `offsets` and corners, as from version 5 on, each of these is a separate array.
pub(super) fn find_all(
    path: &Path,
    lines: &mut Lines<impl BufRead>,
    text: bool,
    offsets: bool,
) -> Result<(Vec<Array>, Vec<CellList>), VolumeError> {
    let line = lines.read_line().map_err(io_error(path))?;
    let mut scanner = Scanner::new(path, lines, text, offsets);
    scanner.all(line)?;
    Ok((scanner.found, scanner.listed))
}

struct Scanner<'a, R> {
    path: &'a Path,
    lines: &'a mut Lines<R>,
    text: bool,
    /// Whether cells are stored as two arrays.
    offsets: bool,
    /// The lengths of these two arrays.
    lists: [u64; 2],
    cells: bool,
    /// The number of points or cells.
    count: u64,
    found: Vec<Array>,
    listed: Vec<CellList>,
}

impl<'a, R: BufRead> Scanner<'a, R> {
    fn new(path: &'a Path, lines: &'a mut Lines<R>, text: bool, offsets: bool) -> Self {
        let (lists, cells, count, found, listed) = ([0; 2], false, 0, Vec::new(), Vec::new());
        Self { path, lines, text, offsets, lists, cells, count, found, listed }
    }

    /// Finds all arrays, starting from a line.
    fn all(&mut self, mut line: Option<String>) -> Result<(), VolumeError> {
        let scanner = self;
        let path = scanner.path;
        while let Some(words) = line {
            let next = match scanner.section(&words) {
                Ok(true) => scanner.lines.read_line().map_err(io_error(path)),
                Ok(false) => Err(format_error(path, not_understood(&words))),
                Err(error) => Err(error),
            };
            line = match next {
                Err(error) if !scanner.found.is_empty() => {
                    tracing::warn!("what follows is passed over: {error}");
                    break;
                }
                next => next?,
            };
        }
        if scanner.found.is_empty() {
            let reason = Reason::claims_more(NO_SCALARS);
            return Err(format_error(path, reason));
        }
        Ok(())
    }

    /// Skips the section that a line begins; returns `false` if it does not begin a known section.
    fn section(&mut self, line: &str) -> Result<bool, VolumeError> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let Some(keyword) = words.first() else { return Ok(true) };
        let word = |i: usize| words.get(i).copied().unwrap_or("(missing)");
        let number = |i: usize| word(i).parse::<u64>().unwrap_or(0);
        let keyword = keyword.to_ascii_uppercase();
        match keyword.as_str() {
            "POINT_DATA" | "CELL_DATA" => {
                (self.cells, self.count) = (keyword == "CELL_DATA", number(1));
            }
            "SCALARS" => {
                let components = words.get(3).map_or(Some(1), |n| n.parse().ok()).unwrap_or(0);
                let mut next = || self.lines.read_line().map_err(io_error(self.path));
                let mut table = next()?;
                while table.as_deref().is_some_and(|line| line.trim().is_empty()) {
                    table = next()?;
                }
                let table = table.unwrap_or_default();
                if !table.trim_start().to_ascii_uppercase().starts_with("LOOKUP_TABLE") {
                    let what = format!("has no LOOKUP_TABLE line below SCALARS {}", word(1));
                    return Err(format_error(self.path, Reason::header(what)));
                }
                self.array(word(1), word(2), components, self.count, true)?;
                if let Some(array) = self.found.last_mut() {
                    array.active = true;
                }
            }
            // Sections between the line DATASET and the data of points.
            POINTS => {
                // What comes before is field data of the whole dataset.
                self.found.clear();
                self.array(POINTS, word(2), 3, number(1), true)?;
            }
            "DIMENSIONS" => {}
            "VERTICES" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" | "CELLS" => {
                let [first, second] = [number(1), number(2)];
                // The numbers of offsets and corners, or of cells and of all numbers in their lists.
                let (cells, corners) = if self.offsets {
                    (first.saturating_sub(1), second)
                } else {
                    (first, second.saturating_sub(first))
                };
                let kind = match keyword.as_str() {
                    "LINES" => Some("lines"),
                    "POLYGONS" => Some("polygons"),
                    "TRIANGLE_STRIPS" => Some("strips"),
                    "CELLS" if corners > cells => Some("cells"),
                    _ => None,
                };
                self.listed.extend(kind.map(|kind| (kind, cells)));
                if self.offsets {
                    self.lists = [first, second];
                } else {
                    self.pass("int", second)?;
                }
            }
            "OFFSETS" => self.pass(word(1), self.lists[0])?,
            "CONNECTIVITY" => self.pass(word(1), self.lists[1])?,
            "CELL_TYPES" => self.pass("int", number(1))?,
            "COLOR_SCALARS" => {
                self.array(word(1), "unsigned_char", number(2), self.count, true)?;
                if let Some(array) = self.found.last_mut() {
                    array.colours = true;
                }
            }
            "LOOKUP_TABLE" => self.pass("unsigned_char", number(2) * 4)?,
            "VECTORS" | "NORMALS" => self.array(word(1), word(2), 3, self.count, true)?,
            "TENSORS" => self.array(word(1), word(2), 9, self.count, true)?,
            "TENSORS6" => self.array(word(1), word(2), 6, self.count, true)?,
            "TEXTURE_COORDINATES" => self.array(word(1), word(3), number(2), self.count, true)?,
            "GLOBAL_IDS" | "PEDIGREE_IDS" => self.array(word(1), word(2), 1, self.count, true)?,
            "FIELD" => return self.field(number(2)),
            "METADATA" => {
                let mut next = || self.lines.read_line().map_err(io_error(self.path));
                while next()?.is_some_and(|line| !line.is_empty()) {}
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Finds `count` arrays, each with a line of its own. VTK writes all data here except its active attribute.
    fn field(&mut self, count: u64) -> Result<bool, VolumeError> {
        let mut left = count;
        while left > 0 {
            let line = self.lines.read_line().map_err(io_error(self.path))?.unwrap_or_default();
            if line.is_empty() {
                // VTK ends the metadata of an array with an empty line; at the end of a file that line may be missing.
                if self.lines.at_end().map_err(io_error(self.path))? {
                    break;
                }
                continue;
            }
            if line.to_ascii_uppercase().starts_with("METADATA") {
                self.section(&line)?;
                continue;
            }
            let words: Vec<&str> = line.split_whitespace().collect();
            let &[name, components, count, kind] = words.as_slice() else {
                let what = format!("has a FIELD with a line {line:?}, which is not an array");
                let reason = Reason::header(what);
                return Err(format_error(self.path, reason));
            };
            let [components, count] = [components, count].map(|n| n.parse().unwrap_or(0));
            left -= 1;
            self.array(name, kind, components, count, left == 0)?;
        }
        Ok(true)
    }

    fn array(
        &mut self,
        name: &str,
        kind: &str,
        components: u64,
        count: u64,
        last: bool,
    ) -> Result<(), VolumeError> {
        let values = components.saturating_mul(count);
        let start = self.lines.bytes();
        let (name, kind) = (name.to_owned(), kind.to_ascii_lowercase());
        let (cells, colours, active, end) = (self.cells, false, false, None);
        let array =
            Array { name, cells, components, values, kind, colours, active, start, end, last };
        let kind = array.kind.clone();
        self.found.push(array);
        self.pass(&kind, values)?;
        if let (true, Some(array)) = (self.text, self.found.last_mut()) {
            array.end = Some(self.lines.bytes());
        }
        Ok(())
    }

    /// Skips `values` numbers or texts.
    fn pass(&mut self, kind: &str, values: u64) -> Result<(), VolumeError> {
        let kind = kind.to_ascii_lowercase();
        let kind = kind.as_str();
        if kind == TEXTS {
            return self.pass_texts(values).map_err(io_error(self.path));
        }
        if !self.text {
            let bytes = match kind {
                "bit" => values.div_ceil(8),
                _ => values.saturating_mul(scalar(self.path, kind, 1)?.size() as u64),
            };
            return self.lines.skip(bytes).map_err(io_error(self.path));
        }
        let mut left = values;
        while left > 0 {
            let Some(line) = self.lines.read_line().map_err(io_error(self.path))? else { break };
            left = left.saturating_sub(line.split_whitespace().count() as u64);
        }
        Ok(())
    }

    /// Skips texts: lines, or in binary files each preceded by its length, which has 6, 14, 30 or 62 bits according to the first
    /// two bits of the first byte (vtkDataWriter.cxx).
    fn pass_texts(&mut self, count: u64) -> std::io::Result<()> {
        for _ in 0..count {
            if self.lines.at_end()? {
                break;
            }
            if self.text {
                self.lines.read_line()?;
                continue;
            }
            let first = self.lines.byte()?;
            let more = match first >> 6 {
                3 => 0,
                2 => 1,
                1 => 3,
                _ => 7,
            };
            let mut length = u64::from(first & 0x3f);
            for _ in 0..more {
                length = length << 8 | u64::from(self.lines.byte()?);
            }
            self.lines.skip(length)?;
        }
        Ok(())
    }
}

/// What is wrong with a line that does not begin a section.
fn not_understood(line: &str) -> Reason {
    const SHOWN: usize = 40;
    let line: String = line.chars().take(SHOWN).collect();
    Reason::header(format!("has {line:?} where a section should begin"))
}

/// The type of scalars, by its name in lower case.
pub(super) fn scalar(path: &Path, name: &str, components: u64) -> Result<Dtype, VolumeError> {
    if components != 1 {
        return Err(format_error(
            path,
            Reason::not_scalar(format!("{components} values a voxel"), None),
        ));
    }
    Ok(match name {
        "unsigned_char" => Dtype::U8,
        "char" | "signed_char" => Dtype::I8,
        "unsigned_short" => Dtype::U16,
        "short" => Dtype::I16,
        "unsigned_int" => Dtype::U32,
        // VTK writes its indices as int.
        "int" | "vtkidtype" => Dtype::I32,
        // This is the size on all systems but Windows, where VTK writes vtktypeint64.
        "unsigned_long" | "vtktypeuint64" => Dtype::U64,
        "long" | "vtktypeint64" => Dtype::I64,
        "float" => Dtype::F32,
        "double" => Dtype::F64,
        _ => {
            return Err(format_error(
                path,
                Reason::unsupported(
                    format!("holds samples of type {name}, which is not read"),
                    "convert it first",
                ),
            ));
        }
    })
}
