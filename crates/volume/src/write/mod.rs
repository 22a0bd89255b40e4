//! Volumes as files, by the name of each format. Samples are `f32`, little-endian.

#[cfg(feature = "formats")]
mod metaimage;
#[cfg(feature = "formats")]
mod nifti;
mod npy;
#[cfg(feature = "formats")]
mod nrrd;
mod raw;
#[cfg(feature = "formats")]
mod tiff;
#[cfg(feature = "formats")]
mod vti;
#[cfg(feature = "zarr")]
mod zarr;

#[cfg(feature = "formats")]
pub(super) use metaimage::metaimage;
#[cfg(feature = "formats")]
pub(super) use nifti::{nifti, nifti_gzip};
pub(super) use npy::npy;
#[cfg(feature = "formats")]
pub(super) use nrrd::nrrd;
pub(super) use raw::raw;
#[cfg(feature = "formats")]
pub(super) use tiff::tiff;
#[cfg(feature = "formats")]
pub(super) use vti::vti;
#[cfg(feature = "zarr")]
pub(super) use zarr::zarr;
