use std::io;

use walpha_base::npy::NpyError;

/// Why a file does not hold a complex.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SchemaError {
    /// The file cannot be read or written.
    #[error("the complex cannot be read or written: {0}")]
    Io(#[source] io::Error),
    /// The extension is neither `.json` nor `.npz`, or that of a format left out by its feature.
    #[error("a complex is read from .json or .npz")]
    Extension,
    /// Not JSON, or not of this form; with line and column.
    #[error("the complex cannot be read as JSON: {0}")]
    Json(#[source] Box<dyn std::error::Error + Send + Sync>),
    /// Not a ZIP archive, or a damaged one.
    #[error("the complex cannot be read as NPZ: {0}")]
    Zip(String),
    /// An array of the archive cannot be read.
    #[error("array `{name}` {source}")]
    Npy {
        /// Its name.
        name: &'static str,
        /// What is wrong with its header.
        source: NpyError,
    },
    /// Memory for an array cannot be had.
    #[error("array `{name}` needs {bytes} bytes of memory, which cannot be had")]
    Memory {
        /// Its name.
        name: &'static str,
        /// What its numbers take.
        bytes: u128,
    },
    /// A needed array is missing.
    #[error("the NPZ file has no array `{0}`, which is needed")]
    Missing(&'static str),
    /// An array has the wrong shape or type.
    #[error("array `{name}` has {got}, expected {expected}")]
    Array {
        /// Its name.
        name: &'static str,
        /// What it has.
        got: String,
        /// What it must have.
        expected: String,
    },
    /// A number that the field cannot hold.
    #[error("`{name}` holds {value}, expected {expected}")]
    Value {
        /// The field.
        name: &'static str,
        /// The number.
        value: String,
        /// What it should be.
        expected: &'static str,
    },
    /// Two fields do not pair up.
    #[error("`{name}` has {got} entries, but {expected} are needed, one each of `{of}`")]
    Lengths {
        /// The field.
        name: &'static str,
        /// Its length.
        got: usize,
        /// The other's.
        expected: usize,
        /// The other field.
        of: &'static str,
    },
    /// A row names a point that does not exist.
    #[error("`{name}` names point {index}, but there are only {points}, numbered from 0")]
    Index {
        /// The field.
        name: &'static str,
        /// The number.
        index: u32,
        /// How many points there are.
        points: usize,
    },
    /// No points at all.
    #[error("the file lists no points")]
    NoPoints,
    /// No simplices at all.
    #[error("the file lists no simplices")]
    NoSimplices,
}

impl SchemaError {
    /// Refuses two fields that do not pair up.
    #[doc(hidden)]
    pub fn paired(
        name: &'static str,
        got: usize,
        of: &'static str,
        expected: usize,
    ) -> Result<(), Self> {
        if got == expected { Ok(()) } else { Err(Self::Lengths { name, got, expected, of }) }
    }

    /// Refuses numbers of points that are not there.
    #[doc(hidden)]
    pub fn in_range<'a>(
        name: &'static str,
        mut indices: impl Iterator<Item = &'a u32>,
        points: usize,
    ) -> Result<(), Self> {
        match indices.find(|&&index| index as usize >= points) {
            Some(&index) => Err(Self::Index { name, index, points }),
            None => Ok(()),
        }
    }

    /// What to do about it, where there is something.
    pub fn advice(&self) -> Option<&'static str> {
        Some(match self {
            Self::Zip(_) => "write it with numpy.savez",
            Self::Memory { .. } => "make it smaller",
            Self::NoPoints => "add `points`",
            Self::NoSimplices => "give at least one of cells, facets, edges, vertices",
            _ => return None,
        })
    }
}
