//! Exact regular triangulations of weighted points in space, in Rust alone.
//!
//! The regular triangulation of weighted points is their weighted Delaunay triangulation, the dual of the power
//! diagram: no point lies inside the orthogonal sphere of a cell. With equal weights it is the Delaunay triangulation.
//! Every predicate is evaluated exactly on the input doubles, so degenerate input (grids, cospherical, collinear and
//! duplicate points) needs no special treatment.
//!
//! Ties are broken as in CGAL: each lifted point is raised by an infinitesimal height, which is larger the later the
//! point comes in the order of (x, y, z) (Devillers and Teillaud 2011, doi:10.1016/j.comgeo.2010.09.010). The
//! triangulation is therefore a function of the set of points, whatever their order.
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

mod error;
mod flat;
mod incremental;
mod lattice;
#[doc(hidden)]
pub mod number;
mod order;
mod predicates;
mod sites;
mod torus;

use walpha_base::memory::asking;

pub use error::{SitesError, TriangulationError};
pub use sites::{MAX_COORDINATE, MAX_WEIGHT, Sites};
pub use torus::{Torus, TorusError};

// For the other crates of walpha: not covered by semantic versioning.
#[doc(hidden)]
pub use flat::{Flat, auxiliary_positions, check_span, is_flat, triangulate_flat};
#[doc(hidden)]
pub use incremental::{Growing, Workspace, insert_all};
#[doc(hidden)]
pub use lattice::{BitRange, Lattice};
#[doc(hidden)]
pub use predicates::{Interval, Predicates, Ratio, Screen, SmallRadius, lattice};
#[doc(hidden)]
pub use sites::check as check_numbers;
#[doc(hidden)]
pub use torus::AXES;

/// Compiles and runs the example in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// A regular triangulation: its cells and their adjacency.
///
/// The outside of the convex hull is divided into infinite cells, one for each facet of the hull. Their
/// fourth corner is the infinite vertex, called the *ghost*: its number is the number of points, one past
/// the last point. Cells are positively oriented: a, b, c turn counter-clockwise seen from d, where the
/// ghost counts as a point far outside the hull.
///
/// Example: four points have the cell `[0, 1, 2, 3]` and four infinite cells, among them
/// `[0, 2, 1, 4]` with the ghost 4 as its corner 3. If that cell has number 2, `neighbors()[0][3]` is
/// 4·2 + 3: the facet opposite corner 3 of cell 0 is also the facet opposite corner 3 of cell 2.
#[derive(Clone, Debug)]
pub struct Triangulation {
    cells: Vec<[u32; 4]>,
    neighbors: Vec<[u32; 4]>,
    ghost: u32,
}

impl Triangulation {
    /// Maximum number of cells: 4·cell + corner fits 32 bits.
    pub const MAX_CELLS: usize = 1 << 30;

    /// Drops [`DELETED`] cells and sorts the others by their smallest corners (a counting sort), so that
    /// cells of consecutive points are close in memory. O(cells).
    fn sorted_by_corner(old: Vec<Cell>, ghost: u32) -> Result<Self, TriangulationError> {
        let alive = || old.iter().filter(|cell| cell.corners[0] != DELETED);
        let smallest = |cell: &Cell| {
            let [a, b, c, d] = cell.corners;
            a.min(b).min(c).min(d) as usize
        };
        let mut next: Vec<u32> = filled(ghost as usize + 2, 0)?;
        for cell in alive() {
            next[smallest(cell) + 1] += 1;
        }
        for v in 1..next.len() {
            next[v] += next[v - 1];
        }
        let count = next[ghost as usize + 1] as usize;
        let mut numbers = filled(old.len(), DELETED)?;
        let mut cells = filled(count, [0; 4])?;
        for (number, cell) in numbers.iter_mut().zip(&old) {
            if cell.corners[0] == DELETED {
                continue;
            }
            let next = &mut next[smallest(cell)];
            *number = *next;
            cells[*next as usize] = cell.corners;
            *next += 1;
        }
        // Collected in place; shrinking then frees half the memory of the old cells.
        let mut across: Vec<_> = old.into_iter().map(|cell| cell.neighbors).collect();
        across.shrink_to_fit();
        let mut neighbors = filled(count, [0; 4])?;
        for (&number, [a, b, c, d]) in numbers.iter().zip(across).filter(|(n, _)| **n != DELETED) {
            let to = |side: u32| 4 * numbers[side as usize / 4] + side % 4;
            neighbors[number as usize] = [to(a), to(b), to(c), to(d)];
        }
        Ok(Self { cells, neighbors, ghost })
    }

    /// The corners of each cell, infinite cells included, in no particular order.
    pub fn cells(&self) -> &[[u32; 4]] {
        &self.cells
    }

    /// For each corner of each cell, the neighbour across the facet opposite that corner, as 4·cell + corner:
    /// the neighbouring cell, and its own corner opposite the same facet.
    pub fn neighbors(&self) -> &[[u32; 4]] {
        &self.neighbors
    }

    /// The infinite vertex, a corner of every infinite cell. Its number is the number of points.
    pub fn ghost(&self) -> u32 {
        self.ghost
    }

    /// Cells, neighbours and ghost, by value, so that each can be dropped on its own.
    pub fn into_parts(self) -> (Vec<[u32; 4]>, Vec<[u32; 4]>, u32) {
        (self.cells, self.neighbors, self.ghost)
    }

    /// The hidden points, those that are no vertices, in ascending order. O(cells).
    pub fn hidden(&self) -> Vec<u32> {
        let mut seen = vec![false; self.ghost as usize + 1];
        for &v in self.cells.as_flattened() {
            seen[v as usize] = true;
        }
        (0..self.ghost).filter(|&v| !seen[v as usize]).collect()
    }
}

/// An empty vector with capacity for `count` elements.
fn with_capacity<T>(count: usize) -> Result<Vec<T>, TriangulationError> {
    let mut empty = Vec::new();
    match asking(|| empty.try_reserve_exact(count)) {
        Ok(()) => Ok(empty),
        Err(_) => Err(no_memory(count.saturating_mul(size_of::<T>()))),
    }
}

/// A vector of `count` copies of an element.
fn filled<T: Clone>(count: usize, element: T) -> Result<Vec<T>, TriangulationError> {
    let mut filled = with_capacity(count)?;
    filled.resize(count, element);
    Ok(filled)
}

fn no_memory(bytes: usize) -> TriangulationError {
    TriangulationError::Memory { bytes }
}

/// A cell under construction: its corners, and 4·cell + corner across the facet opposite each.
#[doc(hidden)]
#[derive(Clone, Copy, Default)]
pub struct Cell {
    pub corners: [u32; 4],
    pub neighbors: [u32; 4],
}

/// The first corner of a deleted cell, whose slot is free.
const DELETED: u32 = u32::MAX;

/// The regular triangulation of sites, by site index. Expected O(n log n) for evenly distributed points.
///
/// # Errors
/// Sites that span no volume; out of memory; more than [`Triangulation::MAX_CELLS`] cells.
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
