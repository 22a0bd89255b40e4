use std::io::{self, Write};
use std::path::Path;

use super::{Glb, Json, Npz, Obj, Off, Ply, Stl, Vtp, Vtu};
use crate::near::nearest;
use crate::shape::{AlphaShape, Surface};
use crate::shown::shown;

/// A way to write a shape down.
pub trait Exporter {
    /// Writes the whole file. The same shape gives the same bytes.
    ///
    /// # Errors
    /// Whatever `out` returns.
    fn write(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()>;

    /// What whoever reads the file should know of this shape, if anything.
    fn remark(&self, _shape: &AlphaShape) -> Option<String> {
        None
    }
}

/// How a shape is written down.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExportOptions {
    /// Text where the format has a binary form too: PLY.
    pub ascii: bool,
    /// The boundary as that of a [solid](Surface::solid): regular facets alone, closed, oriented and
    /// cut apart into a manifold. For formats of boundaries.
    pub solid: bool,
    /// Regular and singular facets told apart, where some programs do not expect it: by groups (OBJ, edges
    /// and points too), colours (OFF) or numbers (PLY, components and sheets too).
    pub groups: bool,
    /// What the shape was made of, to be told in the file: VTP and VTU.
    pub input: Option<String>,
}

impl ExportOptions {
    /// The boundary to write.
    pub(super) fn surface(&self, shape: &AlphaShape) -> Surface {
        if self.solid { Surface::solid(shape).0 } else { Surface::of(shape) }
    }
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
    /// Stereolithography: regular facets.
    Stl,
    /// glTF in one binary file: boundary, singular edges and vertices, coloured by F.
    Glb,
    /// VTK unstructured grid: simplices of all dimensions with their data.
    Vtu,
    /// VTK polygons: boundary, singular edges and vertices with their data.
    Vtp,
    /// NumPy arrays of indices and classes of simplices of all dimensions.
    Npz,
    /// The whole complex, for `walpha check` and other programs.
    Json,
}

/// No writer has this extension.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{path}: no format has the extension `{extension}`, {thing} can be written as {known}; {}",
    advice(near.as_deref())
)]
pub struct UnknownFormat {
    path: String,
    extension: String,
    thing: &'static str,
    known: String,
    near: Option<String>,
}

fn advice(near: Option<&str>) -> String {
    match near {
        Some(near) => format!("did you mean .{near}?"),
        None => "choose one of these".into(),
    }
}

impl Format {
    /// Every format with its extension.
    pub const ALL: [(Self, &str); 9] = [
        (Self::Ply, "ply"),
        (Self::Off, "off"),
        (Self::Obj, "obj"),
        (Self::Stl, "stl"),
        (Self::Glb, "glb"),
        (Self::Vtu, "vtu"),
        (Self::Vtp, "vtp"),
        (Self::Npz, "npz"),
        (Self::Json, "json"),
    ];

    /// The format a path asks for.
    ///
    /// # Errors
    /// [`UnknownFormat`] names the ones there are.
    pub fn of(path: &Path) -> Result<Self, UnknownFormat> {
        UnknownFormat::find(path, "a shape", &Self::ALL)
    }

    /// Whether it holds the boundary alone, and so may be that of a solid.
    pub fn is_boundary(self) -> bool {
        !matches!(self, Self::Vtu | Self::Npz | Self::Json)
    }

    /// Its writer.
    pub fn exporter(self, options: &ExportOptions) -> Box<dyn Exporter> {
        let options = options.clone();
        match self {
            Self::Ply => Box::new(Ply(options)),
            Self::Off => Box::new(Off(options)),
            Self::Obj => Box::new(Obj(options)),
            Self::Stl => Box::new(Stl(options)),
            Self::Glb => Box::new(Glb(options)),
            Self::Vtu => Box::new(Vtu(options)),
            Self::Vtp => Box::new(Vtp(options)),
            Self::Npz => Box::new(Npz),
            Self::Json => Box::new(Json),
        }
    }
}

impl UnknownFormat {
    /// The format whose extension ends a path.
    pub(super) fn find<F: Copy>(
        path: &Path,
        thing: &'static str,
        all: &[(F, &str)],
    ) -> Result<F, Self> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let ends = |extension: &str| {
            name.strip_suffix(extension).is_some_and(|stem| stem.len() > 1 && stem.ends_with('.'))
        };
        let found = all.iter().find(|(_, extension)| ends(extension));
        found
            .map(|&(format, _)| format)
            .ok_or_else(|| Self::new(path, thing, all.iter().map(|&(_, extension)| extension)))
    }

    /// Says that `thing` cannot be written to `path`, only under the `known` extensions (without their
    /// dots).
    pub fn new<'a>(
        path: &Path,
        thing: &'static str,
        known: impl IntoIterator<Item = &'a str> + Clone,
    ) -> Self {
        let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        let dotted: Vec<String> = known.clone().into_iter().map(|e| format!(".{e}")).collect();
        Self {
            path: shown(path),
            near: nearest(&extension, known).map(str::to_owned),
            extension,
            thing,
            known: dotted.join(", "),
        }
    }
}
