//! Floor 0: vectors, doubles taken apart into integers, the lattices on which doubles do not round, and
//! sums that are rounded once.

mod lattice;
pub(crate) mod number;
mod sum;
pub(crate) mod vector;

pub(crate) use lattice::{Lattice, Reach};
pub(crate) use sum::Sum;
