//! Simplicial complexes with the classes of alpha shapes, which engines return, writers write and checkers judge.
//!
//! ```
//! use walpha_complex::{Class, Complex, Simplices};
//!
//! let tetrahedron = Complex {
//!     cells: [([0, 1, 2, 3], Class::Interior)].into_iter().collect(),
//!     facets: [[0, 1, 3], [0, 2, 1], [0, 3, 2], [1, 2, 3]].map(|row| (row, Class::Regular)).into_iter().collect(),
//!     edges: [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]].map(|row| (row, Class::Regular)).into_iter().collect(),
//!     vertices: (0..4).map(|v| ([v], Class::Regular)).collect(),
//! };
//! assert_eq!(tetrahedron.euler_characteristic(), 1);
//! assert_eq!(tetrahedron.facets.counts().regular, 4);
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(missing_debug_implementations, unreachable_pub)]

mod alpha;
pub mod canonical;
mod class;
mod complex;
pub mod schema;
mod simplices;
mod voxels;

pub use alpha::{Alpha, AlphaError};
pub use class::{ByClass, Class};
pub use complex::{Complex, Placed};
pub use simplices::{Simplices, SimplicesError};
pub use voxels::Voxels;
pub use walpha_base::advice::Advise;

/// The example in the README runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
