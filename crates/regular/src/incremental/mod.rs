//! Our own maker: incremental insertion (Bowyer 1981, doi:10.1093/comjnl/24.2.162; Watson 1981,
//! doi:10.1093/comjnl/24.2.167) with weights, over flat arrays.
//!
//! 1. Points come in [`rounds`]. Points along a curve ([`Sites`](super::Sites) know one) find their
//!    cells, and the numbers these are made of, in the cache.
//! 2. A walk from the last new cell finds the one that holds the point ([`locate`]). If the point
//!    does not lie inside that cell's orthogonal sphere it is hidden.
//! 3. The cells whose spheres hold the point are one cavity; new cells join the point to the
//!    cavity's boundary ([`cavity`]), in the places of the old ones.

mod cavity;
mod growing;
mod leave;
mod locate;
mod start;

use std::cmp::Ordering;

use super::predicates::{Predicates, Screen};
use super::rounds::rounds;
use super::{Cell, GONE, Triangulation, TriangulationError};
use cavity::Cavity;
pub use growing::Growing;
pub use leave::Workspace;
use walpha_base::Cancelled;

/// So many insertions are counted at once: some milliseconds.
const TOGETHER: usize = 4096;

/// The regular triangulation of points: finite numbers of sane magnitude, no two places equal.
/// Expected O(n log n) for points of even density.
///
/// # Errors
/// Points that span no volume, too many cells, no memory; what `inserted` returns.
pub fn insert_all(
    positions: &[[f64; 3]],
    weights: &[f64],
    mut inserted: impl FnMut(usize) -> Result<(), Cancelled>,
) -> Result<Triangulation, TriangulationError> {
    let predicates = Predicates::new(positions, weights);
    let screen = Screen::new(&predicates)?;
    let count = screen.count() as u32;
    let mut builder = Builder::empty(screen.count(), screen.count() + 1, count)?;
    builder.begin(&screen, 0..count)?;
    for (i, v) in rounds(count).enumerate() {
        if i % TOGETHER == TOGETHER - 1 {
            inserted(TOGETHER)?;
        }
        if !builder.first.contains(&v) {
            builder.insert(&screen, v)?;
        }
    }
    builder.finish()
}

/// A triangulation that grows.
struct Builder {
    mesh: Mesh,
    /// What the last insertions said of each cell, see [`Cavity`].
    marks: Vec<u32>,
    /// Places of cells that are gone.
    free: Vec<u32>,
    /// The corners of the first cell.
    first: [u32; 4],
    /// A cell near the last point.
    near: u32,
    cavity: Cavity,
}

impl Builder {
    /// Makes a point a vertex, or leaves it hidden; returns which.
    fn insert(&mut self, screen: &Screen<'_>, v: u32) -> Result<bool, TriangulationError> {
        let cell = self.locate(screen, v);
        let joins = self.mesh.conflicts(screen, cell, v);
        if joins {
            self.dig(screen, cell, v);
            self.fill(v)?;
        }
        Ok(joins)
    }

    fn finish(mut self) -> Result<Triangulation, TriangulationError> {
        for place in self.free {
            self.mesh.cells[place as usize].corners[0] = GONE;
        }
        drop(self.marks);
        Triangulation::along_points(self.mesh.cells, self.mesh.ghost)
    }
}

/// Cells and their neighbours, as [`Triangulation`] has them.
struct Mesh {
    cells: Vec<Cell>,
    ghost: u32,
}

impl Mesh {
    /// Whether a point lies inside the orthogonal sphere of a cell.
    #[inline(always)]
    fn conflicts(&self, screen: &Screen<'_>, cell: u32, v: u32) -> bool {
        let quick = screen.conflicts(self.cells[cell as usize].corners, v);
        quick.unwrap_or_else(|| self.conflicts_closely(screen, cell, v))
    }

    /// The sphere of an infinite cell is the half-space beyond its facet, and that of the finite
    /// cell behind where both meet.
    #[inline(never)]
    fn conflicts_closely(&self, screen: &Screen<'_>, cell: u32, v: u32) -> bool {
        let mut corners = self.cells[cell as usize].corners;
        let Some(corner) = self.ghost_corner(cell) else {
            return screen.conflicts_closely(corners, v);
        };
        corners[corner] = v;
        match screen.orientation(corners) {
            Ordering::Greater => true,
            Ordering::Less => false,
            Ordering::Equal => {
                let behind =
                    self.cells[self.cells[cell as usize].neighbors[corner] as usize / 4].corners;
                let quick = screen.conflicts(behind, v);
                quick.unwrap_or_else(|| screen.conflicts_closely(behind, v))
            }
        }
    }

    /// The place of the ghost in an infinite cell.
    #[inline(always)]
    fn ghost_corner(&self, cell: u32) -> Option<usize> {
        self.cells[cell as usize].corners.iter().position(|&v| v == self.ghost)
    }

    /// Joins two facets, each 4·cell + corner.
    #[inline(always)]
    fn join(&mut self, a: u32, b: u32) {
        self.cells[a as usize / 4].neighbors[a as usize % 4] = b;
        self.cells[b as usize / 4].neighbors[b as usize % 4] = a;
    }
}
