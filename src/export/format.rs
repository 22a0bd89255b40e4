use std::borrow::Cow;
use std::fmt;
use std::io::{self, Write};
use std::path::Path;

use walpha_base::advice::Advice;
use walpha_base::setters;

use super::{Glb, Json, Npz, Obj, Off, Ply, Stl, Vtp, Vtu};
use crate::shape::{AlphaShape, Surface};
use crate::volume::UnknownFormat;

/// A way to write a shape down.
pub trait Exporter {
    /// Writes the whole file. The same shape gives the same bytes.
    ///
    /// # Errors
    /// Whatever `out` returns.
    fn write(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()>;

    /// Whether what it writes can say that a box repeats.
    fn knows_torus(&self) -> bool {
        false
    }

    /// Writes the whole file, of a shape of a torus as it is [laid out](AlphaShape::unwrapped) where the format
    /// knows no torus.
    ///
    /// # Errors
    /// Whatever `out` returns.
    fn write_any(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        match shape.options().periodic {
            Some(_) if !self.knows_torus() => self.write(&shape.unwrapped(), out),
            _ => self.write(shape, out),
        }
    }

    /// What whoever reads the file should know of this shape, if anything.
    fn remark(&self, _shape: &AlphaShape) -> Option<Advice> {
        None
    }
}

/// How a shape is written down.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ExportOptions {
    /// Text where the format has a binary form too: PLY.
    pub ascii: bool,
    /// The boundary as that of a [solid](AlphaShape::solid): regular facets alone, closed, oriented and
    /// cut apart into a manifold. For formats of boundaries.
    pub solid: bool,
    /// Separate regular and singular facets, where some programs do not expect it: by groups (OBJ, edges
    /// and points too), colours (OFF) or numbers (PLY, components and sheets too).
    pub groups: bool,
    /// What the shape was made of, recorded in the file: VTP and VTU.
    pub input: Option<String>,
}

impl ExportOptions {
    setters! { ascii: bool, solid: bool, groups: bool, input: Option<String> }

    /// The boundary to write.
    pub(super) fn surface<'a>(&self, shape: &'a AlphaShape) -> Cow<'a, Surface> {
        if self.solid { Cow::Borrowed(shape.solid().0) } else { Cow::Owned(Surface::of(shape)) }
    }
}

/// A format that shapes are written in, chosen by file name extension.
#[derive(Clone, Copy)]
pub struct Format {
    /// For people.
    pub name: &'static str,
    /// Its extension, without the dot.
    pub extension: &'static str,
    /// What it holds.
    pub about: &'static str,
    /// Whether it holds the boundary alone, and so may be that of a solid.
    pub boundary: bool,
    /// Whether it has a text form and a binary one.
    pub ascii: bool,
    /// Whether it can separate regular and singular facets where some programs do not expect it.
    pub groups: bool,
    exporter: fn(ExportOptions) -> Box<dyn Exporter>,
}

/// A format of all simplices.
const PLAIN: Format = Format {
    name: "",
    extension: "",
    about: "",
    boundary: false,
    ascii: false,
    groups: false,
    exporter: |_| Box::new(Json),
};

/// The formats there are.
pub static FORMATS: [Format; 9] = [
    Format {
        name: "PLY",
        extension: "ply",
        about: "Polygon file format: boundary, singular edges and vertices.",
        boundary: true,
        ascii: true,
        groups: true,
        exporter: |options| Box::new(Ply(options)),
    },
    Format {
        name: "OFF",
        extension: "off",
        about: "Object file format of Geomview: boundary facets.",
        boundary: true,
        groups: true,
        exporter: |options| Box::new(Off(options)),
        ..PLAIN
    },
    Format {
        name: "OBJ",
        extension: "obj",
        about: "Wavefront: boundary, singular edges and vertices in groups.",
        boundary: true,
        groups: true,
        exporter: |options| Box::new(Obj(options)),
        ..PLAIN
    },
    Format {
        name: "STL",
        extension: "stl",
        about: "Stereolithography: regular facets.",
        boundary: true,
        exporter: |options| Box::new(Stl(options)),
        ..PLAIN
    },
    Format {
        name: "GLB",
        extension: "glb",
        about: "glTF in one binary file: boundary, singular edges and vertices, coloured by F.",
        boundary: true,
        exporter: |options| Box::new(Glb(options)),
        ..PLAIN
    },
    Format {
        name: "VTU",
        extension: "vtu",
        about: "VTK unstructured grid: simplices of all dimensions with their data.",
        exporter: |options| Box::new(Vtu(options)),
        ..PLAIN
    },
    Format {
        name: "VTP",
        extension: "vtp",
        about: "VTK polygons: boundary, singular edges and vertices with their data.",
        boundary: true,
        exporter: |options| Box::new(Vtp(options)),
        ..PLAIN
    },
    Format {
        name: "NPZ",
        extension: "npz",
        about: "NumPy arrays of indices and classes of simplices of all dimensions.",
        exporter: |_| Box::new(Npz),
        ..PLAIN
    },
    Format {
        name: "JSON",
        extension: "json",
        about: "The whole complex, for `walpha check` and other programs.",
        ..PLAIN
    },
];

impl Format {
    /// The format a path asks for.
    ///
    /// # Errors
    /// [`UnknownFormat`] names the ones there are.
    pub fn of(path: &Path) -> Result<&'static Self, UnknownFormat> {
        UnknownFormat::find(
            path,
            "a shape",
            FORMATS.iter().map(|format| (format.extension, format)),
        )
    }

    /// Its writer.
    pub fn exporter(&self, options: &ExportOptions) -> Box<dyn Exporter> {
        (self.exporter)(options.clone())
    }
}

impl fmt::Debug for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Format").field("name", &self.name).finish_non_exhaustive()
    }
}
