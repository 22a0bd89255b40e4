use std::path::Path;

use walpha_base::advice::{Advise, wrapped};

#[cfg(doc)]
use super::Exporter;
use super::{EmptyShape, ExportOptions, Format, Target, TargetError};
use walpha_shape::AlphaShape;
use walpha_volume::UnknownFormat;

/// Shapes that save themselves.
pub trait Save {
    /// Writes a file in the format of its extension, one of [`FORMATS`](super::FORMATS), with the default [`ExportOptions`]. The
    /// file appears under its name when it is complete, and replaces an existing one.
    ///
    /// # Errors
    /// The extension is unknown, the file cannot be written, or it would be empty. An [`Exporter`] also writes empty files.
    fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError>;
}

impl Save for AlphaShape {
    fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let path = path.as_ref();
        let exporter = Format::of(path)?.exporter(&ExportOptions::default());
        EmptyShape::check(self, exporter.needs())?;
        Ok(Target::open(path)?.write(|out| exporter.write(self, out))?)
    }
}

/// An error of saving a shape.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// No format has the extension.
    #[error(transparent)]
    Format(#[from] UnknownFormat),
    /// The file would be empty.
    #[error(transparent)]
    Empty(#[from] EmptyShape),
    /// The file cannot be written.
    #[error(transparent)]
    Target(#[from] TargetError),
}

impl Advise for SaveError {
    wrapped!(Format, Empty, Target);
}
