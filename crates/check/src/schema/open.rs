use std::ffi::OsStr;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use super::{ComplexFile, SchemaError};

impl ComplexFile {
    /// Reads a file, as JSON or NPZ by its extension.
    ///
    /// # Errors
    /// [`SchemaError::Extension`] for another extension, or one whose feature is off;
    /// [`SchemaError::Io`] if the file cannot be read; what [`read_json`](Self::read_json) and
    /// [`read_npz`](Self::read_npz) return.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, SchemaError> {
        let path = path.as_ref();
        let format = Format::of(path).ok_or(SchemaError::Extension)?;
        let file = BufReader::new(File::open(path).map_err(SchemaError::Io)?);
        match format {
            #[cfg(feature = "json")]
            Format::Json => Self::read_json(file),
            #[cfg(feature = "npz")]
            Format::Npz => Self::read_npz(file),
        }
    }

    /// Whether [`open`](Self::open) knows the extension of this name. The file need not exist.
    pub fn is_named(path: impl AsRef<Path>) -> bool {
        Format::of(path.as_ref()).is_some()
    }
}

/// The formats that are read.
enum Format {
    #[cfg(feature = "json")]
    Json,
    #[cfg(feature = "npz")]
    Npz,
}

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
}
