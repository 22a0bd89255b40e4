//! `.node` and `.ele` of `TetGen` (its manual, section 5.2): points, and cells by the numbers of points.
//!
//! Points are numbered from 0 or from 1, as the first of them shows, and cells must use the same numbering. Files of neighbours
//! (`.neigh`) are not read, because they follow from the cells.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::scan::Scan;
use super::{Mesh, MeshError, no_such_point, not_tetrahedra};

/// Reads both files. One of them is named, and its content is given.
pub(super) fn read(path: &Path, named: &[u8]) -> Result<Mesh, MeshError> {
    let beside = |extension: &str| -> PathBuf {
        let is_it = path.extension().is_some_and(|own| own.eq_ignore_ascii_case(extension));
        if is_it { path.to_owned() } else { path.with_extension(extension) }
    };
    let (of_nodes, of_cells) = (beside("node"), beside("ele"));
    let in_file = |file: &Path, error: MeshError| {
        if file == path { error } else { error.of_file(file) }
    };
    let content = |file: &Path| {
        if file == path { Ok(Cow::Borrowed(named)) } else { open(file).map(Cow::Owned) }
    };
    let nodes = content(&of_nodes).and_then(|bytes| nodes(&bytes));
    let nodes = nodes.map_err(|error| in_file(&of_nodes, error))?;
    let cells = content(&of_cells).and_then(|bytes| cells(&bytes, &nodes));
    let cells = cells.map_err(|error| in_file(&of_cells, error))?;

    let Nodes { points, first, attribute } = nodes;
    let mesh = Mesh::of_cells(points, cells)?.with_decimal_note().with_numbering_note(first);
    Ok(Mesh { attribute, ..mesh })
}

fn open(path: &Path) -> Result<Vec<u8>, MeshError> {
    std::fs::read(path).map_err(|error| {
        let both = ["node", "ele"].map(|extension| {
            path.with_extension(extension)
                .file_name()
                .unwrap_or(OsStr::new(""))
                .to_string_lossy()
                .into_owned()
        });
        MeshError::from(error)
            .with_advice(format!("put {} and {} into one folder", both[0], both[1]))
    })
}

struct Nodes {
    points: Vec<[f64; 3]>,
    /// The number of the first point.
    first: u64,
    /// The first attribute of each point.
    attribute: Option<Vec<f64>>,
}

fn nodes(bytes: &[u8]) -> Result<Nodes, MeshError> {
    let mut scan = Scan::with_comments(bytes);
    let mut words = Vec::new();
    scan.expect_record(&mut words, "the number of points")?;
    // Only the number of points is required, like in `TetGen`.
    let [count, dimension, attributes, markers] = header(&scan, &words, [0, 3, 0, 0])?;
    if dimension != 3 {
        return Err(scan.fault(format!("points have {dimension} coordinates, not 3")));
    }
    let fields = attributes.saturating_add(markers).saturating_add(4);
    let smallest = fields.saturating_mul(2) - 1;
    let mut points = scan.room(count, smallest, "points")?;
    let mut column = scan.room(if attributes > 0 { count } else { 0 }, smallest, "points")?;
    let mut first = 0;
    for row in 0..count {
        scan.expect_record(&mut words, "a point")?;
        has_fields(&scan, &words, fields, "a point")?;
        let number: u64 = scan.value(words[0], "the number of a point")?;
        if row == 0 {
            first = number;
        }
        if first > 1 || number != first + row {
            let expected = if row == 0 { "0 or 1".to_owned() } else { (first + row).to_string() };
            let why = format!("a point has the number {number} where {expected} should be");
            return Err(scan.fault(why).with_advice("number points from 0 or from 1, in order"));
        }
        let coordinate =
            |k: usize| scan.value(words[k], "a coordinate").and_then(|x| scan.finite(x));
        points.push([coordinate(1)?, coordinate(2)?, coordinate(3)?]);
        if attributes > 0 {
            column.push(scan.value(words[4], "an attribute")?);
        }
    }
    at_end(&mut scan, &mut words, "points")?;
    Ok(Nodes { points, first, attribute: (attributes > 0).then_some(column) })
}

fn cells(bytes: &[u8], nodes: &Nodes) -> Result<Vec<[u32; 4]>, MeshError> {
    let mut scan = Scan::with_comments(bytes);
    let mut words = Vec::new();
    scan.expect_record(&mut words, "the number of cells")?;
    let [count, corners, attributes] = header(&scan, &words, [0, 4, 0])?;
    if corners != 4 {
        return Err(not_tetrahedra(&format!("tetrahedra of {corners} nodes")));
    }
    let fields = attributes.saturating_add(5);
    let mut cells = scan.room(count, fields.saturating_mul(2) - 1, "cells")?;
    let first = nodes.first;
    for row in 0..count {
        scan.expect_record(&mut words, "a cell")?;
        has_fields(&scan, &words, fields, "a cell")?;
        let number: u64 = scan.value(words[0], "the number of a cell")?;
        if number != first + row {
            let why = format!(
                "a cell has the number {number} where {} should be: points are numbered from {first}",
                first + row
            );
            return Err(scan
                .fault(why)
                .with_advice("number points and cells alike, from 0 or from 1, in order"));
        }
        let mut cell = [0; 4];
        for (corner, word) in cell.iter_mut().zip(&words[1..]) {
            let number: u64 = scan.value(word, "the number of a point")?;
            let index =
                number.checked_sub(first).filter(|&index| index < nodes.points.len() as u64);
            *corner = index
                .ok_or_else(|| no_such_point(&scan, number, first, nodes.points.len()))?
                as u32;
        }
        cells.push(cell);
    }
    at_end(&mut scan, &mut words, "cells")?;
    Ok(cells)
}

/// The numbers of the first line, with these for missing ones.
fn header<const N: usize>(
    scan: &Scan,
    words: &[&[u8]],
    mut numbers: [u64; N],
) -> Result<[u64; N], MeshError> {
    for (number, word) in numbers.iter_mut().zip(words) {
        *number = scan.value(word, "a number of the header")?;
    }
    Ok(numbers)
}

fn has_fields(scan: &Scan, words: &[&[u8]], fields: u64, what: &str) -> Result<(), MeshError> {
    if words.len() as u64 == fields {
        return Ok(());
    }
    let why =
        format!("{what} has {} numbers, and by the first line of the file {fields}", words.len());
    Err(scan.fault(why))
}

/// Refuses lines after the last one that the header states.
fn at_end<'a>(scan: &mut Scan<'a>, words: &mut Vec<&'a [u8]>, what: &str) -> Result<(), MeshError> {
    if scan.record(words) {
        return Err(
            scan.fault(format!("there are more {what} than the first line of the file states"))
        );
    }
    Ok(())
}
