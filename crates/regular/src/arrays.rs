//! The cells of a triangulation as flat arrays, which name points only by number.

/// Corners and adjacency of all cells. The infinite cells, one beyond each facet of the hull, have the infinite vertex as a corner;
/// see [`Triangulation`](crate::Triangulation), whose arrays these become.
#[derive(Clone, Debug)]
pub struct CellArrays {
    pub(crate) cells: Vec<[u32; 4]>,
    pub(crate) adjacency: Vec<[u32; 4]>,
    pub(crate) at_infinity: u32,
}

impl CellArrays {
    /// The corners of each cell, positively oriented. Cells of points that are close on a Hilbert curve are close.
    pub fn cells(&self) -> &[[u32; 4]] {
        &self.cells
    }

    /// For each corner of each cell, 4·cell + corner across the facet opposite that corner.
    pub fn adjacency(&self) -> &[[u32; 4]] {
        &self.adjacency
    }

    /// The infinite vertex. Its number is the number of points.
    pub fn infinite_vertex(&self) -> u32 {
        self.at_infinity
    }

    /// Cells, adjacency and infinite vertex, by value, so that each can be dropped separately.
    pub fn into_parts(self) -> (Vec<[u32; 4]>, Vec<[u32; 4]>, u32) {
        (self.cells, self.adjacency, self.at_infinity)
    }
}
