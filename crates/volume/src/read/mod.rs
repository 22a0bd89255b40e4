//! The readers of each format.

mod detached;
#[cfg(feature = "dicom")]
pub(super) mod dicom;
mod frames;
mod gunzip;
pub(super) mod inr;
mod layout;
pub(super) mod metaimage;
pub(super) mod mgh;
pub(super) mod nifti;
pub(super) mod npy;
pub(super) mod npz;
pub(super) mod nrrd;
mod open_file;
mod options;
mod payload;
pub(super) mod raw;
mod scans;
pub(super) mod series;
pub(super) mod slices;
mod text;
pub(super) mod tiff;
mod uncompressed;
pub(super) mod vtk;
#[cfg(feature = "zarr")]
pub(super) mod zarr;

pub(crate) use detached::naming;
pub use gunzip::Gunzip;
pub use npy::{NpyFile, element as npy_element};
pub use open_file::OpenFile;
pub use options::ReadOptions;
pub use payload::Element;
pub(crate) use payload::Length;
pub use raw::RawLayout;
pub use series::Series;
pub use text::Lines;
pub use vtk::{VtkPoints, VtkXml};
