//! Volumes as files, by the name of each format. Samples are `f32`, little-endian.

#[cfg(feature = "formats")]
mod nifti;
mod plain;
#[cfg(feature = "formats")]
mod text_headers;
#[cfg(feature = "formats")]
mod tiff;
#[cfg(feature = "zarr")]
mod zarr;

#[cfg(feature = "formats")]
pub(super) use nifti::{nifti, nifti_gzip};
pub(super) use plain::{npy, raw};
#[cfg(feature = "formats")]
pub(super) use text_headers::{metaimage, nrrd, vti};
#[cfg(feature = "formats")]
pub(super) use tiff::tiff;
#[cfg(feature = "zarr")]
pub(super) use zarr::zarr;
