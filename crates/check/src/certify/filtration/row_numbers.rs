use crate::certify::structure::Structure;
use crate::schema::FiltrationFile;

/// The row in the triangulation of each simplex of a file.
pub(super) struct RowNumbers {
    pub vertices: Vec<usize>,
    pub edges: Vec<usize>,
    pub facets: Vec<usize>,
    pub cells: Vec<usize>,
}

impl RowNumbers {
    /// Of a file that lists the simplices of the triangulation.
    pub(super) fn of(file: &FiltrationFile, structure: &Structure) -> Self {
        let Structure { vertices, edges, facets, cells, .. } = structure;
        Self {
            vertices: file.vertices.iter().map(|&v| vertices.row([v]) as usize).collect(),
            edges: file.edges.iter().map(|&row| edges.row(row) as usize).collect(),
            facets: file.facets.iter().map(|&row| facets.row(row) as usize).collect(),
            cells: file.cells.iter().map(|&row| cells.row(row) as usize).collect(),
        }
    }
}
