//! Complexes from files, ready to be judged. The contents and formats of files are those of [`walpha_complex::schema`].

mod build;
mod placed;

pub use walpha_complex::schema::*;

pub(crate) use build::orient;
pub use placed::PlacedComplex;
