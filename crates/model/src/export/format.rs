use std::fmt;
use std::path::Path;

use super::{
    ExportOptions, Exporter, GeoJson, Glb, Json, Npz, Obj, Off, Ply, Stl, Svg, ThreeMf, Vtp, Vtu,
    Wkt,
};
use walpha_volume::UnknownFormat;

/// A format that shapes are written in, chosen by file name extension.
#[derive(Clone, Copy)]
#[expect(clippy::struct_excessive_bools, reason = "each is a property of its own")]
pub struct Format {
    /// The name, as users know it.
    pub name: &'static str,
    /// The extension, without the dot.
    pub extension: &'static str,
    /// A description of the content.
    pub about: &'static str,
    /// Whether the file contains only the boundary, which may be that of a solid.
    pub boundary: bool,
    /// Whether the file contains the outline of points in a plane, and nothing else.
    pub outline: bool,
    /// Whether it states the whole complex, for [`walpha_check`] to judge.
    pub whole: bool,
    /// Whether the format has both a text form and a binary form.
    pub ascii: bool,
    /// Whether it holds further columns of the points ([`ExportOptions::columns`]).
    pub columns: bool,
    /// Whether the format can separate regular and singular facets in a way that some programs do not expect.
    pub groups: bool,
    /// Whether coordinates are in single precision ([`ExportOptions::offset`]).
    pub single: bool,
    exporter: fn(ExportOptions) -> Box<dyn Exporter>,
}

/// The defaults: a format of all simplices.
const PLAIN: Format = Format {
    name: "",
    extension: "",
    about: "",
    boundary: false,
    outline: false,
    whole: false,
    ascii: false,
    columns: false,
    groups: false,
    single: false,
    exporter: |_| Box::new(Json),
};

/// The number of formats.
const COUNT: usize = if cfg!(all(feature = "las", not(target_family = "wasm"))) { 14 } else { 13 };

/// All formats. `GeoPackage` is part of the feature `las`, and not of WebAssembly.
pub static FORMATS: [Format; COUNT] = [
    Format {
        name: "PLY",
        extension: "ply",
        about: "Polygon file format: boundary, singular edges and vertices.",
        boundary: true,
        ascii: true,
        groups: true,
        columns: true,
        exporter: |options| Box::new(Ply(options)),
        ..PLAIN
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
        single: true,
        exporter: |options| Box::new(Stl(options)),
        ..PLAIN
    },
    Format {
        name: "3MF",
        extension: "3mf",
        about: "3D Manufacturing Format: the boundary as that of a solid, with its unit.",
        boundary: true,
        single: true,
        exporter: |options| Box::new(ThreeMf(options)),
        ..PLAIN
    },
    Format {
        name: "GLB",
        extension: "glb",
        about: "glTF in one binary file: boundary, singular edges and vertices, coloured by F.",
        boundary: true,
        single: true,
        exporter: |options| Box::new(Glb(options)),
        ..PLAIN
    },
    Format {
        name: "VTU",
        extension: "vtu",
        about: "VTK unstructured grid: simplices of all dimensions with their data.",
        columns: true,
        exporter: |options| Box::new(Vtu(options)),
        ..PLAIN
    },
    Format {
        name: "VTP",
        extension: "vtp",
        about: "VTK polygons: boundary, singular edges and vertices with their data.",
        boundary: true,
        columns: true,
        exporter: |options| Box::new(Vtp(options)),
        ..PLAIN
    },
    Format {
        name: "NPZ",
        extension: "npz",
        about: "NumPy arrays of indices and classes of simplices of all dimensions.",
        whole: true,
        exporter: |_| Box::new(Npz),
        ..PLAIN
    },
    Format {
        name: "JSON",
        extension: "json",
        about: "The whole complex, for `walpha check` and other programs.",
        whole: true,
        ..PLAIN
    },
    Format {
        name: "GeoJSON",
        extension: "geojson",
        about: "Points in a plane: polygons with holes, with area and perimeter; singular edges and vertices.",
        outline: true,
        exporter: |options| Box::new(GeoJson(options)),
        ..PLAIN
    },
    #[cfg(all(feature = "las", not(target_family = "wasm")))]
    Format {
        name: "GeoPackage",
        extension: "gpkg",
        about: "Points in a plane: polygons with holes, with area and perimeter, in the coordinate system of the points.",
        outline: true,
        exporter: |options| Box::new(super::GeoPackage(options)),
        ..PLAIN
    },
    Format {
        name: "WKT",
        extension: "wkt",
        about: "Points in a plane: polygons with holes, singular edges and vertices, as well-known text.",
        outline: true,
        exporter: |_| Box::new(Wkt),
        ..PLAIN
    },
    Format {
        name: "SVG",
        extension: "svg",
        about: "Points in a plane: a drawing of polygons with holes, singular edges and vertices. Far from the origin a round number is subtracted, which its description states.",
        outline: true,
        exporter: |_| Box::new(Svg),
        ..PLAIN
    },
];

impl Format {
    /// The format for the extension of a path.
    ///
    /// # Errors
    /// [`UnknownFormat`], which lists the known extensions.
    pub fn of(path: impl AsRef<Path>) -> Result<&'static Self, UnknownFormat> {
        UnknownFormat::find(
            path.as_ref(),
            "a shape",
            FORMATS.iter().map(|format| (format.extension, format)),
        )
    }

    /// The writer of the format.
    pub fn exporter(&self, options: &ExportOptions) -> Box<dyn Exporter> {
        (self.exporter)(options.clone())
    }
}

impl fmt::Debug for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Format").field("name", &self.name).finish_non_exhaustive()
    }
}
