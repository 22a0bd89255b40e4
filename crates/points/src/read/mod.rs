//! Readers of the formats of points.

mod cell;
mod cif;
mod columns;
pub(super) mod content;
#[cfg(feature = "las")]
mod crs;
mod crystal;
mod dialect;
mod extended;
pub(super) mod gro;
mod header;
mod lammps;
pub(super) mod lammps_data;
pub(super) mod lammps_dump;
#[cfg(feature = "las")]
pub(super) mod las;
#[cfg(feature = "las")]
pub(super) mod las_fields;
#[cfg(feature = "las")]
mod laz;
mod lines;
pub(super) mod mmcif;
pub(super) mod npy;
pub(super) mod obj;
pub(super) mod off;
pub(super) mod pcd;
pub(super) mod pdb;
pub(super) mod ply;
pub(super) mod poscar;
pub(super) mod pqr;
mod rows;
pub(super) mod stated;
pub(super) mod stl;
mod symmetry;
pub(super) mod text;
pub(super) mod vtk;
pub(super) mod xyz;

pub(super) use columns::COLUMNS;
use columns::RADIUS;
pub use columns::{Columns, UnknownColumns};

use std::path::Path;

use walpha_base::advice::{Advise, Setting, advice};
use walpha_base::shown::shown;
use walpha_check::meshes::MeshError;

use super::CellCount;
use super::{Points, PointsError};
use walpha_volume::Reason;

/// The error for a file of points.
pub(super) fn format(path: &Path, reason: Reason) -> PointsError {
    PointsError::Format { path: path.into(), reason }
}

/// The index of the frame that is asked for.
///
/// # Errors
/// There is no such frame; or none is asked for, and there are several.
fn choose_frame(path: &Path, count: usize, asked: Option<u64>) -> Result<usize, PointsError> {
    let last = count - 1;
    let several = match asked {
        None if count == 1 => return Ok(0),
        Some(frame) if frame <= last as u64 => return Ok(frame as usize),
        Some(frame) => format!("has no frame {frame}: it holds {count}"),
        None => format!("holds {count} frames: scans, or steps of a trajectory"),
    };
    let advice = advice!["choose one with ", Setting::Frame, format!(", from 0 to {last}")];
    Err(format(path, Reason::choice(Setting::Frame, several, advice)))
}

/// The index of the frame of a trajectory that is asked for, or else the first.
///
/// # Errors
/// There is no such frame.
fn first_frame(path: &Path, count: usize, asked: Option<u64>) -> Result<usize, PointsError> {
    if asked.is_none() && count > 1 {
        tracing::warn!(
            "{}: it holds {count} frames, of which the first is read; `frame` takes another",
            shown(path)
        );
    }
    choose_frame(path, count, asked.or(Some(0)))
}

/// The error for a mesh that the checker's reader refuses.
fn mesh_error(path: &Path, error: &MeshError) -> PointsError {
    let advice = error.advice().unwrap_or_else(|| "write the file again".into());
    format(path, Reason::content(error.to_string(), advice))
}

/// The error for a file whose cells are not simplices, which the checker requires.
pub(super) fn no_complex(path: &Path) -> PointsError {
    let reason = Reason::unsupported(
        "its cells cannot be read as a complex",
        "give a complex as .json or .npz, or a mesh of tetrahedra as .vtu, .vtk or .ply (docs/cross-checking.md)",
    );
    format(path, reason)
}

/// Sets the weights to the squares of radii, unless the file has weights.
pub(super) fn take_radii(
    path: &Path,
    points: &mut Points,
    radii: Option<Vec<f64>>,
) -> Result<(), PointsError> {
    let Some(radii) = radii else { return Ok(()) };
    if points.weights.is_some() {
        tracing::warn!("{} has weights and radii: the weights are taken", shown(path));
        return Ok(());
    }
    let wrong = |radius: &f64| !(*radius >= 0.0 && (radius * radius).is_finite());
    if let Some(row) = radii.iter().position(wrong) {
        let radius = radii[row];
        let what = format!(
            "row {row}: radius is {radius}, and must be from 0 up, with a square that is finite"
        );
        return Err(format(path, Reason::value(what)));
    }
    points.weights = Some(radii.iter().map(|radius| radius * radius).collect());
    points.of_radii = true;
    Ok(())
}
