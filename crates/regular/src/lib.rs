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
mod merging;
#[doc(hidden)]
pub mod number;
mod order;
mod predicates;
mod sites;
mod torus;

use rayon::prelude::*;
use walpha_base::memory::asking;

pub use error::{SitesError, TriangulationError};
pub use sites::{MAX_COORDINATE, MAX_WEIGHT, Sites};
pub use torus::{Torus, TorusError};

// For the other crates of walpha: not covered by semantic versioning.
#[doc(hidden)]
pub use flat::{Flat, auxiliary_positions, check_span, is_flat, spanning, triangulate_flat};
#[doc(hidden)]
pub use incremental::{Growing, Workspace, insert_all};
#[doc(hidden)]
pub use lattice::{BitRange, Lattice};
#[doc(hidden)]
pub use merging::triangulate_along;
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

    /// The corners of each cell, infinite cells included. Cells of sites that are close on a Hilbert curve are close.
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

/// The points along a Hilbert curve, hidden and equal ones included. O(n log n).
#[doc(hidden)]
pub fn along_curve(positions: &[[f64; 3]]) -> Vec<u32> {
    order::along_curve(positions).into_par_iter().map(|(_, point)| point).collect()
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

/// The facets opposite the corners of a cell, oriented so that facet and corner are the positively oriented cell. Two
/// cells on the same side of a facet therefore have it in the same orientation.
pub(crate) fn facets([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 4] {
    [[b, d, c], [a, c, d], [b, a, d], [a, b, c]]
}

/// The cyclic rotation that starts with the smallest vertex.
pub(crate) fn smallest_first(mut facet: [u32; 3]) -> [u32; 3] {
    let first = (0..3).min_by_key(|&k| facet[k]).unwrap_or(0);
    facet.rotate_left(first);
    facet
}

/// At least so many cells are renumbered by one thread in one piece.
const MIN_LEN: usize = 1 << 12;

/// The first corner of a deleted cell, whose slot is free.
const DELETED: u32 = u32::MAX;

/// The regular triangulation of sites, by site index, on all threads of the current rayon pool. The order of cells and
/// of their corners does not depend on the number of threads. Expected O(n log n) for evenly distributed points.
///
/// # Errors
/// Sites that span no volume; out of memory; more than [`Triangulation::MAX_CELLS`] cells.
pub fn triangulate(sites: &Sites<'_>) -> Result<Triangulation, TriangulationError> {
    let along = sites.curve();
    let positions: Vec<_> = along.par_iter().map(|&i| sites.positions()[i as usize]).collect();
    let weights: Vec<_> = along.par_iter().map(|&i| sites.weights()[i as usize]).collect();
    let mut triangulation = triangulate_along(&positions, &weights, |_| Ok(()))?;
    triangulation.cells.par_iter_mut().with_min_len(MIN_LEN).for_each(|cell| {
        *cell = cell.map(|v| along.get(v as usize).copied().unwrap_or(v));
    });
    Ok(triangulation)
}
