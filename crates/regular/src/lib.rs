//! Exact regular triangulations of weighted points in space, written only in Rust.
//!
//! The regular triangulation of weighted points is their weighted Delaunay triangulation, the dual of the power
//! diagram: no point lies inside the orthogonal sphere of a cell. With equal weights it is the Delaunay triangulation.
//! Every predicate is evaluated exactly on the input doubles, so degenerate input (grids, cospherical, collinear and
//! duplicate points) needs no special treatment.
//!
//! Ties are broken as in CGAL: each lifted point is raised by an infinitesimal height, which is larger the later the point comes
//! in the order of (x, y, z) (Devillers and Teillaud 2011, doi:10.1016/j.comgeo.2010.09.010). The triangulation is therefore a
//! function of the set of points, independent of their order.
//!
//! [`triangulate`] makes a [`Triangulation`], which has the cells, their neighbours, the hull, and the location of points. Points
//! are named by their indices, and may be given in any order.
//!
//! ```
//! use walpha_regular::{Location, triangulate};
//!
//! let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|c| c as f64);
//! let points: Vec<[f64; 3]> = (0..8).map(corner).collect();
//! let cube = triangulate(&points, None)?;
//! assert_eq!(cube.finite_cells().count(), 6);
//! assert_eq!(cube.hull_facets().count(), 12);
//! assert!(matches!(cube.locate([1.0; 3]), Some(Location::OnVertex { vertex: 7, .. })));
//!
//! // Weights are squared lengths. A point in the middle so light that the corners hide it:
//! let points: Vec<[f64; 3]> = points.into_iter().chain([[0.5; 3]]).collect();
//! let weights = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0];
//! assert_eq!(triangulate(&points, Some(&weights))?.hidden(), [8]);
//! # Ok::<(), walpha_regular::TriangulationError>(())
//! ```

#![forbid(unsafe_code)]
#![warn(missing_debug_implementations, unreachable_pub)]

mod arrays;
mod error;
mod flat;
mod incremental;
pub mod internals;
mod kernel;
mod lattice;
mod locate;
mod merging;
mod order;
mod power_diagram;
pub mod predicates;
mod scaled;
mod sites;
mod torus;
mod triangulation;

use walpha_base::memory::asking;

use arrays::CellArrays;
use incremental::{Cell, insert_all};
use internals::number;
use kernel::Predicates;
use lattice::Lattice;
use scaled::Scaled;
use sites::Sites;

pub use error::{SitesError, TriangulationError};
pub use locate::Location;
pub use power_diagram::PowerDiagram;
pub use sites::{MAX_COORDINATE, MAX_WEIGHT};
pub use torus::{Torus, TorusError};
pub use triangulation::{Triangulation, triangulate};
pub use walpha_base::advice::Advise;
pub use walpha_base::{Cancelled, Monitor};

/// Compiles and runs the example in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

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

/// The facets opposite the corners of a cell, oriented so that facet and corner form the positively oriented cell. Two cells on
/// the same side of a facet therefore have it in the same orientation.
pub(crate) fn facets([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 4] {
    [[b, d, c], [a, c, d], [b, a, d], [a, b, c]]
}

/// The cyclic rotation that starts with the smallest vertex.
pub(crate) fn smallest_first(mut facet: [u32; 3]) -> [u32; 3] {
    let first = (0..3).min_by_key(|&k| facet[k]).unwrap_or(0);
    facet.rotate_left(first);
    facet
}

/// The first corner of a deleted cell, whose slot is free.
const DELETED: u32 = u32::MAX;
