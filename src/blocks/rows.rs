//! The simplices in the file of a block.

use super::BlocksError;
use super::file::BlockFile;
use crate::shape::{Class, Complex, Sheets, Simplices};

/// What a block has of the shape: rows of its own points, and sheets by their common numbers.
pub(super) fn read_rows(
    file: &BlockFile,
    numbers: &[u32],
) -> Result<(Complex, Sheets), BlocksError> {
    let cells = file.read::<[u32; 4]>("cells")?;
    let complex = Complex {
        cells: rows(vec![Class::Interior as u8; cells.len()], cells),
        facets: rows(file.read("facet_classes")?, file.read("facets")?),
        edges: rows(file.read("edge_classes")?, file.read("edges")?),
        vertices: rows(file.read("vertex_classes")?, file.read("vertices")?),
    };
    let sheet = |name: u32| numbers[name as usize];
    let mut names = file.read::<u32>("facet_sheets")?.into_iter().map(sheet);
    let mut next = || names.next().unwrap_or_default();
    let mut sheets = Sheets::default();
    for class in complex.facets.classes() {
        match class {
            Class::Regular => sheets.regular.push(next()),
            Class::Singular => sheets.singular.push([next(), next()]),
            _ => {}
        }
    }
    sheets.edges = file.read::<u32>("edge_sheets")?.into_iter().map(sheet).collect();
    Ok((complex, sheets))
}

/// Simplices with the numbers of their classes.
fn rows<const N: usize>(classes: Vec<u8>, rows: Vec<[u32; N]>) -> Simplices<N> {
    let class = |number: u8| Class::from_number(number).unwrap_or(Class::Exterior);
    let mut simplices = Simplices::default();
    rows.into_iter().zip(classes).for_each(|(row, number)| simplices.push(row, class(number)));
    simplices
}
