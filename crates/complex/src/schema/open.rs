use std::ffi::OsStr;
use std::fs::File;
use std::io::{BufReader, Seek};
use std::path::Path;

#[cfg(feature = "json")]
use super::json;
use super::named::{Names, names_of};
#[cfg(feature = "npz")]
use super::npz;
use super::{ComplexFile, FiltrationFile, SchemaError};

impl ComplexFile {
    /// Reads a file, as JSON or NPZ by its extension.
    ///
    /// # Errors
    /// [`SchemaError::Extension`] for another extension, or one whose feature is off;
    /// [`SchemaError::Io`] if the file cannot be read; what [`read_json`](Self::read_json) and
    /// [`read_npz`](Self::read_npz) return.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, SchemaError> {
        let (format, mut file) = Format::open(path.as_ref())?;
        format.complex(&mut file)
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
    /// See [`ComplexFile::open`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, SchemaError> {
        let (format, mut file) = Format::open(path.as_ref())?;
        format.filtration(&mut file)
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
    /// Reads a file, as JSON or NPZ by its extension. It is a filtration if it has a field `order`. It is a complex at α = ∞ if
    /// it states no α, and contains only points, cells and weights, or names its cells `simplices`, `tetra` or `t`, as in other
    /// programs, and its points `points`, `p` or `vertices`.
    ///
    /// The file is opened once, and a file that is not a complex is read again from its first byte on: a pipe can only deliver
    /// complexes.
    ///
    /// # Errors
    /// See [`ComplexFile::open`] and [`FiltrationFile::open`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, SchemaError> {
        let (format, mut file) = Format::open(path.as_ref())?;
        let error = match format.complex(&mut file) {
            Ok(file) => return Ok(Self::Complex(file)),
            Err(error) => error,
        };
        file.rewind().map_err(SchemaError::Io)?;
        if format.holds_filtration(&mut file) {
            file.rewind().map_err(SchemaError::Io)?;
            return format.filtration(&mut file).map(Self::Filtration);
        }
        file.rewind().map_err(SchemaError::Io)?;
        let Some(names) = names_of(&format.names(&mut file)) else { return Err(error) };
        file.rewind().map_err(SchemaError::Io)?;
        format.named(&mut file, names).map(Self::Complex)
    }
}

type OpenFile = BufReader<File>;

/// The formats that can be read.
#[derive(Clone, Copy)]
enum Format {
    #[cfg(feature = "json")]
    Json,
    #[cfg(feature = "npz")]
    Npz,
}

#[cfg_attr(
    not(any(feature = "json", feature = "npz")),
    expect(unused_variables, reason = "there is no format to read")
)]
impl Format {
    fn of(path: &Path) -> Option<Self> {
        match path.extension().map(OsStr::to_ascii_lowercase)?.to_str()? {
            #[cfg(feature = "json")]
            "json" => Some(Self::Json),
            #[cfg(feature = "npz")]
            "npz" => Some(Self::Npz),
            _ => None,
        }
    }

    /// Opens a file in the format of its extension.
    fn open(path: &Path) -> Result<(Self, OpenFile), SchemaError> {
        let format = Self::of(path).ok_or(SchemaError::Extension)?;
        Ok((format, BufReader::new(File::open(path).map_err(SchemaError::Io)?)))
    }

    fn complex(self, file: &mut OpenFile) -> Result<ComplexFile, SchemaError> {
        match self {
            #[cfg(feature = "json")]
            Self::Json => ComplexFile::read_json(file),
            #[cfg(feature = "npz")]
            Self::Npz => ComplexFile::read_npz(file),
        }
    }

    fn filtration(self, file: &mut OpenFile) -> Result<FiltrationFile, SchemaError> {
        match self {
            #[cfg(feature = "json")]
            Self::Json => FiltrationFile::read_json(file),
            #[cfg(feature = "npz")]
            Self::Npz => FiltrationFile::read_npz(file),
        }
    }

    /// Whether a file has a field `order`, which only filtrations have.
    fn holds_filtration(self, file: &mut OpenFile) -> bool {
        match self {
            #[cfg(feature = "json")]
            Self::Json => FiltrationFile::is_json(file),
            #[cfg(feature = "npz")]
            Self::Npz => FiltrationFile::is_npz(file),
        }
    }

    /// The names of the fields of a file; none if it cannot be read.
    fn names(self, file: &mut OpenFile) -> Vec<String> {
        match self {
            #[cfg(feature = "json")]
            Self::Json => json::names(file),
            #[cfg(feature = "npz")]
            Self::Npz => npz::names(file),
        }
    }

    /// Reads a complex whose points and cells have these names.
    fn named(self, file: &mut OpenFile, names: Names) -> Result<ComplexFile, SchemaError> {
        match self {
            #[cfg(feature = "json")]
            Self::Json => json::read_named(file, names),
            #[cfg(feature = "npz")]
            Self::Npz => npz::read_named(file, names),
        }
    }
}
