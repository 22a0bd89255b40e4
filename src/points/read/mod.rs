//! Points from files: by what the file holds first, then by its extension.

mod npy;
mod ply;
mod table;
mod vtk;
mod xyz;

use std::io::Read;
use std::path::Path;

use super::{Points, PointsError};
use crate::volume::{NPY_MAGIC, NpyFile, VtkXml, io_error};

/// The columns of a point file that are read.
const COLUMNS: [&str; 5] = ["x", "y", "z", "weight", "value"];

/// The formats points are read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Table,
    Xyz,
    Ply,
    Vtk,
    Npy,
}

/// Whether a file holds points rather than a volume, by its content or else by its extension: CSV,
/// TSV, XYZ, PLY, VTU, VTP, or an NPY array of two axes.
///
/// # Errors
/// A file that begins as NPY or VTK's XML does and cannot be read.
pub fn is_point_file(path: &Path) -> Result<bool, PointsError> {
    Ok(match kind(path)? {
        None => false,
        Some(Kind::Npy) => NpyFile::open(path)?.shape.len() == 2,
        Some(Kind::Vtk) => vtk::is_geometry(&VtkXml::open(path)?),
        Some(_) => true,
    })
}

/// Reads points, with their weights and values where the file has such columns. Points are counted
/// from 0.
///
/// - CSV and TSV: the first line names the columns, x, y and z among them, perhaps weight and value,
///   in any order and case; other columns are passed over.
/// - XYZ: columns x, y, z and perhaps value between white space, or those that a first line names; or
///   atoms as chemistry writes them.
/// - PLY (text, or binary of either byte order), VTU and VTP: the vertices, with their properties or
///   point data `weight` and `value`; VTK's active scalars are the values where none are named so.
/// - NPY: an array n×4 (x, y, z, weight) or n×5 (x, y, z, weight, value).
///
/// # Errors
/// The file cannot be read, is truncated or longer than it claims, a column is missing or named twice,
/// a number is not finite (the message has its place), or the file holds no point.
pub fn read_points(path: &Path) -> Result<Points, PointsError> {
    let points = match kind(path)? {
        Some(Kind::Npy) => npy::read(path)?,
        Some(Kind::Xyz) => xyz::read(path)?,
        Some(Kind::Ply) => ply::read(path)?,
        Some(Kind::Vtk) => vtk::read(path)?,
        Some(Kind::Table) | None => table::read(path)?,
    };
    if points.is_empty() {
        return Err(format(path, "holds no point: there is nothing to shape".into()));
    }
    finite(path, &points)?;
    Ok(points)
}

fn kind(path: &Path) -> Result<Option<Kind>, PointsError> {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    let of_extension = match extension.to_str() {
        Some("csv" | "tsv") => Some(Kind::Table),
        Some("xyz") => Some(Kind::Xyz),
        Some("ply") => Some(Kind::Ply),
        Some("vtu" | "vtp") => Some(Kind::Vtk),
        _ => None,
    };
    if !path.is_file() {
        return Ok(of_extension);
    }
    let mut start = Vec::new();
    let file = std::fs::File::open(path).map_err(io_error(path))?;
    file.take(1024).read_to_end(&mut start).map_err(io_error(path))?;
    Ok(if start.starts_with(NPY_MAGIC) {
        Some(Kind::Npy)
    } else if start.starts_with(b"ply\n") || start.starts_with(b"ply\r") {
        Some(Kind::Ply)
    } else if VtkXml::is_header(&start) {
        Some(Kind::Vtk)
    } else {
        of_extension
    })
}

fn format(path: &Path, what: String) -> PointsError {
    PointsError::Format { path: path.into(), what }
}

/// Refuses NaN and infinities.
fn finite(path: &Path, points: &Points) -> Result<(), PointsError> {
    for (row, position) in points.positions.iter().enumerate() {
        let [weight, value] =
            [&points.weights, &points.values].map(|column| column.as_ref().map_or(0.0, |c| c[row]));
        let numbers = [position[0], position[1], position[2], weight, value];
        if let Some(column) = numbers.iter().position(|number| !number.is_finite()) {
            let (name, value) = (COLUMNS[column], numbers[column]);
            let what = format!("row {row}: {name} is {value}, and must be a finite number");
            return Err(format(path, what));
        }
    }
    Ok(())
}
