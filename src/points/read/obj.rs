use std::io::BufReader;
use std::path::Path;

use super::off::position;
use super::{CellCount, Points, PointsError};
use crate::volume::{Lines, io_error};

/// Reads the vertices (`v x y z …`) of a Wavefront OBJ file; everything else is passed over.
pub(crate) fn read(path: &Path) -> Result<Points, PointsError> {
    let file = std::fs::File::open(path).map_err(io_error(path))?;
    let mut lines = Lines::new(BufReader::new(file));
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

/// How many faces and lines there are.
pub(crate) fn cells(path: &Path) -> Result<Vec<CellCount>, PointsError> {
    let file = std::fs::File::open(path).map_err(io_error(path))?;
    let mut lines = Lines::new(BufReader::new(file));
    let mut counts = [CellCount::new("faces", 0), CellCount::new("lines", 0)];
    while let Some(line) = lines.read_line().map_err(io_error(path))? {
        match line.split_whitespace().next() {
            Some("f") => counts[0].count += 1,
            Some("l") => counts[1].count += 1,
            _ => {}
        }
    }
    Ok(counts.into())
}
