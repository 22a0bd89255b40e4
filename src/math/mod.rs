//! Floor 0: vectors, doubles taken apart into integers, and the lattices on which doubles do not round.

mod lattice;
pub(crate) mod number;
pub(crate) mod vector;

pub(crate) use lattice::{Lattice, Reach};
