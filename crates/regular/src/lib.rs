//! Exact regular triangulations of weighted points in space, in Rust alone.
//!
//! A regular triangulation is the weighted Delaunay triangulation, the dual of the power diagram: no point
//! has less power than the corners of a cell with respect to its orthogonal sphere. Without weights it is the Delaunay
//! triangulation. Every decision is exact, from the input doubles on, and degenerate input (grids, points on one sphere,
//! in one plane, at one place) is decided like any other.
//!
//! Ties are broken as in CGAL, by raising each lifted point by an infinitely small height, the larger the
//! later it comes in the order of (x, y, z) (Devillers and Teillaud 2011, doi:10.1016/j.comgeo.2010.09.010): so the
//! triangulation is a function of the set of points, whatever their order.
//!
//! ```
//! use walpha_regular::{Sites, triangulate};
//!
//! let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|c| c as f64);
//! let (positions, weights): (Vec<_>, Vec<_>) = (0..8).map(|i| (corner(i), 0.0)).unzip();
//! let cube = triangulate(&Sites::new(&positions, &weights)?)?;
//! let finite = cube.cells().iter().filter(|cell| !cell.contains(&cube.ghost()));
//! assert_eq!(finite.count(), 6);
//! assert!(cube.hidden().is_empty());
//! # Ok::<(), walpha_regular::TriangulationError>(())
//! ```

mod curve;
mod error;
mod flat;
mod incremental;
mod lattice;
#[doc(hidden)]
pub mod number;
mod predicates;
mod rounds;
mod sites;
mod torus;

use walpha_base::memory::asking;

pub use error::{SitesError, TriangulationError};
pub use sites::{MAX_COORDINATE, MAX_WEIGHT, Sites};
pub use torus::{Torus, TorusError};

// What walpha makes shapes of: no promise to others.
#[doc(hidden)]
pub use flat::{Flat, auxiliary_places, check_span, is_flat, triangulate_flat};
#[doc(hidden)]
pub use incremental::{Growing, Workspace, insert_all};
#[doc(hidden)]
pub use lattice::{Lattice, Reach};
#[doc(hidden)]
pub use predicates::{Interval, Predicates, Ratio, Screen, SmallRadius, lattice};
#[doc(hidden)]
pub use sites::check as check_numbers;
#[doc(hidden)]
pub use torus::AXES;

/// The example in the README runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// A regular triangulation: its cells and their neighbours.
///
/// The outside of the convex hull is made of infinite cells, one on each facet of the hull, whose
/// fourth corner is the *ghost*, the number one past the last point. Cells are positively oriented:
/// a, b, c turn counter-clockwise seen from d, where the ghost counts as a point far outside.
///
/// Four points may have the cell `[0, 1, 2, 3]` and four infinite ones, among them
/// `[0, 2, 1, 4]` with the ghost 4 as its corner 3. If that one has number 2, `neighbors()[0][3]` is
/// 4·2 + 3: across the facet opposite corner 3 of cell 0 lies cell 2, of which it is opposite
/// corner 3.
#[derive(Clone, Debug)]
pub struct Triangulation {
    cells: Vec<[u32; 4]>,
    neighbors: Vec<[u32; 4]>,
    ghost: u32,
}

impl Triangulation {
    /// The most cells that 4·cell + corner can name.
    pub const MOST_CELLS: usize = 1 << 30;

    /// Numbers cells by their smallest corners, so that cells near each other in the order of points
    /// are near each other in memory, and leaves those out whose first corner is [`GONE`]. O(cells).
    fn along_points(old: Vec<Cell>, ghost: u32) -> Result<Self, TriangulationError> {
        let there = || old.iter().filter(|cell| cell.corners[0] != GONE);
        let smallest = |cell: &Cell| {
            let [a, b, c, d] = cell.corners;
            a.min(b).min(c).min(d) as usize
        };
        let mut next: Vec<u32> = filled(ghost as usize + 2, 0)?;
        for cell in there() {
            next[smallest(cell) + 1] += 1;
        }
        for v in 1..next.len() {
            next[v] += next[v - 1];
        }
        let count = next[ghost as usize + 1] as usize;
        let mut numbers = filled(old.len(), GONE)?;
        let mut cells = filled(count, [0; 4])?;
        for (number, cell) in numbers.iter_mut().zip(&old) {
            if cell.corners[0] == GONE {
                continue;
            }
            let place = &mut next[smallest(cell)];
            *number = *place;
            cells[*place as usize] = cell.corners;
            *place += 1;
        }
        // In place: half the memory of the old cells comes free.
        let mut across: Vec<_> = old.into_iter().map(|cell| cell.neighbors).collect();
        across.shrink_to_fit();
        let mut neighbors = filled(count, [0; 4])?;
        for (&number, [a, b, c, d]) in numbers.iter().zip(across).filter(|(n, _)| **n != GONE) {
            let to = |side: u32| 4 * numbers[side as usize / 4] + side % 4;
            neighbors[number as usize] = [to(a), to(b), to(c), to(d)];
        }
        Ok(Self { cells, neighbors, ghost })
    }

    /// The corners of each cell, infinite cells included, in no particular order.
    pub fn cells(&self) -> &[[u32; 4]] {
        &self.cells
    }

    /// The neighbour across the facet opposite each corner of each cell, as 4·cell + corner: that cell, and
    /// its own corner opposite the facet.
    pub fn neighbors(&self) -> &[[u32; 4]] {
        &self.neighbors
    }

    /// The corner of infinite cells that is not a point: the number of points.
    pub fn ghost(&self) -> u32 {
        self.ghost
    }

    /// Cells, their neighbours, and the ghost, to be given back one after the other.
    pub fn into_parts(self) -> (Vec<[u32; 4]>, Vec<[u32; 4]>, u32) {
        (self.cells, self.neighbors, self.ghost)
    }

    /// The points that are not vertices, ascending. O(cells).
    pub fn hidden(&self) -> Vec<u32> {
        let mut seen = vec![false; self.ghost as usize + 1];
        for &v in self.cells.as_flattened() {
            seen[v as usize] = true;
        }
        (0..self.ghost).filter(|&v| !seen[v as usize]).collect()
    }
}

/// A vector with room for so many elements.
fn room<T>(count: usize) -> Result<Vec<T>, TriangulationError> {
    let mut room = Vec::new();
    match asking(|| room.try_reserve_exact(count)) {
        Ok(()) => Ok(room),
        Err(_) => Err(no_memory(count.saturating_mul(size_of::<T>()))),
    }
}

/// A vector of so many equal elements.
fn filled<T: Clone>(count: usize, element: T) -> Result<Vec<T>, TriangulationError> {
    let mut filled = room(count)?;
    filled.resize(count, element);
    Ok(filled)
}

fn no_memory(bytes: usize) -> TriangulationError {
    TriangulationError::Memory { bytes }
}

/// A cell while it is made: its corners, and 4·cell + corner across each facet.
#[doc(hidden)]
#[derive(Clone, Copy, Default)]
pub struct Cell {
    pub corners: [u32; 4],
    pub neighbors: [u32; 4],
}

/// The first corner of a cell that is none.
const GONE: u32 = u32::MAX;

/// The regular triangulation of sites, by site index. Expected O(n log n) for points of even density.
///
/// # Errors
/// Sites that span no volume, no memory, more than [`Triangulation::MOST_CELLS`] cells.
pub fn triangulate(sites: &Sites<'_>) -> Result<Triangulation, TriangulationError> {
    let along = sites.curve();
    let positions: Vec<_> = along.iter().map(|&i| sites.positions()[i as usize]).collect();
    let weights: Vec<_> = along.iter().map(|&i| sites.weights()[i as usize]).collect();
    let mut triangulation = insert_all(&positions, &weights, |_| Ok(()))?;
    for v in triangulation.cells.as_flattened_mut() {
        *v = along.get(*v as usize).copied().unwrap_or(*v);
    }
    Ok(triangulation)
}
