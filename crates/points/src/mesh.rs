//! The mesh cells that a file of points may list: counts them, and reads them as a complex.

use std::path::Path;

use walpha_check::meshes::Mesh;

use super::read::{format, no_complex};
use super::{CellCount, PointOptions, PointsError};
use walpha_volume::{OpenFile, Reason};

/// The cells that a file lists besides its points, by kind; empty for plain points.
///
/// # Errors
/// The file cannot be read, or its header is damaged.
pub fn cells_of(
    path: impl AsRef<Path>,
    options: &PointOptions,
) -> Result<Vec<CellCount>, PointsError> {
    let path = path.as_ref();
    // Without a regular file only the name is known. If its format has no cells, the error is left to the reader.
    let named = || options.format_named(path);
    if !path.is_file() && named().is_none_or(|format| format.cells.is_none()) {
        return Ok(Vec::new());
    }
    cells_of_file(&OpenFile::open(path)?, options)
}

/// Like [`cells_of`], for an open file.
///
/// # Errors
/// See [`cells_of`].
pub fn cells_of_file(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<Vec<CellCount>, PointsError> {
    let Some(count) = options.format_of(file).and_then(|format| format.cells) else {
        return Ok(Vec::new());
    };
    if !file.is_ordinary() {
        let what = "is not an ordinary file, and its cells are counted in a pass of their own";
        return Err(format(file.path(), Reason::unsupported(what, "copy it into one")));
    }
    Ok(count(file)?.into_iter().filter(|cells| cells.count > 0).collect())
}

/// Reads the cells of a file as a complex for the checker. In VTU, legacy VTK and PLY these are the tetrahedra, with the point
/// data `weight`, and α is ∞. If a VTK file states α, they are the simplices of all dimensions, with their classes. Formats whose
/// files contain nothing but meshes are read by [`walpha_check::meshes`].
///
/// # Errors
/// The cells of the format are not read, or cells are not simplices; and the errors of [`super::read_points`].
pub fn read_complex(path: impl AsRef<Path>, options: &PointOptions) -> Result<Mesh, PointsError> {
    read_complex_file(&OpenFile::open(path.as_ref())?, options)
}

/// Like [`read_complex`], for an open file.
///
/// # Errors
/// See [`read_complex`].
pub fn read_complex_file(file: &OpenFile, options: &PointOptions) -> Result<Mesh, PointsError> {
    if let Some(read) = options.format_of(file).and_then(|format| format.read_complex) {
        return read(file);
    }
    Err(no_complex(file.path()))
}
