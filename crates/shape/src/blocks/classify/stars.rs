use super::state::State;
pub(in crate::blocks) use crate::groups::RANGE;
use crate::groups::{by_range, chunk_length};

/// The corners of cells, as 4·cell + corner, at the vertices of each range of points.
pub(super) struct Stars<'a> {
    cells: &'a [[u32; 4]],
    own: u32,
    /// Grouped by range.
    corners: Vec<u32>,
    /// The start of each range, and the end of the last one.
    starts: Vec<usize>,
}

/// The stars of the vertices of a range: for each the cells around it, as 4·cell + the corner that is the vertex.
#[derive(Default)]
pub(super) struct RangeStars {
    first: u32,
    corners: Vec<u32>,
    /// The start of the star of each vertex, and the end of the last one.
    starts: Vec<u32>,
}

impl<'a> Stars<'a> {
    /// The stars of the vertices below `own`. O(cells).
    pub(super) fn new(cells: &'a [[u32; 4]], own: u32, states: &[State]) -> Self {
        let ranges = (own as usize).div_ceil(RANGE);
        let length = chunk_length(cells.len());
        // The chunk's corners at own points, each with its range.
        let near = |chunk: usize| {
            let cells = (chunk * length..).zip(&cells[chunk * length..]).take(length);
            let cells = cells.filter(|&(cell, _)| !states[cell].is_foreign());
            let corners = cells.flat_map(|(cell, corners)| (4 * cell as u32..).zip(corners));
            corners.filter(|&(_, &v)| v < own).map(|(corner, &v)| (corner, v as usize / RANGE))
        };
        let (corners, starts) = by_range(cells.len().div_ceil(length), ranges, near);
        Self { cells, own, corners, starts }
    }

    /// The number of ranges.
    pub(super) fn ranges(&self) -> usize {
        self.starts.len() - 1
    }

    /// Sorts the corners of a range by their vertices, and returns these.
    pub(super) fn sort(&self, range: usize, stars: &mut RangeStars) -> std::ops::Range<u32> {
        let vertices = (range * RANGE) as u32..((range + 1) * RANGE).min(self.own as usize) as u32;
        let near = &self.corners[self.starts[range]..self.starts[range + 1]];
        let number = |corner: u32| {
            (self.cells[corner as usize / 4][corner as usize % 4] - vertices.start) as usize
        };
        // `starts[v + 1]` is the place of the next corner of v; after all are written, it is the end of the star of v.
        stars.first = vertices.start;
        stars.starts.clear();
        stars.starts.resize(vertices.len() + 2, 0);
        near.iter().for_each(|&corner| stars.starts[number(corner) + 2] += 1);
        for v in 2..stars.starts.len() {
            stars.starts[v] += stars.starts[v - 1];
        }
        stars.corners.clear();
        stars.corners.resize(near.len(), 0);
        for &corner in near {
            let at = &mut stars.starts[number(corner) + 1];
            stars.corners[*at as usize] = corner;
            *at += 1;
        }
        vertices
    }
}

impl RangeStars {
    /// The star of a vertex, ascending; empty if the point is hidden.
    pub(super) fn of(&self, v: u32) -> &[u32] {
        let v = (v - self.first) as usize;
        &self.corners[self.starts[v] as usize..self.starts[v + 1] as usize]
    }
}
