//! The formats of volumes: what each is called, how it is recognised, read and written, and what it
//! keeps. Whatever else lists formats is made from the [table](FORMATS).

mod begins;
mod built;
mod detect;
mod table;
mod unknown;

use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

pub use detect::{data_files, files_of, format_name, read, read_file, read_monitored, series};
pub use table::FORMATS;
pub use unknown::UnknownFormat;

pub(crate) use begins::is_gzip;
#[cfg(feature = "formats")]
pub(crate) use begins::{NIFTI_HEADERS, nifti_version};
pub use begins::{is_npy, is_vtk, is_vtk_xml};
pub use built::built;
pub use detect::begins_as_volume;
pub(crate) use detect::source;

use walpha_base::Monitor;
use walpha_base::advice::Setting;

use super::{OpenFile, ReadOptions, Source, Volume, VolumeError};

/// Reads a file.
type Read = fn(&OpenFile, &ReadOptions, &Monitor) -> Result<Volume, VolumeError>;
/// Reads a folder.
type ReadFolder = fn(&Path, &ReadOptions, &Monitor) -> Result<Volume, VolumeError>;
/// Opens a file to be read part by part.
type PartsOf = fn(&OpenFile, &ReadOptions) -> Result<Source, VolumeError>;
/// Opens a folder to be read part by part.
type PartsOfFolder = fn(&Path, &ReadOptions) -> Result<Source, VolumeError>;
/// Names the files that hold the samples.
type DataFiles = fn(&OpenFile) -> Result<Vec<PathBuf>, VolumeError>;

/// A format of volumes.
pub struct VolumeFormat {
    /// For people.
    pub name: &'static str,
    /// The extensions of files read, without their first dots.
    pub extensions: &'static [&'static str],
    /// What it keeps of where samples lie and what they are.
    pub keeps: Keeps,
    /// Which settings choose one volume of a file or folder of several.
    pub chooses: &'static [Setting],
    /// The feature that reads and writes it; `None` where it needs none.
    pub feature: Option<&'static str>,
    /// Its targets for fuzzing.
    pub fuzzed_by: &'static [&'static str],
    /// Its writers.
    pub writers: &'static [VolumeWriter],
    /// Whether a whole file of it is read when compressed with gzip.
    gzip: bool,
    /// How its files begin.
    begins: fn(&[u8]) -> bool,
    /// For people, a folder of it.
    folder_name: &'static str,
    /// How its folders look.
    is_folder: fn(&Path) -> Result<bool, VolumeError>,
    /// Reads a file, where the format has files and was not left out of the build.
    read: Option<Read>,
    /// Reads a folder, where the format has folders and was not left out of the build.
    read_folder: Option<ReadFolder>,
    /// Opens a file to be read part by part, where its format lends itself to that.
    parts: Option<PartsOf>,
    /// The same for a folder.
    parts_of_folder: Option<PartsOfFolder>,
    /// The files that hold the samples, where a header does not.
    data_files: Option<DataFiles>,
}

/// What a format keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is an answer of its own")]
pub struct Keeps {
    /// Distances of samples.
    pub spacing: bool,
    /// Where the grid begins and which way its axes run.
    pub directions: bool,
    /// The space these are in.
    pub space: bool,
    /// The unit of lengths.
    pub unit: bool,
    /// The type of samples; without it the user says it.
    pub dtype: bool,
}

/// How volumes are written under an extension: samples as `f32`, little-endian, and the frame where the
/// format has one, in the space and unit that are its convention.
#[derive(Clone, Copy)]
pub struct VolumeWriter {
    /// The extension without its first dot.
    pub extension: &'static str,
    write: fn(&Volume, &mut dyn Write) -> io::Result<()>,
}

impl VolumeFormat {
    /// Whether it was built in.
    pub fn is_built_in(&self) -> bool {
        self.feature.is_none() || self.read.is_some() || self.read_folder.is_some()
    }
}

impl fmt::Debug for VolumeFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("VolumeFormat").field("name", &self.name).finish_non_exhaustive()
    }
}

impl VolumeWriter {
    /// Those that were built in.
    pub fn all() -> impl Iterator<Item = &'static Self> + Clone {
        FORMATS.iter().filter(|format| format.is_built_in()).flat_map(|format| format.writers)
    }

    /// The writer a path asks for by its extension.
    ///
    /// # Errors
    /// [`UnknownFormat`] names the ones there are.
    pub fn of(path: &Path) -> Result<&'static Self, UnknownFormat> {
        UnknownFormat::find(path, "a volume", Self::all().map(|writer| (writer.extension, writer)))
    }

    /// Writes the whole file. The same volume gives the same bytes.
    ///
    /// # Errors
    /// Whatever `out` returns.
    pub fn write(&self, volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
        (self.write)(volume, out)
    }
}

impl fmt::Debug for VolumeWriter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("VolumeWriter").field("extension", &self.extension).finish_non_exhaustive()
    }
}
