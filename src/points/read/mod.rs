//! Points from files: by what the file holds first, then by its extension.

mod columns;
#[cfg(feature = "las")]
pub(super) mod las;
pub(super) mod npy;
#[cfg(feature = "formats")]
pub(super) mod obj;
#[cfg(feature = "formats")]
pub(super) mod off;
#[cfg(feature = "formats")]
pub(super) mod pcd;
#[cfg(feature = "formats")]
pub(super) mod ply;
#[cfg(feature = "formats")]
mod rows;
#[cfg(feature = "formats")]
pub(super) mod stl;
#[cfg(feature = "formats")]
pub(super) mod table;
#[cfg(feature = "formats")]
pub(super) mod vtk;
#[cfg(feature = "formats")]
pub(super) mod xyz;

pub use columns::{Columns, UnknownColumns};

use std::path::Path;

use super::formats::{FORMATS, PointFormat};
use super::{ModelFacts, Points, PointsError};
use crate::advice::Setting;
use crate::volume::{Reason, start_of};

/// The columns of a point file that are read.
const COLUMNS: [&str; 5] = ["x", "y", "z", "weight", "value"];

/// Whether a file holds points rather than a volume, by its content or else by its extension
/// ([`FORMATS`](super::FORMATS)); NPY files do where their array has two axes, VTK's XML where it is
/// geometry.
///
/// # Errors
/// A file that begins as NPY or VTK's XML does and cannot be read.
pub fn is_point_file(path: &Path) -> Result<bool, PointsError> {
    found(path)?.map_or(Ok(false), |format| format.holds_points(path))
}

/// Reads points, with their weights and values where the file has such columns. Points are counted
/// from 0.
///
/// - CSV, TSV (fields between commas, semicolons or tabs) and XYZ (between white space): the first line
///   may name the columns: x, y, z, optionally weight and value, in any order and case; others
///   are skipped. Without names, `columns` gives them; without both, x y z are read, followed by a
///   value, or by a normal or a colour, which are skipped. XYZ may be atoms as chemistry
///   writes them, too.
/// - PWN: as XYZ; or the number of points, the points, and as many normals.
/// - OFF, OBJ, STL: the vertices; of STL each place once.
/// - PCD: the fields x, y, z, optionally weight, and value or else intensity.
/// - LAS and LAZ: coordinates, and the intensity as value.
/// - PLY (text, or binary of either byte order), VTU and VTP: the vertices, with their properties or
///   point data `weight` and `value`; VTK's active scalars are the values where none are named so.
/// - NPY: an array n×4 (x, y, z, weight) or n×5 (x, y, z, weight, value).
/// - WVM: all layers ([`read_model`] knows more).
///
/// # Errors
/// The file cannot be read, is truncated or longer than it claims, a column is missing or named twice,
/// a number is not finite (the message has its place), the file holds no point, or `columns` are given for
/// a format that names its own.
pub fn read_points(path: &Path, columns: Option<&Columns>) -> Result<Points, PointsError> {
    Ok(read_model(path, columns, None)?.0)
}

/// Reads points with what is known of them besides; nothing, where their format keeps nothing. `level`
/// says how many of the last layers of a `.wvm` are left out: each level is a coarser model, of a quarter
/// of the points.
///
/// # Errors
/// As [`read_points`], and a level that the file does not have.
pub fn read_model(
    path: &Path,
    columns: Option<&Columns>,
    level: Option<u32>,
) -> Result<(Points, ModelFacts), PointsError> {
    let known = found(path)?.unwrap_or(&FORMATS[0]);
    if columns.is_some() && !known.takes_columns {
        let reason = Reason::needless(Setting::Columns, "says itself what its columns are");
        return Err(format(path, reason));
    }
    if level.is_some() && !known.has_levels() {
        let reason = Reason::needless(Setting::Level, "has no layers of points");
        return Err(format(path, reason));
    }
    let (points, facts) = known.read(path, columns, level.unwrap_or_default())?;
    if points.is_empty() {
        return Err(format(
            path,
            Reason::content("holds no point: there is nothing to shape", "name another file"),
        ));
    }
    finite(path, &points)?;
    Ok((points, facts))
}

/// The format of a file, by its content and then its extension.
fn found(path: &Path) -> Result<Option<&'static PointFormat>, PointsError> {
    if path.is_file() {
        let start = start_of(path)?;
        if let Some(format) = FORMATS.iter().find(|format| format.begins(&start)) {
            return Ok(Some(format));
        }
    }
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    let named = |format: &&PointFormat| format.extensions.iter().any(|e| extension == *e);
    Ok(FORMATS.iter().find(named))
}

pub(super) fn format(path: &Path, reason: Reason) -> PointsError {
    PointsError::Format { path: path.into(), reason }
}

/// Refuses NaN and infinities.
fn finite(path: &Path, points: &Points) -> Result<(), PointsError> {
    for (row, position) in points.positions.iter().enumerate() {
        let [weight, value] =
            [&points.weights, &points.values].map(|column| column.as_ref().map_or(0.0, |c| c[row]));
        let numbers = [position[0], position[1], position[2], weight, value];
        if let Some(column) = numbers.iter().position(|number| !number.is_finite()) {
            let (name, value) = (COLUMNS[column], numbers[column]);
            let reason =
                Reason::value(format!("row {row}: {name} is {value}, and must be a finite number"));
            return Err(format(path, reason));
        }
    }
    Ok(())
}
