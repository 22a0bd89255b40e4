//! The simplices in the file of a block.

use super::BlocksError;
use super::file::BlockFile;
use crate::shape::{Class, Complex, Sheets, Simplices};

/// What a block has of the shape: rows of `points` points, and sheets by their common numbers.
///
/// # Errors
/// The file cannot be read, does not verify, or has simplices that cannot be.
pub(super) fn read_rows(
    file: &BlockFile,
    points: usize,
    numbers: &[u32],
) -> Result<(Complex, Sheets), BlocksError> {
    let complex = Complex {
        cells: rows(file, "cells", None, points)?,
        facets: rows(file, "facets", Some("facet_classes"), points)?,
        edges: rows(file, "edges", Some("edge_classes"), points)?,
        vertices: rows(file, "vertices", Some("vertex_classes"), points)?,
    };
    let [facets, edges, vertices] =
        [complex.facets.counts(), complex.edges.counts(), complex.vertices.counts()]
            .map(|counts| [Class::Interior, Class::Regular, Class::Singular].map(|c| counts[c]));
    let facts = &file.facts;
    if (facets, edges, vertices) != (facts.facets, facts.edges, facts.vertices) {
        return Err(file.damaged("has classes that it did not count"));
    }
    let sheet = |name: u32| numbers[name as usize];
    let count = numbers.len() as u32;
    let mut names = file.below::<u32>("facet_sheets", count)?.into_iter().map(sheet);
    // As many as there are sides: `BlockFile::open` has compared them.
    let mut next = || names.next().unwrap_or_default();
    let mut sheets = Sheets::default();
    for class in complex.facets.classes() {
        match class {
            Class::Regular => sheets.regular.push(next()),
            Class::Singular => sheets.singular.push([next(), next()]),
            _ => {}
        }
    }
    sheets.edges = file.below::<u32>("edge_sheets", count)?.into_iter().map(sheet).collect();
    Ok((complex, sheets))
}

/// Simplices with their classes; without an array of these, all are interior.
fn rows<const N: usize>(
    file: &BlockFile,
    name: &str,
    classes: Option<&str>,
    points: usize,
) -> Result<Simplices<N>, BlocksError> {
    let rows = file.read::<[u32; N]>(name)?;
    let is_row = |row: &[u32; N]| {
        let is_new = |(k, v): (usize, &u32)| (*v as usize) < points && !row[..k].contains(v);
        row.iter().enumerate().all(is_new)
    };
    if !rows.iter().all(is_row) {
        return Err(file.damaged(&format!("has {name} of points that are not there")));
    }
    let classes = match classes {
        Some(classes) => file.read(classes)?,
        None => vec![Class::Interior as u8; rows.len()],
    };
    let mut simplices = Simplices::default();
    for (row, number) in rows.into_iter().zip(classes) {
        let class = Class::from_number(number);
        let class = class.ok_or_else(|| file.damaged("has a class that is none"))?;
        simplices.push(row, class);
    }
    Ok(simplices)
}
