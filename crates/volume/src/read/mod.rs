//! The readers of each format.

#[cfg(feature = "formats")]
mod detached;
#[cfg(feature = "dicom")]
pub(super) mod dicom;
mod frames;
mod gunzip;
pub(super) mod inr;
#[cfg(feature = "formats")]
mod layout;
#[cfg(feature = "formats")]
pub(super) mod metaimage;
#[cfg(feature = "formats")]
pub(super) mod mgh;
#[cfg(feature = "formats")]
pub(super) mod nifti;
pub(super) mod npy;
#[cfg(feature = "formats")]
pub(super) mod npz;
#[cfg(feature = "formats")]
pub(super) mod nrrd;
mod open_file;
mod options;
mod payload;
pub(super) mod raw;
#[cfg(feature = "formats")]
mod scans;
pub(super) mod series;
#[cfg(feature = "formats")]
pub(super) mod slices;
#[cfg(feature = "formats")]
mod text;
#[cfg(feature = "formats")]
pub(super) mod tiff;
mod uncompressed;
#[cfg(feature = "formats")]
pub(super) mod vtk;
#[cfg(feature = "zarr")]
pub(super) mod zarr;

#[cfg(feature = "formats")]
pub(crate) use detached::naming;
pub use gunzip::Gunzip;
pub use npy::{NpyFile, element as npy_element};
pub use open_file::OpenFile;
pub use options::ReadOptions;
pub use payload::Element;
pub(crate) use payload::Length;
pub use raw::RawLayout;
pub use series::Series;
#[cfg(feature = "formats")]
pub use text::Lines;
#[cfg(feature = "formats")]
pub use vtk::{VtkPoints, VtkXml};
