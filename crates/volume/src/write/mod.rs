//! Writers of volumes, named after their formats. Samples are `f32`, little-endian.

mod nifti;
mod plain;
mod text_headers;
mod tiff;
#[cfg(feature = "zarr")]
mod zarr;

pub(super) use nifti::{nifti, nifti_gzip};
pub(super) use plain::{npy, raw};
pub(super) use text_headers::{metaimage, nrrd, vti};
pub(super) use tiff::tiff;
#[cfg(feature = "zarr")]
pub(super) use zarr::zarr;
