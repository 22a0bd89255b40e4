//! Readers and writers are behind pointers within, in functions that are not generic: these are compiled here, once.

use std::collections::BTreeMap;
use std::io::{BufReader, BufWriter, Read, Write};

use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{ComplexFile, FiltrationFile, SchemaError};
use crate::Alpha;

impl ComplexFile {
    /// Reads JSON.
    ///
    /// # Errors
    /// [`SchemaError::Json`] with line and column, [`SchemaError::Io`] if `reader` fails.
    pub fn read_json(mut reader: impl Read) -> Result<Self, SchemaError> {
        Self::of_json(&mut reader)
    }

    fn of_json(reader: &mut dyn Read) -> Result<Self, SchemaError> {
        read(reader)
    }

    /// Writes JSON on one line.
    ///
    /// # Errors
    /// [`SchemaError::Io`] if `writer` fails.
    pub fn write_json(&self, mut writer: impl Write) -> Result<(), SchemaError> {
        self.to_json(&mut writer)
    }

    fn to_json(&self, writer: &mut dyn Write) -> Result<(), SchemaError> {
        write(self, writer)
    }
}

impl FiltrationFile {
    /// Whether JSON contains a filtration: an object with a field `order`.
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
    pub fn read_json(mut reader: impl Read) -> Result<Self, SchemaError> {
        Self::of_json(&mut reader)
    }

    fn of_json(reader: &mut dyn Read) -> Result<Self, SchemaError> {
        read(reader)
    }

    /// Writes JSON on one line.
    ///
    /// # Errors
    /// [`SchemaError::Io`] if `writer` fails.
    pub fn write_json(&self, mut writer: impl Write) -> Result<(), SchemaError> {
        self.to_json(&mut writer)
    }

    fn to_json(&self, writer: &mut dyn Write) -> Result<(), SchemaError> {
        write(self, writer)
    }
}

fn read<T: DeserializeOwned>(reader: &mut dyn Read) -> Result<T, SchemaError> {
    Ok(serde_json::from_reader(BufReader::new(reader))?)
}

fn write(file: &impl Serialize, writer: &mut dyn Write) -> Result<(), SchemaError> {
    let mut buffered = BufWriter::new(writer);
    serde_json::to_writer(&mut buffered, file)?;
    buffered.flush().map_err(SchemaError::Io)
}

/// The names of the fields in JSON; none if it cannot be read.
#[expect(clippy::zero_sized_map_values, reason = "only the names are wanted")]
pub(super) fn names(reader: impl Read) -> Vec<String> {
    let fields = serde_json::from_reader::<_, BTreeMap<String, IgnoredAny>>(BufReader::new(reader));
    fields.unwrap_or_default().into_keys().collect()
}

/// Reads a complex whose points and cells have these names.
pub(super) fn read_named(
    reader: impl Read,
    [points, cells]: [&'static str; 2],
) -> Result<ComplexFile, SchemaError> {
    let mut fields: BTreeMap<String, Value> = serde_json::from_reader(BufReader::new(reader))?;
    Ok(ComplexFile {
        cells: field(&mut fields, cells)?,
        weights: field(&mut fields, "weights")?,
        ..ComplexFile::of_points(
            field(&mut fields, points)?.unwrap_or_default(),
            field(&mut fields, "alpha")?.unwrap_or(Alpha::INFINITE),
        )
    })
}

fn field<T: DeserializeOwned>(
    fields: &mut BTreeMap<String, Value>,
    name: &'static str,
) -> Result<Option<T>, SchemaError> {
    let value = fields.remove(name).map(serde_json::from_value).transpose();
    value.map_err(|error| SchemaError::Json(format!("`{name}`: {error}").into()))
}

impl From<serde_json::Error> for SchemaError {
    fn from(error: serde_json::Error) -> Self {
        // Errors of the system keep their kind, such as a broken pipe.
        if error.is_io() { Self::Io(error.into()) } else { Self::Json(Box::new(error)) }
    }
}
