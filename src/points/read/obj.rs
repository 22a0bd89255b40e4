use std::io::BufReader;
use std::path::Path;

use super::off::position;
use super::{Points, PointsError};
use crate::volume::{Lines, io_error};

/// Reads the vertices (`v x y z …`) of a Wavefront OBJ file; everything else is passed over.
pub(crate) fn read(path: &Path) -> Result<Points, PointsError> {
    let file = std::fs::File::open(path).map_err(io_error(path))?;
    let mut lines = Lines::new(BufReader::new(file));
    let mut points = Points::default();
    let mut number = 0;
    while let Some(line) = lines.next().map_err(io_error(path))? {
        number += 1;
        let mut words = line.split_whitespace();
        if words.next() == Some("v") {
            points.positions.push(position(path, number, words)?);
        }
    }
    Ok(points)
}
