//! The table of the formats of volumes.

use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use walpha_base::Monitor;
use walpha_base::advice::Setting;

use super::magic::{is_dicom, is_metaimage, is_mgh, is_nifti, is_npy, is_tiff, is_vtk, is_vtk_xml};
use super::{UnknownFormat, built};
use crate::read::{OpenFile, inr, npy, series};
use crate::read::{metaimage, mgh, nifti, npz, nrrd, slices, tiff, vtk};
use crate::{ReadOptions, Source, Volume, VolumeError, write};

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
    /// The name for people.
    pub name: &'static str,
    /// The extensions of files read, without their first dots.
    pub extensions: &'static [&'static str],
    /// What the format stores about the grid and its samples.
    pub keeps: Keeps,
    /// The settings that choose one volume from a file or folder of several.
    pub chooses: &'static [Setting],
    /// The feature that reads and writes the format; `None` if it needs no feature.
    pub feature: Option<&'static str>,
    /// The fuzz targets of the format.
    pub fuzzed_by: &'static [&'static str],
    /// The writers of the format.
    pub writers: &'static [VolumeWriter],
    /// Whether a file is also read if it is compressed with gzip as a whole.
    pub(super) gzip: bool,
    /// Whether a file with these first bytes is in the format.
    pub(super) begins: fn(&[u8]) -> bool,
    /// The name for people of a folder in the format.
    pub(super) folder_name: &'static str,
    /// Whether a folder is in the format.
    pub(super) is_folder: fn(&Path) -> Result<bool, VolumeError>,
    /// Reads a file, if the format has files and was built in.
    pub(super) read: Option<Read>,
    /// Reads a folder, if the format has folders and was built in.
    pub(super) read_folder: Option<ReadFolder>,
    /// Opens a file to be read part by part, if the format allows that.
    pub(super) parts: Option<PartsOf>,
    /// Opens a folder to be read part by part, if the format allows that.
    pub(super) parts_of_folder: Option<PartsOfFolder>,
    /// Lists the files that hold the samples, if they are not in the header's file.
    pub(super) data_files: Option<DataFiles>,
}

/// What a format stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is an answer of its own")]
pub struct Keeps {
    /// The distances between samples.
    pub spacing: bool,
    /// The position of the grid and the directions of its axes.
    pub directions: bool,
    /// The space of its position and directions.
    pub space: bool,
    /// The unit of length.
    pub unit: bool,
    /// Whether the file stores the type of samples; if not, the user has to give it.
    pub dtype: bool,
}

/// Writes volumes under an extension: samples as `f32`, little-endian; and the frame if the format has one, in the space and unit
/// of its convention.
#[derive(Clone, Copy)]
pub struct VolumeWriter {
    /// The extension without its first dot.
    pub extension: &'static str,
    write: WriteAs,
}

type WriteAs = fn(&Volume, &mut dyn Write) -> io::Result<()>;

impl VolumeFormat {
    /// Whether the format was built in.
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
    /// The writers that were built in.
    pub fn all() -> impl Iterator<Item = &'static Self> + Clone {
        FORMATS.iter().filter(|format| format.is_built_in()).flat_map(|format| format.writers)
    }

    /// The writer that the extension of a path asks for.
    ///
    /// # Errors
    /// [`UnknownFormat`] names the existing ones.
    pub fn of(path: impl AsRef<Path>) -> Result<&'static Self, UnknownFormat> {
        let path = path.as_ref();
        UnknownFormat::find(path, "a volume", Self::all().map(|writer| (writer.extension, writer)))
    }

    /// Writes the whole file. The same volume gives the same bytes.
    ///
    /// # Errors
    /// The errors of `out`.
    pub fn write(&self, volume: &Volume, out: &mut dyn Write) -> io::Result<()> {
        (self.write)(volume, out)
    }
}

impl fmt::Debug for VolumeWriter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("VolumeWriter").field("extension", &self.extension).finish_non_exhaustive()
    }
}

/// A format that stores everything about the grid.
const ALL: Keeps = Keeps { spacing: true, directions: true, space: true, unit: true, dtype: true };
/// A format that stores the samples alone.
const SAMPLES: Keeps =
    Keeps { spacing: false, directions: false, space: false, unit: false, dtype: true };

const fn writer(extension: &'static str, write: WriteAs) -> VolumeWriter {
    VolumeWriter { extension, write }
}

/// A format of single files that are recognised by their extension only.
const PLAIN: VolumeFormat = VolumeFormat {
    name: "",
    extensions: &[],
    keeps: SAMPLES,
    chooses: &[],
    feature: None,
    fuzzed_by: &[],
    writers: &[],
    gzip: false,
    begins: |_| false,
    folder_name: "",
    is_folder: |_| Ok(false),
    read: None,
    read_folder: None,
    parts: None,
    parts_of_folder: None,
    data_files: None,
};

/// The formats of volumes, in the order in which they are tried.
pub static FORMATS: [VolumeFormat; 14] = [
    // DICOM comes first, because its files may begin like those of another format, too.
    VolumeFormat {
        name: "DICOM",
        keeps: ALL,
        chooses: &[Setting::Series, Setting::Frame, Setting::SkipDamaged, Setting::NoResample],
        feature: Some("dicom"),
        fuzzed_by: &["dicom"],
        begins: is_dicom,
        folder_name: "DICOM series",
        is_folder: |folder| Ok(series::first(folder)?.is_some()),
        read: built!("dicom", |file, options, monitor| {
            crate::read::dicom::read_series_of(file.path(), options, monitor)
        }),
        read_folder: built!("dicom", crate::read::dicom::read_folder),
        ..PLAIN
    },
    VolumeFormat {
        name: "Zarr",
        keeps: Keeps { spacing: true, unit: true, ..SAMPLES },
        chooses: &[Setting::Level, Setting::Frame],
        feature: Some("zarr"),
        fuzzed_by: &["zarr"],
        folder_name: "Zarr",
        is_folder: |folder| Ok(series::is_zarr(folder)),
        read_folder: built!("zarr", |path, options, monitor| {
            crate::read::zarr::read(path, options.level, options.frame, monitor)
        }),
        parts_of_folder: built!("zarr", |path, options| {
            crate::read::zarr::source(path, options.level, options.frame)
        }),
        ..PLAIN
    },
    VolumeFormat {
        name: "NRRD",
        extensions: &["nrrd", "nhdr"],
        keeps: ALL,
        chooses: &[Setting::Frame],
        feature: None,
        fuzzed_by: &["nrrd"],
        writers: &[writer("nrrd", write::nrrd)],
        begins: |start| start.starts_with(b"NRRD000"),
        read: Some(|file, options, monitor| nrrd::read(file, options.frame, monitor)),
        parts: Some(|file, options| Ok(nrrd::box_reader(file, options.frame)?.source())),
        data_files: Some(nrrd::data_files),
        ..PLAIN
    },
    VolumeFormat {
        name: "NIfTI",
        extensions: &["nii", "hdr", "nii.gz"],
        keeps: ALL,
        chooses: &[Setting::Frame],
        feature: None,
        fuzzed_by: &["nifti", "nifti_gzip"],
        writers: &[writer("nii", write::nifti), writer("nii.gz", write::nifti_gzip)],
        gzip: true,
        begins: is_nifti,
        read: Some(|file, options, monitor| nifti::read(file, options.frame, monitor)),
        parts: Some(|file, options| Ok(nifti::box_reader(file, options.frame)?.source())),
        data_files: Some(nifti::data_files),
        ..PLAIN
    },
    VolumeFormat {
        name: "MGH (FreeSurfer)",
        extensions: &["mgz", "mgh", "mgh.gz"],
        keeps: ALL,
        chooses: &[Setting::Frame],
        feature: None,
        fuzzed_by: &["mgh"],
        gzip: true,
        begins: is_mgh,
        read: Some(|file, options, monitor| mgh::read(file, options.frame, monitor)),
        parts: Some(|file, options| Ok(mgh::box_reader(file, options.frame)?.source())),
        ..PLAIN
    },
    VolumeFormat {
        name: "MetaImage",
        extensions: &["mha", "mhd"],
        keeps: ALL,
        chooses: &[Setting::Frame],
        feature: None,
        fuzzed_by: &["metaimage"],
        writers: &[writer("mha", write::metaimage)],
        begins: is_metaimage,
        read: Some(|file, options, monitor| metaimage::read(file, options.frame, monitor)),
        parts: Some(|file, options| Ok(metaimage::box_reader(file, options.frame)?.source())),
        data_files: Some(metaimage::data_files),
        ..PLAIN
    },
    VolumeFormat {
        name: "VTK image data (XML)",
        extensions: &["vti"],
        keeps: ALL,
        chooses: &[Setting::Array],
        feature: None,
        fuzzed_by: &["vti"],
        writers: &[writer("vti", write::vti)],
        begins: is_vtk_xml,
        read: Some(|file, options, monitor| {
            vtk::read_image(file, options.array.as_deref(), monitor)
        }),
        ..PLAIN
    },
    VolumeFormat {
        name: "VTK structured points",
        extensions: &["vtk"],
        keeps: Keeps { spacing: true, directions: true, ..SAMPLES },
        chooses: &[Setting::Array],
        feature: None,
        fuzzed_by: &["vtk_legacy"],
        begins: is_vtk,
        read: Some(|file, options, monitor| {
            vtk::read_legacy(file, options.array.as_deref(), monitor)
        }),
        ..PLAIN
    },
    VolumeFormat {
        name: "TIFF",
        extensions: &["tif", "tiff"],
        keeps: Keeps { spacing: true, unit: true, ..SAMPLES },
        chooses: &[Setting::Frame],
        feature: None,
        fuzzed_by: &["tiff"],
        writers: &[writer("tif", write::tiff), writer("tiff", write::tiff)],
        begins: is_tiff,
        read: Some(|file, options, monitor| tiff::read(file, options.frame, monitor)),
        ..PLAIN
    },
    VolumeFormat {
        name: "INRIMAGE",
        extensions: &["inr", "inr.gz"],
        keeps: Keeps { spacing: true, ..SAMPLES },
        fuzzed_by: &["inrimage"],
        gzip: true,
        begins: |start| start.starts_with(b"#INRIMAGE-4#{"),
        read: Some(|file, _, monitor| inr::open(file, monitor)),
        ..PLAIN
    },
    VolumeFormat {
        name: "NPY",
        extensions: &["npy"],
        chooses: &[Setting::Frame],
        fuzzed_by: &["npy"],
        writers: &[VolumeWriter { extension: "npy", write: write::npy }],
        begins: is_npy,
        read: Some(|file, options, monitor| npy::read(file, options.frame, monitor)),
        parts: Some(|file, options| Ok(npy::box_reader(file, options.frame)?.source())),
        ..PLAIN
    },
    VolumeFormat {
        name: "NPZ",
        extensions: &["npz"],
        chooses: &[Setting::Array],
        feature: None,
        fuzzed_by: &["npz"],
        begins: |start| start.starts_with(b"PK\x03\x04") || start.starts_with(b"PK\x05\x06"),
        read: Some(|file, options, monitor| npz::read(file, options.array.as_deref(), monitor)),
        ..PLAIN
    },
    VolumeFormat {
        name: "folder of slices",
        feature: None,
        fuzzed_by: &["slices"],
        folder_name: "folder of slices",
        is_folder: |_| Ok(true),
        read_folder: Some(|path, _, _| slices::read(path)),
        ..PLAIN
    },
    // Bare samples cannot be recognised: the user describes them.
    VolumeFormat {
        name: "raw samples",
        keeps: Keeps { dtype: false, ..SAMPLES },
        writers: &[VolumeWriter { extension: "raw", write: write::raw }],
        ..PLAIN
    },
];
