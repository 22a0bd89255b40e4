//! The formats of points: their names, and how each is recognised, read and written. Every other list of
//! formats is derived from the [table](FORMATS).

use std::fmt;
use std::io::{self, Write};
use std::path::Path;

use walpha_base::advice::Setting;
use walpha_base::foreign::decode;
use walpha_check::meshes::Mesh;

use super::model::MODEL;
use super::read::xyz::{self, TextLayout};
use super::read::{format, npy};
use super::read::{gro, lammps_data, lammps_dump, mmcif, poscar};
use super::read::{obj, off, pcd, pdb, ply, pqr, stated, stl, vtk};
use super::write::{self, Content};
use super::wvm;
use super::{
    CellCount, Column, ModelMetadata, Packing, PointOptions, Points, PointsError, WeightedPoints,
};
use walpha_volume::VtkPoints;
use walpha_volume::{
    OpenFile, Reason, UnknownFormat, built, is_cif, is_gro, is_lammps_data, is_lammps_dump, is_npy,
    is_pdb, is_poscar, is_vtk, is_vtk_xml,
};

/// Reads the points of a file and their metadata, which is empty where the format has none.
type Read = fn(&OpenFile, &PointOptions) -> Result<(Points, ModelMetadata), PointsError>;

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
    /// The settings that it has a use for, of those that only some formats have.
    pub chooses: &'static [Setting],
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
    /// Whether its files are also read compressed with gzip, or alone in a ZIP archive.
    pub(super) is_packed: bool,
    /// Whether its reader describes all columns, also those that it does not keep.
    pub(super) describes: bool,
    /// Whether its reader leaves out points outside the region, and all but the first in each cube.
    pub(super) reduces: bool,
    /// Its reader, unless it was left out of the build.
    read: Option<Read>,
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
    /// Whether it stores all metadata ([`ModelMetadata`]) and compresses ([`Packing`]).
    pub packs: bool,
    /// Whether it stores further columns.
    pub columns: bool,
    write: WriteAll,
}

/// Writes points, their columns and metadata.
type WriteAll = fn(&Content<'_>, &mut dyn Write) -> io::Result<()>;

/// A format recognised by extension only.
const PLAIN: PointFormat = PointFormat {
    name: "",
    extensions: &[],
    chooses: &[],
    feature: None,
    fuzzed_by: "",
    begins: |_| false,
    holds_points: |_| Ok(true),
    writers: &[],
    is_packed: false,
    describes: false,
    reduces: false,
    read: None,
    cells: None,
    read_complex: None,
};

/// The formats of points, in the order in which they are tried. The first is the default for files of no
/// recognised format.
pub static FORMATS: [PointFormat; 22] = [
    PointFormat {
        name: "CSV, TSV",
        extensions: &["csv", "tsv"],
        chooses: &[Setting::Columns, Setting::Frame],
        fuzzed_by: "table",
        is_packed: true,
        read: Some(|file, options| xyz::read(file, options, TextLayout::Table)),
        writers: &[PointWriter {
            extension: "csv",
            packs: false,
            columns: true,
            write: write::csv,
        }],
        ..PLAIN
    },
    PointFormat {
        name: "XYZ",
        extensions: &["xyz", "txt", "asc"],
        chooses: &[Setting::Columns, Setting::Frame, Setting::Radii],
        fuzzed_by: "xyz",
        is_packed: true,
        read: Some(|file, options| xyz::read(file, options, TextLayout::Atoms)),
        ..PLAIN
    },
    PointFormat {
        name: "XYZ with normals or colours",
        extensions: &["xyzn", "xyzrgb"],
        chooses: &[Setting::Columns, Setting::Frame],
        fuzzed_by: "xyz",
        is_packed: true,
        read: Some(|file, options| xyz::read(file, options, TextLayout::Vectors)),
        ..PLAIN
    },
    PointFormat {
        name: "PTS",
        extensions: &["pts"],
        chooses: &[Setting::Columns, Setting::Frame],
        fuzzed_by: "xyz",
        is_packed: true,
        read: Some(|file, options| xyz::read(file, options, TextLayout::Scan)),
        ..PLAIN
    },
    PointFormat {
        name: "PWN",
        extensions: &["pwn"],
        chooses: &[Setting::Columns],
        fuzzed_by: "pwn",
        is_packed: true,
        read: Some(|file, options| xyz::read(file, options, TextLayout::PointsThenNormals)),
        ..PLAIN
    },
    PointFormat {
        name: "PDB",
        extensions: &["pdb", "ent"],
        chooses: OF_ATOMS,
        fuzzed_by: "pdb",
        begins: is_pdb,
        is_packed: true,
        read: Some(pdb::read),
        ..PLAIN
    },
    PointFormat {
        name: "mmCIF, CIF",
        extensions: &["cif", "mmcif"],
        chooses: OF_ATOMS,
        fuzzed_by: "mmcif",
        begins: is_cif,
        is_packed: true,
        read: Some(mmcif::read),
        ..PLAIN
    },
    PointFormat {
        name: "PQR",
        extensions: &["pqr"],
        chooses: &[Setting::Radii, Setting::Chains, Setting::Models],
        fuzzed_by: "pqr",
        begins: is_pdb,
        is_packed: true,
        read: Some(pqr::read),
        ..PLAIN
    },
    PointFormat {
        name: "GRO",
        extensions: &["gro"],
        chooses: &[Setting::Radii, Setting::Hydrogens, Setting::Waters, Setting::Frame],
        fuzzed_by: "gro",
        begins: is_gro,
        is_packed: true,
        read: Some(gro::read),
        ..PLAIN
    },
    PointFormat {
        name: "LAMMPS data",
        extensions: &["lmp", "lammps"],
        chooses: &[Setting::Radii],
        fuzzed_by: "lammps_data",
        begins: is_lammps_data,
        is_packed: true,
        read: Some(lammps_data::read),
        ..PLAIN
    },
    PointFormat {
        name: "LAMMPS dump",
        extensions: &["lammpstrj", "dump"],
        chooses: &[Setting::Radii, Setting::Frame],
        fuzzed_by: "lammps_dump",
        begins: is_lammps_dump,
        is_packed: true,
        read: Some(lammps_dump::read),
        ..PLAIN
    },
    PointFormat {
        name: "POSCAR",
        extensions: &["vasp", "poscar", "contcar"],
        chooses: &[Setting::Radii],
        fuzzed_by: "poscar",
        begins: is_poscar,
        is_packed: true,
        read: Some(poscar::read),
        ..PLAIN
    },
    PointFormat {
        name: "PLY",
        extensions: &["ply"],
        fuzzed_by: "ply",
        begins: |start| {
            start.starts_with(b"ply") && start.get(3).is_some_and(u8::is_ascii_whitespace)
        },
        is_packed: true,
        read: Some(|file, options| {
            let points = ply::read(file, &options.attributes)?;
            Ok(stated::in_comments(file, points, &["comment", "obj_info"]))
        }),
        cells: Some(ply::cells),
        read_complex: Some(ply::read_complex),
        ..PLAIN
    },
    PointFormat {
        name: "OFF",
        extensions: &["off"],
        fuzzed_by: "off",
        is_packed: true,
        read: Some(|file, _| Ok(stated::in_comments(file, off::read(file)?, &["#"]))),
        cells: Some(off::cells),
        ..PLAIN
    },
    PointFormat {
        name: "OBJ",
        extensions: &["obj"],
        fuzzed_by: "obj",
        is_packed: true,
        read: Some(|file, _| Ok(stated::in_comments(file, obj::read(file)?, &["#"]))),
        cells: Some(obj::cells),
        ..PLAIN
    },
    PointFormat {
        name: "STL",
        extensions: &["stl"],
        fuzzed_by: "stl",
        is_packed: true,
        read: Some(|file, _| Ok(stated::in_stl(file, stl::read(file)?))),
        cells: Some(stl::cells),
        ..PLAIN
    },
    PointFormat {
        name: "PCD",
        extensions: &["pcd"],
        fuzzed_by: "pcd",
        begins: |start| start.starts_with(b"# .PCD"),
        is_packed: true,
        read: Some(|file, _| plain(pcd::read(file))),
        ..PLAIN
    },
    PointFormat {
        name: "VTU, VTP",
        extensions: &["vtu", "vtp"],
        fuzzed_by: "vtk_geometry",
        begins: is_vtk_xml,
        holds_points: vtk::holds_points,
        read: Some(|file, options| stated::in_vtk(file, vtk::read(file, &options.attributes)?)),
        cells: Some(vtk::cells),
        read_complex: Some(vtk::read_complex),
        ..PLAIN
    },
    PointFormat {
        name: "VTK polygons and grids",
        extensions: &["vtk"],
        fuzzed_by: "vtk_geometry",
        begins: is_vtk,
        holds_points: lists_points,
        read: Some(|file, _| plain(vtk::read_legacy(file))),
        cells: Some(vtk::cells_of_legacy),
        read_complex: Some(vtk::read_legacy_complex),
        ..PLAIN
    },
    PointFormat {
        name: "NPY",
        extensions: &["npy"],
        feature: None,
        fuzzed_by: "npy_points",
        begins: is_npy,
        chooses: &[Setting::Columns],
        holds_points: |file| Ok(is_npy(file.start()) && npy::holds_points(file)?),
        read: Some(|file, options| plain(npy::read(file, options))),
        writers: &[PointWriter {
            extension: "npy",
            packs: false,
            columns: true,
            write: write::npy,
        }],
        ..PLAIN
    },
    PointFormat {
        name: "LAS, LAZ",
        extensions: &["las", "laz"],
        feature: Some("las"),
        fuzzed_by: "las",
        begins: |start| start.starts_with(b"LASF"),
        chooses: &[Setting::Class, Setting::Withheld],
        describes: true,
        reduces: true,
        writers: SCAN_WRITERS,
        read: built!("las", super::read::las::read),
        ..PLAIN
    },
    PointFormat {
        name: "WVM",
        extensions: &["wvm"],
        fuzzed_by: "wvm",
        begins: |start| start.starts_with(MODEL),
        chooses: &[Setting::Level],
        read: Some(|file, options| wvm::read(file, options.level.unwrap_or_default())),
        writers: MODEL_WRITERS,
        ..PLAIN
    },
];

/// The settings that choose atoms and their radii.
pub(crate) const OF_ATOMS: &[Setting] = &[
    Setting::Radii,
    Setting::Hydrogens,
    Setting::Waters,
    Setting::Hetero,
    Setting::Chains,
    Setting::Models,
];

/// The writer of `.wvm`.
const MODEL_WRITERS: &[PointWriter] = &[PointWriter {
    extension: "wvm",
    packs: true,
    columns: false,
    write: |content, out| wvm::write(content.points, content.metadata, content.packing, out),
}];

/// The writers of LAS, if built in.
#[cfg(feature = "las")]
const SCAN_WRITERS: &[PointWriter] = &[
    PointWriter {
        extension: "las",
        packs: false,
        columns: true,
        write: |content, out| write::las::write(content, false, out),
    },
    PointWriter {
        extension: "laz",
        packs: false,
        columns: true,
        write: |content, out| write::las::write(content, true, out),
    },
];
#[cfg(not(feature = "las"))]
const SCAN_WRITERS: &[PointWriter] = &[];

/// Points of a format without metadata.
fn plain(points: Result<Points, PointsError>) -> Result<(Points, ModelMetadata), PointsError> {
    Ok((points?, ModelMetadata::default()))
}

/// Whether a legacy VTK file lists points.
#[expect(clippy::unnecessary_wraps, reason = "the reader reports damaged files")]
fn lists_points(file: &OpenFile) -> Result<bool, PointsError> {
    Ok(VtkPoints::lists_points(file).unwrap_or(false))
}

impl PointFormat {
    /// Whether its reader is part of this build.
    pub fn is_built_in(&self) -> bool {
        self.read.is_some()
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

    pub(super) fn read(
        &self,
        file: &OpenFile,
        options: &PointOptions,
    ) -> Result<(Points, ModelMetadata), PointsError> {
        let Some(read) = self.read else {
            let (what, feature) = (self.name, self.feature.unwrap_or_default());
            return Err(format(file.path(), Reason::Without { what, feature }));
        };
        // What panics in it, in a decoder that others wrote, is an error of the file.
        decode(|| read(file, options)).unwrap_or_else(|panicked| {
            Err(format(file.path(), Reason::damaged(panicked.to_string())))
        })
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
        self.write_model(points, &[], &ModelMetadata::default(), &Packing::default(), out)
    }

    /// [`write`](Self::write) with further columns, which only formats that [have them](Self::columns) use, and with metadata and
    /// packing options, which only formats that [pack](Self::packs) use. LAS takes its header and types of columns from metadata.
    ///
    /// # Errors
    /// As [`write`](Self::write); a column without a number for each point; for LAS, a number that its field cannot hold.
    pub fn write_model(
        &self,
        points: &WeightedPoints,
        columns: &[Column],
        metadata: &ModelMetadata,
        packing: &Packing,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        let refused = |what: String| Err(io::Error::new(io::ErrorKind::InvalidInput, what));
        if packing.value_error.is_nan() || packing.value_error < 0.0 {
            return refused(format!(
                "{} is not a valid error bound for values",
                packing.value_error
            ));
        }
        if let Some(column) = columns.iter().find(|column| column.values.len() != points.len()) {
            let Column { name, values } = column;
            let (numbers, points) = (values.len(), points.len());
            return refused(format!("column {name} has {numbers} numbers for {points} points"));
        }
        let own = [Some(points.weights()), points.values()];
        for (index, place) in points.positions().iter().enumerate() {
            let others = own.iter().flatten().map(|column| column[index]);
            if let Some(number) = place.iter().copied().chain(others).find(|x| !x.is_finite()) {
                return refused(format!(
                    "point {index} has {number}, which is not a finite number"
                ));
            }
        }
        (self.write)(&Content { points, columns, metadata, packing }, out)
    }
}

impl fmt::Debug for PointWriter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PointWriter").field("extension", &self.extension).finish_non_exhaustive()
    }
}
