use std::ffi::OsStr;
use std::path::Path;
#[cfg(any(feature = "json", feature = "npz"))]
use std::{fs::File, io::BufReader};

use super::{ComplexFile, FiltrationFile, SchemaError};

impl ComplexFile {
    /// Reads a file, as JSON or NPZ by its extension.
    ///
    /// # Errors
    /// [`SchemaError::Extension`] for another extension, or one whose feature is off;
    /// [`SchemaError::Io`] if the file cannot be read; what [`read_json`](Self::read_json) and
    /// [`read_npz`](Self::read_npz) return.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, SchemaError> {
        let path = path.as_ref();
        match Format::by_extension(path)? {
            #[cfg(feature = "json")]
            Format::Json => Self::read_json(open(path)?),
            #[cfg(feature = "npz")]
            Format::Npz => Self::read_npz(open(path)?),
        }
    }

    /// Whether [`open`](Self::open) knows the extension of this name. The file need not exist.
    pub fn is_named(path: impl AsRef<Path>) -> bool {
        Format::of(path.as_ref()).is_some()
    }
}

impl FiltrationFile {
    /// Reads a file, as JSON or NPZ by its extension.
    ///
    /// # Errors
    /// As [`ComplexFile::open`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, SchemaError> {
        let path = path.as_ref();
        match Format::by_extension(path)? {
            #[cfg(feature = "json")]
            Format::Json => Self::read_json(open(path)?),
            #[cfg(feature = "npz")]
            Format::Npz => Self::read_npz(open(path)?),
        }
    }

    /// Whether a file has a field `order`, which only filtrations have.
    fn is_in(path: &Path) -> bool {
        match Format::of(path) {
            None => false,
            #[cfg(feature = "json")]
            Some(Format::Json) => open(path).is_ok_and(Self::is_json),
            #[cfg(feature = "npz")]
            Some(Format::Npz) => open(path).is_ok_and(Self::is_npz),
        }
    }
}

/// A file of either kind.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there are one or two, moved a few times")]
pub enum AnyFile {
    /// A complex.
    Complex(ComplexFile),
    /// A filtration.
    Filtration(FiltrationFile),
}

impl AnyFile {
    /// Reads a file, as JSON or NPZ by its extension. It is a filtration if it has a field `order`; and a complex at
    /// α = ∞ if it states no α, and has nothing but points, cells and weights, or calls its cells `simplices`, `tetra`
    /// or `t`, as others do, and its points `points`, `p` or `vertices`.
    ///
    /// # Errors
    /// As [`ComplexFile::open`] and [`FiltrationFile::open`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, SchemaError> {
        let path = path.as_ref();
        match ComplexFile::open(path) {
            Ok(file) => Ok(Self::Complex(file)),
            Err(_) if FiltrationFile::is_in(path) => {
                FiltrationFile::open(path).map(Self::Filtration)
            }
            #[cfg(any(feature = "json", feature = "npz"))]
            Err(error) => match ComplexFile::open_named(path)? {
                Some(file) => Ok(Self::Complex(file)),
                None => Err(error),
            },
            #[cfg(not(any(feature = "json", feature = "npz")))]
            Err(error) => Err(error),
        }
    }
}

#[cfg(any(feature = "json", feature = "npz"))]
pub(super) fn open(path: &Path) -> Result<BufReader<File>, SchemaError> {
    Ok(BufReader::new(File::open(path).map_err(SchemaError::Io)?))
}

/// The formats that can be read.
pub(super) enum Format {
    #[cfg(feature = "json")]
    Json,
    #[cfg(feature = "npz")]
    Npz,
}

impl Format {
    fn by_extension(path: &Path) -> Result<Self, SchemaError> {
        Self::of(path).ok_or(SchemaError::Extension)
    }

    pub(super) fn of(path: &Path) -> Option<Self> {
        match path.extension().map(OsStr::to_ascii_lowercase)?.to_str()? {
            #[cfg(feature = "json")]
            "json" => Some(Self::Json),
            #[cfg(feature = "npz")]
            "npz" => Some(Self::Npz),
            _ => None,
        }
    }
}
