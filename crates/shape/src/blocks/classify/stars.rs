use rayon::prelude::*;
use walpha_regular::internals::parallel::FEW;

use super::state::State;

/// The number of points whose stars one thread walks at a time: they fit its cache.
pub(in crate::blocks) const RANGE: usize = 1 << 12;

/// The maximum number of chunks of cells that are searched for stars in parallel.
const CHUNKS: usize = 64;

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
        let length = cells.len().div_ceil(CHUNKS).max(FEW);
        // The chunk's corners at own points, each with its range.
        let near = |chunk: usize| {
            let cells = (chunk * length..).zip(&cells[chunk * length..]).take(length);
            let cells = cells.filter(|&(cell, _)| !states[cell].is_foreign());
            let corners = cells.flat_map(|(cell, corners)| (4 * cell as u32..).zip(corners));
            corners.filter(|&(_, &v)| v < own).map(|(corner, &v)| (corner, v as usize / RANGE))
        };
        let chunks = cells.len().div_ceil(length);
        let count = |chunk| {
            let mut counts = vec![0; ranges];
            near(chunk).for_each(|(_, range)| counts[range] += 1);
            counts
        };
        let counts: Vec<Vec<usize>> = (0..chunks).into_par_iter().map(count).collect();
        let mut starts = vec![0; ranges + 1];
        for range in 0..ranges {
            let count: usize = counts.iter().map(|counts| counts[range]).sum();
            starts[range + 1] = starts[range] + count;
        }
        let mut corners = vec![0; starts[ranges]];
        let mut rest = &mut corners[..];
        let mut parts: Vec<Vec<_>> = (0..chunks).map(|_| Vec::with_capacity(ranges)).collect();
        for range in 0..ranges {
            for (parts, counts) in parts.iter_mut().zip(&counts) {
                let part = rest.split_off_mut(..counts[range]).expect("as many as were counted");
                parts.push(part.iter_mut());
            }
        }
        parts.into_par_iter().enumerate().for_each(|(chunk, mut parts)| {
            for (corner, range) in near(chunk) {
                *parts[range].next().expect("as many as were counted") = corner;
            }
        });
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
