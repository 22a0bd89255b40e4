//! The first cell, and the four infinite cells around it.

use std::cmp::Ordering;

use super::{Builder, Cavity, Mesh};
use crate::predicates::Screen;
use crate::{Cell, SitesError, TriangulationError, no_memory};
use walpha_base::memory::asking;

impl Builder {
    /// Nothing yet, with room for a triangulation of so many of the points below a number, which no
    /// point has or which is the ghost's own.
    pub(super) fn empty(
        points: usize,
        below: usize,
        ghost: u32,
    ) -> Result<Self, TriangulationError> {
        // About 6.8 cells a point, of which a few more come and go.
        let expected = (points + points / 16).saturating_mul(7).max(64);
        let mut builder = Self {
            mesh: Mesh { cells: Vec::new(), ghost },
            marks: Vec::new(),
            free: Vec::new(),
            first: [ghost; 4],
            near: 0,
            cavity: Cavity::new(below)?,
        };
        builder.reserve(expected)?;
        Ok(builder)
    }

    /// Begins with four of some points that span a volume. O(n) if the first ones do not.
    pub(super) fn begin(
        &mut self,
        screen: &Screen<'_>,
        points: impl Iterator<Item = u32> + Clone,
    ) -> Result<(), TriangulationError> {
        let Self { mesh: Mesh { cells, ghost }, marks, free, first, near, .. } = self;
        *first = spanning(screen, points)?;
        cells.clear();
        free.clear();
        marks.clear();
        *near = 0;
        cells.push(Cell { corners: *first, neighbors: [0; 4] });
        for corner in 0..4 {
            let mut infinite = *first;
            infinite[corner] = *ghost;
            // Seen from outside the facet turns the other way.
            infinite.swap((corner + 1) % 4, (corner + 2) % 4);
            cells.push(Cell { corners: infinite, neighbors: [0; 4] });
        }
        marks.resize(5, 0);
        for a in 0..5 {
            for b in 0..5 {
                if let Some([from, to]) = common_facet(cells[a].corners, cells[b].corners) {
                    cells[a].neighbors[from] = (4 * b + to) as u32;
                }
            }
        }
        Ok(())
    }

    /// Makes room for so many more cells.
    pub(super) fn reserve(&mut self, more: usize) -> Result<(), TriangulationError> {
        let bytes = (self.mesh.cells.len() + more).saturating_mul(36);
        asking(|| self.mesh.cells.try_reserve(more))
            .and_then(|()| asking(|| self.marks.try_reserve(more)))
            .map_err(|_| no_memory(bytes))
    }
}

/// Four points that span a volume, positively oriented.
fn spanning(
    screen: &Screen<'_>,
    mut points: impl Iterator<Item = u32> + Clone,
) -> Result<[u32; 4], TriangulationError> {
    let all = points.clone();
    let flat = |dimension| SitesError::flat(all.clone().count(), dimension);
    let (Some(a), Some(b)) = (points.next(), points.next()) else { return Err(flat(0).into()) };
    let c = points.find(|&c| !screen.collinear([a, b, c])).ok_or_else(|| flat(1))?;
    let sign = |d: u32| screen.orientation([a, b, c, d]);
    let d = points.find(|&d| sign(d).is_ne()).ok_or_else(|| flat(2))?;
    Ok(if sign(d) == Ordering::Greater { [a, b, c, d] } else { [b, a, c, d] })
}

/// The corners opposite the facet that two different cells share.
fn common_facet(a: [u32; 4], b: [u32; 4]) -> Option<[usize; 2]> {
    let apart = |a: [u32; 4], b: [u32; 4]| {
        let mut lone = (0..4).filter(|&k| !b.contains(&a[k]));
        lone.next().filter(|_| lone.next().is_none())
    };
    Some([apart(a, b)?, apart(b, a)?])
}
