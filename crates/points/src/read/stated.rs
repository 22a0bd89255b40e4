//! What a mesh states of its coordinates: axes and unit, as our own writers and 3D Slicer have them.

use super::content::Packed;
use crate::{ModelMetadata, Points, PointsError};
use walpha_volume::{Coordinates, OpenFile, VtkXml, annotation};

/// Bytes of the header of a binary STL.
const STL_HEADER: usize = 80;

/// The first bytes of what a file holds.
fn start(file: &OpenFile) -> Vec<u8> {
    Packed::of(file).map_or_else(|| file.start().to_vec(), |packed| packed.start)
}

/// Points with what comments at the head of their file state. Such a line begins with one of these signs.
pub(crate) fn in_comments(
    file: &OpenFile,
    points: Points,
    signs: &[&str],
) -> (Points, ModelMetadata) {
    let start = start(file);
    let start = String::from_utf8_lossy(&start);
    let lines = start.lines().map(str::trim_start);
    let comments = lines.filter(|line| signs.iter().any(|sign| line.starts_with(sign)));
    let text = comments.collect::<Vec<_>>().join(" ");
    (points, ModelMetadata::default().coordinates(annotation::read(&text)))
}

/// Points with what the header of their STL states, moved back by the offset that was subtracted from them.
pub(crate) fn in_stl(file: &OpenFile, mut points: Points) -> (Points, ModelMetadata) {
    let start = start(file);
    // Text has the name of the solid in its first line.
    let header = start.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let header = String::from_utf8_lossy(&header[..header.len().min(STL_HEADER)]);
    if let Some(offset) = annotation::offset(&header) {
        for place in &mut points.positions {
            *place = [0, 1, 2].map(|k| place[k] + offset[k]);
        }
    }
    (points, ModelMetadata::default().coordinates(annotation::read(&header)))
}

/// Points with what the field data of their VTU or VTP state.
///
/// # Errors
/// The file cannot be read.
pub(crate) fn in_vtk(
    file: &OpenFile,
    points: Points,
) -> Result<(Points, ModelMetadata), PointsError> {
    let file = VtkXml::open(file)?;
    let coordinates: Coordinates = file.coordinates(file.pieces()?.0)?;
    Ok((points, ModelMetadata::default().coordinates(coordinates)))
}
