//! The formats of points: their names, and how each is recognised, read and written. Every other list of
//! formats is derived from the [table](FORMATS).

use std::fmt;
use std::io::{self, Write};
use std::path::Path;

use walpha_base::advice::Setting;
use walpha_check::meshes::Mesh;

use super::model::MODEL;
#[cfg(feature = "formats")]
use super::read::xyz::{self, TextLayout};
use super::read::{format, npy};
#[cfg(feature = "formats")]
use super::read::{obj, off, pcd, ply, stl, table, vtk};
use super::write;
#[cfg(feature = "formats")]
use super::wvm;
use super::{CellCount, Columns, ModelMetadata, Packing, Points, PointsError, WeightedPoints};
#[cfg(feature = "formats")]
use crate::volume::VtkPoints;
use crate::volume::{NpyFile, OpenFile, Reason, UnknownFormat, built, is_npy, is_vtk, is_vtk_xml};

/// Reads the points of a file; the user may name its columns.
type Read = fn(&OpenFile, Option<&Columns>) -> Result<Points, PointsError>;

/// Reads the points of a file, without its last layers if a level is given, and their metadata.
type ReadModel =
    fn(&OpenFile, Option<&Columns>, u32) -> Result<(Points, ModelMetadata), PointsError>;

/// Reads the points of these classes.
type ReadClasses = fn(&OpenFile, &[u8]) -> Result<Points, PointsError>;

/// Counts the cells of a file.
type CountCells = fn(&OpenFile) -> Result<Vec<CellCount>, PointsError>;

/// Reads the cells of a file as a complex.
type ReadComplex = fn(&OpenFile) -> Result<Mesh, PointsError>;

/// A format of points.
pub struct PointFormat {
    /// Its name, as users know it.
    pub name: &'static str,
    /// Extensions, without dots.
    pub extensions: &'static [&'static str],
    /// Whether a user may name its columns.
    pub takes_columns: bool,
    /// The Cargo feature that its reader needs, if any.
    pub feature: Option<&'static str>,
    /// Its fuzz target.
    pub fuzzed_by: &'static str,
    /// Its writers.
    pub writers: &'static [PointWriter],
    /// Whether a file that starts with these bytes is of this format.
    begins: fn(&[u8]) -> bool,
    /// Whether a file holds points, for formats that may hold something else.
    holds_points: fn(&OpenFile) -> Result<bool, PointsError>,
    /// Whether its files may hold several levels.
    has_levels: bool,
    /// Reader of a format without metadata.
    read: Option<Read>,
    /// Reader of a format with metadata or levels. If both are `None`, the format was left out of the build.
    read_model: Option<ReadModel>,
    /// Reads the points of some classes alone, if the format has classes.
    read_classes: Option<ReadClasses>,
    /// Counts its cells, if the format has any.
    pub(super) cells: Option<CountCells>,
    /// Reads its cells as a complex, if the format can hold one.
    pub(super) read_complex: Option<ReadComplex>,
}

/// How points are written under an extension.
#[derive(Clone, Copy)]
pub struct PointWriter {
    /// The extension without its dot.
    pub extension: &'static str,
    /// Whether it stores metadata ([`ModelMetadata`]) and compresses ([`Packing`]).
    pub packs: bool,
    write: WriteAll,
}

/// Writes points and their metadata.
type WriteAll = fn(&WeightedPoints, &ModelMetadata, &Packing, &mut dyn Write) -> io::Result<()>;

/// A format recognised by extension only.
const PLAIN: PointFormat = PointFormat {
    name: "",
    extensions: &[],
    takes_columns: false,
    feature: Some("formats"),
    fuzzed_by: "",
    begins: |_| false,
    holds_points: |_| Ok(true),
    writers: &[],
    has_levels: false,
    read: None,
    read_model: None,
    read_classes: None,
    cells: None,
    read_complex: None,
};

/// The formats of points, in the order in which they are tried. The first is the default for files of no
/// recognised format.
pub static FORMATS: [PointFormat; 15] = [
    PointFormat {
        name: "CSV, TSV",
        extensions: &["csv", "tsv"],
        takes_columns: true,
        fuzzed_by: "table",
        read: built!("formats", table::read),
        writers: &[PointWriter {
            extension: "csv",
            packs: false,
            write: |points, _, _, out| write::csv(points, out),
        }],
        ..PLAIN
    },
    PointFormat {
        name: "XYZ",
        extensions: &["xyz", "txt", "asc"],
        takes_columns: true,
        fuzzed_by: "xyz",
        read_model: built!("formats", |file, columns, _| xyz::read(
            file,
            columns,
            TextLayout::Atoms
        )),
        ..PLAIN
    },
    PointFormat {
        name: "XYZ with normals or colours",
        extensions: &["xyzn", "xyzrgb"],
        takes_columns: true,
        fuzzed_by: "xyz",
        read_model: built!("formats", |file, columns, _| xyz::read(
            file,
            columns,
            TextLayout::Vectors
        )),
        ..PLAIN
    },
    PointFormat {
        name: "PTS",
        extensions: &["pts"],
        takes_columns: true,
        fuzzed_by: "xyz",
        read_model: built!("formats", |file, columns, _| xyz::read(
            file,
            columns,
            TextLayout::Scan
        )),
        ..PLAIN
    },
    PointFormat {
        name: "PWN",
        extensions: &["pwn"],
        takes_columns: true,
        fuzzed_by: "pwn",
        read_model: built!("formats", |file, columns, _| {
            xyz::read(file, columns, TextLayout::PointsThenNormals)
        }),
        ..PLAIN
    },
    PointFormat {
        name: "PLY",
        extensions: &["ply"],
        fuzzed_by: "ply",
        begins: |start| start.starts_with(b"ply\n") || start.starts_with(b"ply\r"),
        read: built!("formats", |file, _| ply::read(file)),
        cells: built!("formats", ply::cells),
        read_complex: built!("formats", ply::read_complex),
        ..PLAIN
    },
    PointFormat {
        name: "OFF",
        extensions: &["off"],
        fuzzed_by: "off",
        read: built!("formats", |file, _| off::read(file)),
        cells: built!("formats", off::cells),
        ..PLAIN
    },
    PointFormat {
        name: "OBJ",
        extensions: &["obj"],
        fuzzed_by: "obj",
        read: built!("formats", |file, _| obj::read(file)),
        cells: built!("formats", obj::cells),
        ..PLAIN
    },
    PointFormat {
        name: "STL",
        extensions: &["stl"],
        fuzzed_by: "stl",
        read: built!("formats", |file, _| stl::read(file)),
        cells: built!("formats", stl::cells),
        ..PLAIN
    },
    PointFormat {
        name: "PCD",
        extensions: &["pcd"],
        fuzzed_by: "pcd",
        begins: |start| start.starts_with(b"# .PCD"),
        read: built!("formats", |file, _| pcd::read(file)),
        ..PLAIN
    },
    PointFormat {
        name: "VTU, VTP",
        extensions: &["vtu", "vtp"],
        fuzzed_by: "vtk_geometry",
        begins: is_vtk_xml,
        holds_points: is_geometry,
        read: built!("formats", |file, _| vtk::read(file)),
        cells: built!("formats", vtk::cells),
        read_complex: built!("formats", vtk::read_complex),
        ..PLAIN
    },
    PointFormat {
        name: "VTK polygons and grids",
        extensions: &["vtk"],
        fuzzed_by: "vtk_geometry",
        begins: is_vtk,
        holds_points: lists_points,
        read: built!("formats", |file, _| vtk::read_legacy(file)),
        cells: built!("formats", vtk::cells_of_legacy),
        read_complex: built!("formats", vtk::read_legacy_complex),
        ..PLAIN
    },
    PointFormat {
        name: "NPY",
        extensions: &["npy"],
        feature: None,
        fuzzed_by: "npy_points",
        begins: is_npy,
        holds_points: |file| Ok(is_npy(file.start()) && NpyFile::open(file)?.shape.len() == 2),
        read: Some(|file, _| npy::read(file)),
        writers: &[PointWriter {
            extension: "npy",
            packs: false,
            write: |points, _, _, out| write::npy(points, out),
        }],
        ..PLAIN
    },
    PointFormat {
        name: "LAS, LAZ",
        extensions: &["las", "laz"],
        feature: Some("las"),
        fuzzed_by: "las",
        begins: |start| start.starts_with(b"LASF"),
        read: built!("las", |file, _| super::read::las::read(file, None)),
        read_classes: built!("las", |file, classes| super::read::las::read(file, Some(classes))),
        ..PLAIN
    },
    PointFormat {
        name: "WVM",
        extensions: &["wvm"],
        fuzzed_by: "wvm",
        begins: |start| start.starts_with(MODEL),
        has_levels: true,
        read_model: built!("formats", |file, _, level| wvm::read(file, level)),
        writers: MODEL_WRITERS,
        ..PLAIN
    },
];

/// The writers of `.wvm`, if built in.
const MODEL_WRITERS: &[PointWriter] = &[
    #[cfg(feature = "formats")]
    PointWriter { extension: "wvm", packs: true, write: wvm::write },
];

/// Whether a VTK XML file holds points.
#[cfg_attr(
    not(feature = "formats"),
    expect(clippy::unnecessary_wraps, reason = "the file is not read")
)]
fn is_geometry(file: &OpenFile) -> Result<bool, PointsError> {
    #[cfg(feature = "formats")]
    return vtk::holds_points(file);
    #[cfg(not(feature = "formats"))]
    {
        let extension = file.path().extension().unwrap_or_default();
        Ok(extension == "vtu" || extension == "vtp")
    }
}

/// Whether a legacy VTK file lists points.
#[expect(clippy::unnecessary_wraps, reason = "the reader reports damaged files")]
fn lists_points(file: &OpenFile) -> Result<bool, PointsError> {
    #[cfg(feature = "formats")]
    return Ok(VtkPoints::lists_points(file).unwrap_or(false));
    #[cfg(not(feature = "formats"))]
    {
        let _ = file;
        Ok(false)
    }
}

impl PointFormat {
    /// Whether its reader is part of this build.
    pub fn is_built_in(&self) -> bool {
        self.read.is_some() || self.read_model.is_some()
    }

    /// Whether this is one of its extensions, in any letter case.
    pub(super) fn is_named(&self, extension: &str) -> bool {
        self.extensions.iter().any(|own| own.eq_ignore_ascii_case(extension))
    }

    /// Whether a file that starts with these bytes is of this format.
    pub(super) fn begins(&self, start: &[u8]) -> bool {
        (self.begins)(start)
    }

    /// Whether a file of this format holds points.
    pub(super) fn holds_points(&self, file: &OpenFile) -> Result<bool, PointsError> {
        (self.holds_points)(file)
    }

    /// Whether its files may hold several levels.
    pub fn has_levels(&self) -> bool {
        self.has_levels
    }

    /// Reads the points of these classes.
    pub(super) fn read_classes(
        &self,
        file: &OpenFile,
        classes: &[u8],
    ) -> Result<Points, PointsError> {
        match self.read_classes {
            Some(read) => read(file, classes),
            // Without its reader, the format says so itself.
            None if !self.is_built_in() => Ok(self.read(file, None, 0)?.0),
            None => {
                let reason = Reason::needless(Setting::Class, "has no classes of points");
                Err(format(file.path(), reason))
            }
        }
    }

    pub(super) fn read(
        &self,
        file: &OpenFile,
        columns: Option<&Columns>,
        level: u32,
    ) -> Result<(Points, ModelMetadata), PointsError> {
        match (self.read_model, self.read) {
            (Some(read_model), _) => read_model(file, columns, level),
            (None, Some(read)) => Ok((read(file, columns)?, ModelMetadata::default())),
            (None, None) => {
                let (what, feature) = (self.name, self.feature.unwrap_or_default());
                Err(format(file.path(), Reason::Without { what, feature }))
            }
        }
    }
}

impl fmt::Debug for PointFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PointFormat").field("name", &self.name).finish_non_exhaustive()
    }
}

impl PointWriter {
    /// All writers.
    pub fn all() -> impl Iterator<Item = &'static Self> + Clone {
        FORMATS.iter().flat_map(|format| format.writers)
    }

    /// The writer for the extension of a path.
    ///
    /// # Errors
    /// [`UnknownFormat`], which names the known extensions.
    pub fn of(path: impl AsRef<Path>) -> Result<&'static Self, UnknownFormat> {
        let path = path.as_ref();
        UnknownFormat::find(path, "points", Self::all().map(|writer| (writer.extension, writer)))
    }

    /// Writes the whole file. The same points give the same bytes.
    ///
    /// # Errors
    /// Whatever `out` returns; a number that is not finite, which no reader would take, or a negative error.
    pub fn write(&self, points: &WeightedPoints, out: &mut dyn Write) -> io::Result<()> {
        self.write_model(points, &ModelMetadata::default(), &Packing::default(), out)
    }

    /// [`write`](Self::write) with metadata and packing options, which only formats that
    /// [pack](Self::packs) use.
    ///
    /// # Errors
    /// As [`write`](Self::write).
    pub fn write_model(
        &self,
        points: &WeightedPoints,
        metadata: &ModelMetadata,
        packing: &Packing,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        let refused = |what: String| Err(io::Error::new(io::ErrorKind::InvalidInput, what));
        if packing.value_error.is_nan() || packing.value_error < 0.0 {
            return refused(format!(
                "an error of values of {} makes no sense",
                packing.value_error
            ));
        }
        let columns = [Some(points.weights()), points.values()];
        for (index, place) in points.positions().iter().enumerate() {
            let others = columns.iter().flatten().map(|column| column[index]);
            if let Some(number) = place.iter().copied().chain(others).find(|x| !x.is_finite()) {
                return refused(format!(
                    "point {index} has {number}, which is not a finite number"
                ));
            }
        }
        (self.write)(points, metadata, packing, out)
    }
}

impl fmt::Debug for PointWriter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PointWriter").field("extension", &self.extension).finish_non_exhaustive()
    }
}
