//! The formats of points: what each is called, how it is recognised, read and written. Whatever else
//! lists formats is made from the [table](FORMATS).

use std::fmt;
use std::io::{self, Write};
use std::path::Path;

use super::read::{format, npy};
#[cfg(feature = "formats")]
use super::read::{obj, off, pcd, ply, stl, table, vtk, xyz};
use super::write;
use super::{Columns, Points, PointsError, WeightedPoints};
use crate::volume::{NpyFile, Reason, UnknownFormat, built, is_vtk_xml, start_of};

/// Reads a file whose columns may be named.
type Read = fn(&Path, Option<&Columns>) -> Result<Points, PointsError>;

/// A format of points.
pub struct PointFormat {
    /// For people.
    pub name: &'static str,
    /// Extensions, without dots.
    pub extensions: &'static [&'static str],
    /// Whether a user may say what its columns are.
    pub takes_columns: bool,
    /// The feature that reads it; `None` where it needs none.
    pub feature: Option<&'static str>,
    /// Its target for fuzzing.
    pub fuzzed_by: &'static str,
    /// Its writers.
    pub writers: &'static [PointWriter],
    begins: fn(&[u8]) -> bool,
    /// Whether a file of it holds points, where it may hold others.
    holds_points: fn(&Path) -> Result<bool, PointsError>,
    /// Reads a file; `None` where it was left out of the build.
    read: Option<Read>,
}

/// How points are written under an extension.
#[derive(Clone, Copy)]
pub struct PointWriter {
    /// The extension without its dot.
    pub extension: &'static str,
    write: fn(&WeightedPoints, &mut dyn Write) -> io::Result<()>,
}

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
    read: None,
};

/// The formats of points, in the order in which they are looked for. The first is the default for
/// files that nothing identifies.
pub static FORMATS: [PointFormat; 11] = [
    PointFormat {
        name: "CSV, TSV",
        extensions: &["csv", "tsv"],
        takes_columns: true,
        fuzzed_by: "table",
        read: built!("formats", table::read),
        writers: &[PointWriter { extension: "csv", write: write::csv }],
        ..PLAIN
    },
    PointFormat {
        name: "XYZ",
        extensions: &["xyz"],
        takes_columns: true,
        fuzzed_by: "xyz",
        read: built!("formats", |path, columns| xyz::read(path, columns, xyz::Counted::Atoms)),
        ..PLAIN
    },
    PointFormat {
        name: "PWN",
        extensions: &["pwn"],
        takes_columns: true,
        fuzzed_by: "pwn",
        read: built!("formats", |path, columns| {
            xyz::read(path, columns, xyz::Counted::PointsThenNormals)
        }),
        ..PLAIN
    },
    PointFormat {
        name: "PLY",
        extensions: &["ply"],
        fuzzed_by: "ply",
        begins: |start| start.starts_with(b"ply\n") || start.starts_with(b"ply\r"),
        read: built!("formats", |path, _| ply::read(path)),
        ..PLAIN
    },
    PointFormat {
        name: "OFF",
        extensions: &["off"],
        fuzzed_by: "off",
        read: built!("formats", |path, _| off::read(path)),
        ..PLAIN
    },
    PointFormat {
        name: "OBJ",
        extensions: &["obj"],
        fuzzed_by: "obj",
        read: built!("formats", |path, _| obj::read(path)),
        ..PLAIN
    },
    PointFormat {
        name: "STL",
        extensions: &["stl"],
        fuzzed_by: "stl",
        read: built!("formats", |path, _| stl::read(path)),
        ..PLAIN
    },
    PointFormat {
        name: "PCD",
        extensions: &["pcd"],
        fuzzed_by: "pcd",
        begins: |start| start.starts_with(b"# .PCD"),
        read: built!("formats", |path, _| pcd::read(path)),
        ..PLAIN
    },
    PointFormat {
        name: "VTU, VTP",
        extensions: &["vtu", "vtp"],
        fuzzed_by: "vtk_geometry",
        begins: is_vtk_xml,
        holds_points: is_geometry,
        read: built!("formats", |path, _| vtk::read(path)),
        ..PLAIN
    },
    PointFormat {
        name: "NPY",
        extensions: &["npy"],
        feature: None,
        fuzzed_by: "npy_points",
        begins: |start| NpyFile::begins(start),
        holds_points: |path| {
            Ok(NpyFile::begins(&start_of(path)?) && NpyFile::open(path)?.shape.len() == 2)
        },
        read: Some(|path, _| npy::read(path)),
        writers: &[PointWriter { extension: "npy", write: write::npy }],
        ..PLAIN
    },
    PointFormat {
        name: "LAS, LAZ",
        extensions: &["las", "laz"],
        feature: Some("las"),
        fuzzed_by: "las",
        begins: |start| start.starts_with(b"LASF"),
        read: built!("las", |path, _| super::read::las::read(path)),
        ..PLAIN
    },
];

/// Whether a file of VTK's XML holds points.
#[cfg_attr(
    not(feature = "formats"),
    expect(clippy::unnecessary_wraps, reason = "the file is not read")
)]
fn is_geometry(path: &Path) -> Result<bool, PointsError> {
    #[cfg(feature = "formats")]
    return vtk::holds_points(path);
    #[cfg(not(feature = "formats"))]
    {
        let extension = path.extension().unwrap_or_default();
        Ok(extension == "vtu" || extension == "vtp")
    }
}

impl PointFormat {
    /// Whether it was built in.
    pub fn is_built_in(&self) -> bool {
        self.read.is_some()
    }

    pub(super) fn begins(&self, start: &[u8]) -> bool {
        (self.begins)(start)
    }

    pub(super) fn holds_points(&self, path: &Path) -> Result<bool, PointsError> {
        (self.holds_points)(path)
    }

    pub(super) fn read(
        &self,
        path: &Path,
        columns: Option<&Columns>,
    ) -> Result<Points, PointsError> {
        if let Some(read) = self.read {
            read(path, columns)
        } else {
            let (what, feature) = (self.name, self.feature.unwrap_or_default());
            Err(format(path, Reason::Without { what, feature }))
        }
    }
}

impl fmt::Debug for PointFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PointFormat").field("name", &self.name).finish_non_exhaustive()
    }
}

impl PointWriter {
    /// All there are.
    pub fn all() -> impl Iterator<Item = &'static Self> + Clone {
        FORMATS.iter().flat_map(|format| format.writers)
    }

    /// The writer a path asks for by its extension.
    ///
    /// # Errors
    /// [`UnknownFormat`] names the ones there are.
    pub fn of(path: &Path) -> Result<&'static Self, UnknownFormat> {
        UnknownFormat::find(path, "points", Self::all().map(|writer| (writer.extension, writer)))
    }

    /// Writes the whole file. The same points give the same bytes.
    ///
    /// # Errors
    /// Whatever `out` returns.
    pub fn write(&self, points: &WeightedPoints, out: &mut dyn Write) -> io::Result<()> {
        (self.write)(points, out)
    }
}

impl fmt::Debug for PointWriter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PointWriter").field("extension", &self.extension).finish_non_exhaustive()
    }
}
