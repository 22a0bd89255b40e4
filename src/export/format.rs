use std::io::{self, Write};
use std::path::Path;

use super::{Json, Obj, Off, Ply, Vtu};
use crate::shape::AlphaShape;

/// A way to write a shape down.
pub trait Exporter {
    /// Writes the whole file. The same shape gives the same bytes.
    ///
    /// # Errors
    /// Whatever `out` returns.
    fn write(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()>;
}

/// The formats shapes are written in, chosen by file name extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Polygon file format: boundary, singular edges and vertices.
    Ply,
    /// Object file format of Geomview: boundary facets.
    Off,
    /// Wavefront: boundary, singular edges and vertices in groups.
    Obj,
    /// VTK unstructured grid: simplices of all dimensions with their data.
    Vtu,
    /// The whole complex, for `walpha check` and other programs.
    Json,
}

/// No writer has this extension.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{path}: no format has the extension `{extension}`; a shape can be written as {known}")]
pub struct UnknownFormat {
    path: String,
    extension: String,
    known: String,
}

impl Format {
    /// Every format with its extension.
    pub const ALL: [(Self, &str); 5] = [
        (Self::Ply, "ply"),
        (Self::Off, "off"),
        (Self::Obj, "obj"),
        (Self::Vtu, "vtu"),
        (Self::Json, "json"),
    ];

    /// The format a path asks for.
    ///
    /// # Errors
    /// [`UnknownFormat`] names the ones there are.
    pub fn of(path: &Path) -> Result<Self, UnknownFormat> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let found = Self::ALL.iter().find(|(_, known)| *known == extension);
        found.map(|&(format, _)| format).ok_or_else(|| UnknownFormat {
            path: path.display().to_string(),
            extension,
            known: Self::ALL.map(|(_, extension)| format!(".{extension}")).join(", "),
        })
    }

    /// Its writer. `ascii` asks for text where the format has a binary form too.
    pub fn exporter(self, ascii: bool) -> Box<dyn Exporter> {
        match self {
            Self::Ply => Box::new(Ply { ascii }),
            Self::Off => Box::new(Off),
            Self::Obj => Box::new(Obj),
            Self::Vtu => Box::new(Vtu),
            Self::Json => Box::new(Json),
        }
    }
}
