//! Points from files: by what the file holds first, then by its extension.

mod columns;
mod las;
mod npy;
mod obj;
mod off;
mod pcd;
mod ply;
mod stl;
mod table;
mod vtk;
mod xyz;

pub use columns::{Columns, UnknownColumns};

use std::io::Read;
use std::path::Path;

use walpha_check::npy::MAGIC;

use self::xyz::Counted;
use super::{Points, PointsError};
use crate::volume::{NpyFile, VtkXml, io_error};

/// The columns of a point file that are read.
const COLUMNS: [&str; 5] = ["x", "y", "z", "weight", "value"];

/// The formats points are read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Table,
    Xyz,
    Pwn,
    Ply,
    Off,
    Obj,
    Stl,
    Pcd,
    Las,
    Vtk,
    Npy,
}

/// Whether a file holds points rather than a volume, by its content or else by its extension: CSV,
/// TSV, XYZ, PWN, PLY, OFF, OBJ, STL, PCD, LAS, LAZ, VTU, VTP, or an NPY array of two axes.
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
/// - CSV, TSV (fields between commas, semicolons or tabs) and XYZ (between white space): the first line
///   may name the columns, x, y and z among them, perhaps weight and value, in any order and case; others
///   are passed over. Without names, `columns` tells them; without both, x y z are read, perhaps with a
///   value, with a normal or with a colour behind, which are passed over. XYZ may be atoms as chemistry
///   writes them, too.
/// - PWN: as XYZ; or the number of points, the points, and as many normals.
/// - OFF, OBJ, STL: the vertices; of STL each place once.
/// - PCD: the fields x, y, z, perhaps weight, and value or else intensity.
/// - LAS and LAZ, with the feature `las`: coordinates, and the intensity as value.
/// - PLY (text, or binary of either byte order), VTU and VTP: the vertices, with their properties or
///   point data `weight` and `value`; VTK's active scalars are the values where none are named so.
/// - NPY: an array n×4 (x, y, z, weight) or n×5 (x, y, z, weight, value).
///
/// # Errors
/// The file cannot be read, is truncated or longer than it claims, a column is missing or named twice,
/// a number is not finite (the message has its place), the file holds no point, or `columns` are given for
/// a format that tells its own.
pub fn read_points(path: &Path, columns: Option<&Columns>) -> Result<Points, PointsError> {
    let kind = kind(path)?.unwrap_or(Kind::Table);
    if columns.is_some() && !matches!(kind, Kind::Table | Kind::Xyz | Kind::Pwn) {
        let what = "says itself what its columns are: omit --columns";
        return Err(format(path, what.into()));
    }
    let points = match kind {
        Kind::Npy => npy::read(path)?,
        Kind::Xyz => xyz::read(path, columns, Counted::Atoms)?,
        Kind::Pwn => xyz::read(path, columns, Counted::PointsThenNormals)?,
        Kind::Ply => ply::read(path)?,
        Kind::Off => off::read(path)?,
        Kind::Obj => obj::read(path)?,
        Kind::Stl => stl::read(path)?,
        Kind::Pcd => pcd::read(path)?,
        Kind::Las => las::read(path)?,
        Kind::Vtk => vtk::read(path)?,
        Kind::Table => table::read(path, columns)?,
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
        Some("pwn") => Some(Kind::Pwn),
        Some("ply") => Some(Kind::Ply),
        Some("off") => Some(Kind::Off),
        Some("obj") => Some(Kind::Obj),
        Some("stl") => Some(Kind::Stl),
        Some("pcd") => Some(Kind::Pcd),
        Some("las" | "laz") => Some(Kind::Las),
        Some("vtu" | "vtp") => Some(Kind::Vtk),
        _ => None,
    };
    if !path.is_file() {
        return Ok(of_extension);
    }
    let mut start = Vec::new();
    let file = std::fs::File::open(path).map_err(io_error(path))?;
    file.take(1024).read_to_end(&mut start).map_err(io_error(path))?;
    Ok(if start.starts_with(MAGIC) {
        Some(Kind::Npy)
    } else if start.starts_with(b"ply\n") || start.starts_with(b"ply\r") {
        Some(Kind::Ply)
    } else if VtkXml::is_header(&start) {
        Some(Kind::Vtk)
    } else if start.starts_with(b"LASF") {
        Some(Kind::Las)
    } else if start.starts_with(b"# .PCD") {
        Some(Kind::Pcd)
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
