use std::io;

use walpha_base::advice::{Advice, Advise, Category, wrapped};
use walpha_base::npy::NpyError;

/// Why a file does not hold a complex.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SchemaError {
    /// The file cannot be read or written.
    #[error("the complex cannot be read or written: {0}")]
    Io(#[source] io::Error),
    /// The extension is neither `.json` nor `.npz`, or the feature of its format is off.
    #[error("a complex is read from .json or .npz")]
    Extension,
    /// The file is not JSON, or does not have this form; with line and column.
    #[error("the complex cannot be read as JSON: {0}")]
    Json(#[source] Box<dyn std::error::Error + Send + Sync>),
    /// The file is not a ZIP archive, or a damaged one.
    #[error("the complex cannot be read as NPZ: {0}")]
    Zip(String),
    /// An array of the archive cannot be read.
    #[error("array `{name}` {source}")]
    Npy {
        /// Its name.
        name: &'static str,
        /// The fault in its header.
        source: NpyError,
    },
    /// There is not enough memory for an array.
    #[error("not enough memory: array `{name}` needs {bytes} bytes")]
    Memory {
        /// Its name.
        name: &'static str,
        /// Bytes that its numbers need.
        bytes: u128,
    },
    /// A required array is missing.
    #[error("the NPZ file has no array `{0}`, which is required")]
    Missing(&'static str),
    /// An array has the wrong shape or type.
    #[error("array `{name}` has {got}, expected {expected}")]
    Array {
        /// Its name.
        name: &'static str,
        /// The form that it has.
        got: String,
        /// The form that it must have.
        expected: String,
    },
    /// A number that the field cannot hold.
    #[error("`{name}` holds {value}, expected {expected}")]
    Value {
        /// The field.
        name: &'static str,
        /// The number.
        value: String,
        /// A description of the expected values.
        expected: &'static str,
    },
    /// Two fields have different lengths.
    #[error("`{name}` has {got} entries, but needs {expected}: one for each of `{of}`")]
    Lengths {
        /// The field.
        name: &'static str,
        /// The length of the field.
        got: usize,
        /// The length of the other field.
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
        /// Number of points.
        points: usize,
    },
    /// The file lists no points.
    #[error("the file lists no points")]
    NoPoints,
    /// The file lists no simplices.
    #[error("the file lists no simplices")]
    NoSimplices,
}

impl SchemaError {
    /// Checks that two fields have equal lengths.
    ///
    /// # Errors
    /// [`SchemaError::Lengths`].
    #[doc(hidden)]
    pub fn paired(
        name: &'static str,
        got: usize,
        of: &'static str,
        expected: usize,
    ) -> Result<(), Self> {
        if got == expected { Ok(()) } else { Err(Self::Lengths { name, got, expected, of }) }
    }

    /// Checks that points exist.
    ///
    /// # Errors
    /// [`SchemaError::Index`].
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
}

impl Advise for SchemaError {
    wrapped!(Io; Npy { source });

    fn advice(&self) -> Option<Advice> {
        let advice = match self {
            Self::Zip(_) => "write it with numpy.savez",
            Self::Memory { .. } => "reduce its size",
            Self::Missing("alpha") => {
                "add `alpha`: a squared length, or infinity for a triangulation"
            }
            Self::Index { .. } => "number points from 0 in all rows",
            Self::NoPoints => "add `points`",
            Self::NoSimplices => "give at least one of cells, facets, edges, vertices",
            _ => return self.wrapped()?.advice(),
        };
        Some(advice.into())
    }

    fn category(&self) -> Category {
        match self {
            Self::Memory { .. } => Category::Memory,
            _ => self.wrapped().map_or(Category::Input, Advise::category),
        }
    }
}
