//! The first cell, and the four infinite cells around it.

use std::cmp::Ordering;

use super::super::predicates::Screen;
use super::super::{Cell, SitesError, TriangulationError, no_memory};
use super::{Cavity, Mesh, Native};

impl<'a> Native<'a> {
    /// A triangulation of four points that span a volume. O(n) if the first ones do not.
    pub(super) fn start(screen: &'a Screen<'a>) -> Result<Self, TriangulationError> {
        let first = spanning(screen)?;
        let ghost = screen.len() as u32;
        // About 6.8 cells a point, of which a few more come and go.
        let expected = (screen.len() + screen.len() / 16).saturating_mul(7).max(64);
        let mut native = Self {
            screen,
            mesh: Mesh { cells: Vec::new(), ghost },
            marks: Vec::new(),
            free: Vec::new(),
            first,
            near: 0,
            cavity: Cavity::new(ghost)?,
        };
        native.reserve(expected)?;
        native.mesh.cells.push(Cell { corners: first, beside: [0; 4] });
        for corner in 0..4 {
            let mut infinite = first;
            infinite[corner] = ghost;
            // Seen from outside the facet turns the other way.
            infinite.swap((corner + 1) % 4, (corner + 2) % 4);
            native.mesh.cells.push(Cell { corners: infinite, beside: [0; 4] });
        }
        native.marks.resize(5, 0);
        for a in 0..5 {
            for b in 0..5 {
                if let Some([from, to]) =
                    common_facet(native.mesh.cells[a].corners, native.mesh.cells[b].corners)
                {
                    native.mesh.cells[a].beside[from] = (4 * b + to) as u32;
                }
            }
        }
        Ok(native)
    }

    /// Makes room for so many more cells.
    pub(super) fn reserve(&mut self, more: usize) -> Result<(), TriangulationError> {
        let bytes = (self.mesh.cells.len() + more).saturating_mul(36);
        self.mesh
            .cells
            .try_reserve(more)
            .and_then(|()| self.marks.try_reserve(more))
            .map_err(|_| no_memory(bytes))
    }
}

/// Four points that span a volume, positively oriented.
fn spanning(screen: &Screen<'_>) -> Result<[u32; 4], TriangulationError> {
    let n = screen.len() as u32;
    let flat = |dimension| SitesError::flat(screen.len(), dimension);
    let c = (2..n).find(|&c| !screen.collinear([0, 1, c])).ok_or(flat(1))?;
    let sign = |d: u32| screen.orientation([0, 1, c, d]);
    let d = (c + 1..n).find(|&d| sign(d).is_ne()).ok_or(flat(2))?;
    Ok(if sign(d) == Ordering::Greater { [0, 1, c, d] } else { [1, 0, c, d] })
}

/// The corners opposite the facet that two different cells share.
fn common_facet(a: [u32; 4], b: [u32; 4]) -> Option<[usize; 2]> {
    let apart = |a: [u32; 4], b: [u32; 4]| {
        let mut lone = (0..4).filter(|&k| !b.contains(&a[k]));
        lone.next().filter(|_| lone.next().is_none())
    };
    Some([apart(a, b)?, apart(b, a)?])
}
