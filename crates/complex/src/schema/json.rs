use std::io::{BufReader, Read, Write};

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::{ComplexFile, FiltrationFile, SchemaError};

impl ComplexFile {
    /// Reads JSON.
    ///
    /// # Errors
    /// [`SchemaError::Json`] with line and column, [`SchemaError::Io`] if `reader` fails.
    pub fn read_json(reader: impl Read) -> Result<Self, SchemaError> {
        Ok(serde_json::from_reader(BufReader::new(reader))?)
    }

    /// Writes JSON on one line.
    ///
    /// # Errors
    /// [`SchemaError::Io`] if `writer` fails.
    pub fn write_json(&self, writer: impl Write) -> Result<(), SchemaError> {
        Ok(serde_json::to_writer(writer, self)?)
    }
}

impl FiltrationFile {
    /// Whether JSON holds a filtration: an object with a field `order`.
    pub(super) fn is_json(reader: impl Read) -> bool {
        #[derive(Deserialize)]
        struct Ordered {
            #[serde(rename = "order")]
            _order: IgnoredAny,
        }
        serde_json::from_reader::<_, Ordered>(BufReader::new(reader)).is_ok()
    }

    /// Reads JSON.
    ///
    /// # Errors
    /// [`SchemaError::Json`] with line and column, [`SchemaError::Io`] if `reader` fails.
    pub fn read_json(reader: impl Read) -> Result<Self, SchemaError> {
        Ok(serde_json::from_reader(BufReader::new(reader))?)
    }

    /// Writes JSON on one line.
    ///
    /// # Errors
    /// [`SchemaError::Io`] if `writer` fails.
    pub fn write_json(&self, writer: impl Write) -> Result<(), SchemaError> {
        Ok(serde_json::to_writer(writer, self)?)
    }
}

impl From<serde_json::Error> for SchemaError {
    fn from(error: serde_json::Error) -> Self {
        // Errors of the system keep their kind, such as a broken pipe.
        if error.is_io() { Self::Io(error.into()) } else { Self::Json(Box::new(error)) }
    }
}
