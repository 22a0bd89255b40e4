//! Grids of samples: the files they come from, their place in the world, and the mapping of their values to gray levels.
//!
//! ```
//! use walpha_volume::{Gray, ReadOptions, open};
//!
//! // A sample by its name; a file or folder by its path.
//! let volume = open("sample:phantom@16", &ReadOptions::default())?;
//! assert_eq!(volume.dims().xyz(), [16, 16, 16]);
//! let (volume, range) = volume.into_gray(Gray::Automatic)?;
//! assert!(volume.value_range().1 <= 255.0 && range.low < range.high);
//! # Ok::<(), walpha_volume::VolumeError>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]
#![deny(unsafe_code)]
#![warn(unreachable_pub)]

#[doc(hidden)]
pub mod annotation;
mod crop;
mod dtype;
mod error;
mod formats;
mod gray;
mod grid;
mod hounsfield;
mod labels;
#[doc(hidden)]
pub mod near;
mod open;
mod read;
mod reason;
mod rounding;
mod sample;
mod source;
mod volume;
mod write;

pub use crop::{Region, downsample};
pub use dtype::{Dtype, Endian, Sample, UnknownName};
pub use error::VolumeError;
pub use formats::{
    FORMATS, Keeps, UnknownFormat, VolumeFormat, VolumeWriter, data_files, files_of, format_name,
    read, series,
};
pub use gray::{Gray, GrayRange};
pub use grid::{Dims, Frame};
pub use hounsfield::Hounsfield;
pub use labels::Labels;
#[cfg(feature = "zarr")]
pub use open::convert;
pub use open::open;
pub use read::{RawLayout, ReadOptions, Series};
pub use reason::Reason;
pub use sample::{SAMPLES, SKULL_SHA256, ct, phantom, sample, skull_sha256};
pub use source::{SampleStats, Source};
pub use volume::{Nan, Volume};
pub use walpha_base::advice::Advise;
pub use walpha_base::{Conversion, Coordinates, LengthUnit, Space};

// These are for walpha's readers of points and not part of the stable API.
#[doc(hidden)]
pub use error::io_error;
#[doc(hidden)]
pub use formats::{
    begins_as_volume, built, is_cif, is_gro, is_lammps_data, is_lammps_dump, is_npy, is_pdb,
    is_poscar, is_vtk, is_vtk_xml, other_kind, read_file,
};
#[doc(hidden)]
pub use grid::{any_size, inverse};
#[doc(hidden)]
pub use open::OpenVolume;
#[doc(hidden)]
pub use read::{Element, Gunzip, NpyFile, OpenFile, npy_element};
#[doc(hidden)]
pub use read::{Lines, VtkPoints, VtkXml};

/// The example in the README runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
