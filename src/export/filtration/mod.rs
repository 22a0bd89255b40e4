//! Filtrations as files: every simplex and when it comes.

mod json;
mod npz;
mod text;

use std::io::{self, Write};
use std::path::Path;

use super::UnknownFormat;
use crate::ladder::Ordered;

/// The formats filtrations are written in, chosen by file name extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FiltrationFormat {
    /// NumPy's archive of arrays, compressed: the [`schema`](crate::check::schema::FiltrationFile) that
    /// `walpha check` and `walpha compare` read.
    Npz,
    /// The same in JSON.
    Json,
    /// A line for each simplex, in order: value, whether Gabriel, from where on regular and interior,
    /// vertices.
    Text,
}

impl FiltrationFormat {
    /// All formats with their extensions.
    pub const ALL: [(Self, &str); 3] =
        [(Self::Npz, "npz"), (Self::Json, "json"), (Self::Text, "txt")];

    /// The format a path asks for.
    ///
    /// # Errors
    /// [`UnknownFormat`] names the ones there are.
    pub fn of(path: &Path) -> Result<Self, UnknownFormat> {
        UnknownFormat::find(path, "a filtration", &Self::ALL)
    }

    /// Writes the whole file. The same filtration gives the same bytes. Of the pairs those are written
    /// whose simplices have different values.
    ///
    /// # Errors
    /// Whatever `out` returns; no memory.
    pub fn write(self, ordered: &Ordered<'_>, out: &mut dyn Write) -> io::Result<()> {
        match self {
            Self::Npz => npz::write(ordered, out),
            Self::Json => json::write(ordered, out),
            Self::Text => text::write(ordered, out),
        }
    }
}

/// Those of some pairs whose simplices have different values.
fn lasting(ordered: &Ordered<'_>, pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    pairs.iter().copied().filter(|&pair| ordered.lasts(pair)).collect()
}
