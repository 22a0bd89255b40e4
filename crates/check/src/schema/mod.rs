//! Complexes from files, ready to be judged. What the files hold, and how, is of [`walpha_complex::schema`].

mod build;
mod placed;

pub use walpha_complex::schema::*;

pub(crate) use build::turn;
pub use placed::PlacedComplex;
