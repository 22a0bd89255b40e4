//! Reads meshes of tetrahedra in the formats of other programs, to judge them.
//!
//! A [`Mesh`] consists of the points and the tetrahedra of a file, and is judged as the triangulation that it claims to be, at α
//! = ∞ unless the file states an α. Each format is an entry of [`FORMATS`] and a separate module. Text contains decimal numbers,
//! each of which is read as the nearest double.
//!
//! ```
//! use walpha_check::meshes::Mesh;
//! use walpha_check::schema::PlacedComplex;
//!
//! # let folder = std::env::temp_dir().join(format!("walpha-check-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder)?;
//! let path = folder.join("one.mesh");
//! let text = "MeshVersionFormatted 2 Dimension 3 Vertices 4 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0 \
//!             Tetrahedra 1 1 2 3 4 0 End";
//! std::fs::write(&path, text)?;
//! let mesh = Mesh::open(&path)?;
//! assert_eq!(mesh.notes[0], "coordinates are decimal numbers, each taken to the nearest double");
//! let (findings, certificate) = PlacedComplex::try_from(mesh.complex)?.findings()?;
//! assert_eq!(certificate.to_string(), "exact: no findings");
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod error;
mod gmsh;
mod grid;
mod medit;
mod scan;
mod tetgen;
mod vtk;
mod weights;

use std::ffi::OsStr;
use std::path::Path;

use crate::Alpha;
use crate::schema::ComplexFile;

pub use error::MeshError;
pub use grid::Grid;
pub use weights::open_weights;

/// The points and tetrahedra of a file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Mesh {
    /// The points and the tetrahedra; for VTK also weights, and simplices of all dimensions if it states α.
    pub complex: ComplexFile,
    /// The first attribute of each point, if attributes have no names (`TetGen`). It is a weight only if the user says so.
    pub attribute: Option<Vec<f64>>,
    /// Notes for the reader of the verdict: how numbers were read, and what was left out.
    pub notes: Vec<String>,
}

/// A format of meshes.
#[derive(Debug)]
#[non_exhaustive]
pub struct MeshFormat {
    /// Its name for users.
    pub name: &'static str,
    /// Extensions, without dots.
    pub extensions: &'static [&'static str],
    /// Its fuzz target.
    pub fuzzed_by: &'static str,
    read: fn(&Path, &[u8]) -> Result<Mesh, MeshError>,
}

/// The formats that are read.
pub static FORMATS: [MeshFormat; 4] = [
    MeshFormat {
        name: "TetGen",
        fuzzed_by: "tetgen",
        extensions: &["node", "ele"],
        read: tetgen::read,
    },
    MeshFormat {
        name: "Gmsh",
        fuzzed_by: "gmsh",
        extensions: &["msh"],
        read: |_, bytes| gmsh::read(bytes),
    },
    MeshFormat {
        name: "Medit",
        fuzzed_by: "medit",
        extensions: &["mesh"],
        read: |_, bytes| medit::read(bytes),
    },
    MeshFormat {
        name: "legacy VTK",
        fuzzed_by: "vtk_mesh",
        extensions: &["vtk"],
        read: |_, bytes| vtk::read(bytes),
    },
];

impl MeshFormat {
    /// The format with this extension, in any letter case.
    pub fn named(extension: &str) -> Option<&'static Self> {
        // The reader of Medit reports binary files.
        let is_binary = extension.eq_ignore_ascii_case("meshb");
        let extension = if is_binary { "mesh" } else { extension };
        let is_it = |own: &&str| own.eq_ignore_ascii_case(extension);
        FORMATS.iter().find(|format| format.extensions.iter().any(is_it))
    }

    /// The format with the extension of a path. The file need not exist.
    pub fn of(path: impl AsRef<Path>) -> Option<&'static Self> {
        Self::named(path.as_ref().extension().and_then(OsStr::to_str)?)
    }

    /// Reads a file of this format.
    ///
    /// # Errors
    /// A file that cannot be read, is damaged or truncated, or lists other cells than tetrahedra.
    pub fn read(&self, path: impl AsRef<Path>) -> Result<Mesh, MeshError> {
        let path = path.as_ref();
        self.read_bytes(path, &std::fs::read(path)?)
    }

    /// Reads the content of a file that was opened already. Of `TetGen`'s two files, the other one is searched for next to the
    /// path.
    ///
    /// # Errors
    /// See [`MeshFormat::read`].
    pub fn read_bytes(&self, path: impl AsRef<Path>, bytes: &[u8]) -> Result<Mesh, MeshError> {
        (self.read)(path.as_ref(), bytes)
    }
}

impl Mesh {
    /// Reads a file, in the format of its extension.
    ///
    /// # Errors
    /// An extension that is not known, and the errors of [`MeshFormat::read`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, MeshError> {
        let format = MeshFormat::of(path.as_ref());
        format.ok_or_else(|| MeshError::new("its extension is not that of a mesh"))?.read(path)
    }

    /// Points and cells that are judged as a triangulation.
    fn of_cells(points: Vec<[f64; 3]>, cells: Vec<[u32; 4]>) -> Result<Self, MeshError> {
        if points.is_empty() {
            return Err(MeshError::new("the file lists no points").with_advice(scan::WRITE_AGAIN));
        }
        if cells.is_empty() {
            let error = MeshError::new("the file lists no tetrahedra, which are what is judged");
            return Err(error.with_advice("write the cells of the volume, too"));
        }
        let mut complex = ComplexFile::of_points(points, Alpha::INFINITE);
        complex.cells = Some(cells);
        Ok(complex.into())
    }

    fn with_note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// The mesh with a note about the way in which numbers in text were read.
    #[doc(hidden)]
    #[must_use]
    pub fn with_decimal_note(self) -> Self {
        self.with_note("coordinates are decimal numbers, each taken to the nearest double")
    }

    /// Notes that findings number points from 0, if the file numbers them from another number.
    fn with_numbering_note(self, first: u64) -> Self {
        if first == 0 {
            return self;
        }
        self.with_note(format!("points are numbered from 0 here, in the order of the file, which numbers them from {first}"))
    }

    /// The mesh with a note that only its tetrahedra are judged, and of the other kinds of cells, with their numbers.
    #[doc(hidden)]
    #[must_use]
    pub fn with_ignored(self, ignored: &[(impl AsRef<str>, u64)]) -> Self {
        let listed: Vec<String> = ignored
            .iter()
            .filter(|(_, count)| *count > 0)
            .map(|(kind, count)| format!("{count} {}", kind.as_ref()))
            .collect();
        if listed.is_empty() {
            return self;
        }
        self.with_note(format!("only tetrahedra are judged: {} are ignored", listed.join(", ")))
    }
}

/// Takes a complex without changes.
impl From<ComplexFile> for Mesh {
    fn from(complex: ComplexFile) -> Self {
        Self { complex, attribute: None, notes: Vec::new() }
    }
}

/// The error for cells that are not tetrahedra.
fn not_tetrahedra(what: &str) -> MeshError {
    let why = format!("the file lists {what}, and only tetrahedra of 4 nodes are judged");
    MeshError::new(why)
        .with_advice("cut other cells into tetrahedra, and write them in first order")
}

/// The error for a corner that is not a point.
fn no_such_point(
    scan: &scan::Scan,
    corner: impl std::fmt::Display,
    first: u64,
    count: usize,
) -> MeshError {
    let numbers = match count as u64 {
        0 => "there are none before the cells".to_owned(),
        count => format!("they are {first} to {}", first + count - 1),
    };
    let why = format!("corner {corner} of a cell is not the number of a point: {numbers}");
    scan.fault(why).with_advice("number the corners of cells as the points are numbered")
}
