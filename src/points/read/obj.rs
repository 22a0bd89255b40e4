use super::off::position;
use super::{CellCount, Points, PointsError};
use crate::volume::{Lines, OpenFile, io_error};

/// Reads the vertices (`v x y z …`) of a Wavefront OBJ file; everything else is skipped.
pub(crate) fn read(file: &OpenFile) -> Result<Points, PointsError> {
    let path = file.path();
    let mut lines = Lines::new(file.reader()?);
    let mut points = Points::default();
    let mut number = 0;
    while let Some(line) = lines.read_line().map_err(io_error(path))? {
        number += 1;
        let mut words = line.split_whitespace();
        if words.next() == Some("v") {
            points.positions.push(position(path, number, words)?);
        }
    }
    Ok(points)
}

/// The numbers of faces and lines.
pub(crate) fn cells(file: &OpenFile) -> Result<Vec<CellCount>, PointsError> {
    let mut lines = Lines::new(file.reader()?);
    let mut counts = [CellCount::new("faces", 0), CellCount::new("lines", 0)];
    while let Some(line) = lines.read_line().map_err(io_error(file.path()))? {
        match line.split_whitespace().next() {
            Some("f") => counts[0].count += 1,
            Some("l") => counts[1].count += 1,
            _ => {}
        }
    }
    Ok(counts.into())
}
