//! The common base of walpha's crates: advice for errors, allocations and threads that may be refused, sums of doubles that are
//! rounded once, parallel iterators, sorting, vectors, NPY, names and numbers in messages, and progress.
//!
//! It is for walpha's own crates only.
//!
//! ```
//! use walpha_base::Sum;
//!
//! let mut sum = Sum::default();
//! [1e100, 1.0, -1e100].into_iter().for_each(|term| sum.add(term));
//! assert_eq!(sum.value(), 1.0);
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]
// Unsafe code is allowed in `standard_output`, and where `memory` calls the C library.
#![deny(unsafe_code)]
#![warn(unreachable_pub)]

pub mod advice;
#[cfg(feature = "serde")]
mod coordinates;
pub mod foreign;
#[cfg(feature = "serde")]
mod infinite;
mod keep;
pub mod memory;
pub mod monitor;
pub mod npy;
pub mod parallel;
#[doc(hidden)]
pub mod random;
mod setters;
pub mod shown;
pub mod sort;
mod spread_bits;
#[cfg(feature = "cli")]
pub mod standard_output;
mod sum;
pub mod threads;
mod union_find;
pub mod vector;

#[cfg(feature = "serde")]
pub use coordinates::{Conversion, Coordinates, LengthUnit, Space};
#[cfg(feature = "serde")]
pub use infinite::number_or_null_or_name;
pub use keep::keep;
pub use monitor::{Cancelled, Monitor};
pub use setters::setters;
pub use spread_bits::spread_bits;
pub use sum::Sum;
pub use union_find::UnionFind;

/// The example in the README runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
