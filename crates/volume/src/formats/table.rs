use walpha_base::advice::Setting;

use super::begins::{is_dicom, is_metaimage, is_mgh, is_nifti, is_npy, is_vtk, is_vtk_xml};
use super::built;
use super::{Keeps, VolumeFormat, VolumeWriter};
use crate::read::{inr, npy, series};

#[cfg(feature = "formats")]
use crate::read::{metaimage, mgh, nifti, npz, nrrd, slices, tiff, vti, vtk};
use crate::write;

/// All of a grid's place.
const ALL: Keeps = Keeps { spacing: true, directions: true, space: true, unit: true, dtype: true };
/// The samples alone.
const SAMPLES: Keeps =
    Keeps { spacing: false, directions: false, space: false, unit: false, dtype: true };

/// The writers that the feature `formats` brings.
macro_rules! writers {
    ($($extension:literal: $write:expr),*) => {{
        #[cfg(feature = "formats")]
        {
            &[$(VolumeWriter { extension: $extension, write: $write }),*]
        }
        #[cfg(not(feature = "formats"))]
        {
            &[]
        }
    }};
}

/// A format of single files, recognised by extension only.
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

/// The formats of volumes, in the order in which they are looked for.
pub static FORMATS: [VolumeFormat; 14] = [
    // First, because a file of it may begin as one of another, too.
    VolumeFormat {
        name: "DICOM",
        keeps: ALL,
        chooses: &[Setting::Series, Setting::SkipDamaged],
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
        feature: Some("formats"),
        fuzzed_by: &["nrrd"],
        writers: writers!["nrrd": write::nrrd],
        begins: |start| start.starts_with(b"NRRD000"),
        read: built!("formats", |file, options, monitor| nrrd::read(file, options.frame, monitor)),
        parts: built!("formats", |file, options| Ok(nrrd::rows(file, options.frame)?.source())),
        data_files: built!("formats", nrrd::data_files),
        ..PLAIN
    },
    VolumeFormat {
        name: "NIfTI",
        extensions: &["nii", "hdr", "nii.gz"],
        keeps: ALL,
        chooses: &[Setting::Frame],
        feature: Some("formats"),
        fuzzed_by: &["nifti", "nifti_gzip"],
        writers: writers!["nii": write::nifti, "nii.gz": write::nifti_gzip],
        gzip: true,
        begins: is_nifti,
        read: built!("formats", |file, options, monitor| nifti::read(file, options.frame, monitor)),
        parts: built!("formats", |file, options| Ok(nifti::rows(file, options.frame)?.source())),
        data_files: built!("formats", nifti::data_files),
        ..PLAIN
    },
    VolumeFormat {
        name: "MGH (FreeSurfer)",
        extensions: &["mgz", "mgh", "mgh.gz"],
        keeps: ALL,
        chooses: &[Setting::Frame],
        feature: Some("formats"),
        fuzzed_by: &["mgh"],
        gzip: true,
        begins: is_mgh,
        read: built!("formats", |file, options, monitor| mgh::read(file, options.frame, monitor)),
        parts: built!("formats", |file, options| Ok(mgh::rows(file, options.frame)?.source())),
        ..PLAIN
    },
    VolumeFormat {
        name: "MetaImage",
        extensions: &["mha", "mhd"],
        keeps: ALL,
        chooses: &[Setting::Frame],
        feature: Some("formats"),
        fuzzed_by: &["metaimage"],
        writers: writers!["mha": write::metaimage],
        begins: is_metaimage,
        read: built!("formats", |file, options, monitor| metaimage::read(
            file,
            options.frame,
            monitor
        )),
        parts: built!(
            "formats",
            |file, options| Ok(metaimage::rows(file, options.frame)?.source())
        ),
        data_files: built!("formats", metaimage::data_files),
        ..PLAIN
    },
    VolumeFormat {
        name: "VTK image data (XML)",
        extensions: &["vti"],
        keeps: ALL,
        chooses: &[Setting::Array],
        feature: Some("formats"),
        fuzzed_by: &["vti"],
        writers: writers!["vti": write::vti],
        begins: is_vtk_xml,
        read: built!("formats", |file, options, monitor| vti::read(
            file,
            options.array.as_deref(),
            monitor
        )),
        ..PLAIN
    },
    VolumeFormat {
        name: "VTK structured points",
        extensions: &["vtk"],
        keeps: Keeps { spacing: true, directions: true, ..SAMPLES },
        chooses: &[Setting::Array],
        feature: Some("formats"),
        fuzzed_by: &["vtk_legacy"],
        begins: is_vtk,
        read: built!("formats", |file, options, monitor| vtk::read(
            file,
            options.array.as_deref(),
            monitor
        )),
        ..PLAIN
    },
    VolumeFormat {
        name: "TIFF",
        extensions: &["tif", "tiff"],
        keeps: Keeps { spacing: true, unit: true, ..SAMPLES },
        chooses: &[Setting::Frame],
        feature: Some("formats"),
        fuzzed_by: &["tiff"],
        writers: writers!["tif": write::tiff, "tiff": write::tiff],
        begins: |start| TIFF.iter().any(|magic| start.starts_with(magic)),
        read: built!("formats", |file, options, monitor| tiff::read(file, options.frame, monitor)),
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
        parts: Some(|file, options| Ok(npy::rows(file, options.frame)?.source())),
        ..PLAIN
    },
    VolumeFormat {
        name: "NPZ",
        extensions: &["npz"],
        chooses: &[Setting::Array],
        feature: Some("formats"),
        fuzzed_by: &["npz"],
        begins: |start| start.starts_with(b"PK\x03\x04") || start.starts_with(b"PK\x05\x06"),
        read: built!("formats", |file, options, monitor| npz::read(
            file,
            options.array.as_deref(),
            monitor
        )),
        ..PLAIN
    },
    VolumeFormat {
        name: "folder of slices",
        feature: Some("formats"),
        fuzzed_by: &["slices"],
        folder_name: "folder of slices",
        is_folder: |_| Ok(true),
        read_folder: built!("formats", |path, _, _| slices::read(path)),
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

/// How TIFF and `BigTIFF` begin, of either byte order.
const TIFF: [&[u8]; 4] = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
