//! What files of points list besides points: cells of meshes, which are read as complexes where they can be.

use std::fmt;
use std::path::Path;

use serde::Serialize;
use walpha_check::schema::ComplexFile;

use super::read::format;
use super::{PointOptions, PointsError};
use crate::volume::{OpenFile, Reason};

/// How many cells of a kind a file lists.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct CellCount {
    /// In the plural: tetrahedra, faces.
    pub kind: &'static str,
    /// How many.
    pub count: usize,
}

/// As in `200 tetrahedra`.
impl fmt::Display for CellCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, count } = self;
        write!(f, "{count} {kind}")
    }
}

impl CellCount {
    #[cfg(feature = "formats")]
    pub(super) fn new(kind: &'static str, count: usize) -> Self {
        Self { kind, count }
    }
}

/// The cells that a file lists besides its points, by kind; none for a list of points alone.
///
/// # Errors
/// A file that cannot be read, or whose header is damaged.
pub fn cells_of(path: &Path, options: &PointOptions) -> Result<Vec<CellCount>, PointsError> {
    // Of what is no file only the name is known; where that promises no cells, the reader says what is wrong.
    let named = || options.format_named(path);
    if !path.is_file() && named().is_none_or(|format| format.cells.is_none()) {
        return Ok(Vec::new());
    }
    let file = OpenFile::open(path)?;
    let cells = match options.format_of(&file).and_then(|format| format.cells) {
        Some(cells) => cells(&file)?,
        None => Vec::new(),
    };
    Ok(cells.into_iter().filter(|cells| cells.count > 0).collect())
}

/// Reads the cells of a file as a complex, to be judged: of VTU, tetrahedra, triangles, edges and vertices, with
/// the point data `weight`, and where walpha wrote the file its α and classes. Otherwise α is ∞.
///
/// # Errors
/// A format whose cells are not read, cells that are no simplices, and what [`super::read_points`] refuses.
pub fn read_complex(path: &Path, options: &PointOptions) -> Result<ComplexFile, PointsError> {
    let file = OpenFile::open(path)?;
    if let Some(read) = options.format_of(&file).and_then(|format| format.read_complex) {
        return read(&file);
    }
    let reason = Reason::unsupported(
        "lists cells that are no tetrahedra of a complex",
        "give a complex as .json, .npz or .vtu (docs/cross-checking.md)",
    );
    Err(format(path, reason))
}
