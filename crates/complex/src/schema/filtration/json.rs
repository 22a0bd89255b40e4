use std::io::{BufReader, Read, Write};

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::FiltrationFile;
use crate::schema::SchemaError;

impl FiltrationFile {
    /// Whether JSON holds a filtration: an object with a field `order`.
    pub(in crate::schema) fn is_json(reader: impl Read) -> bool {
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
