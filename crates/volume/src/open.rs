//! Opening what a user names: a sample, or else a file or folder.

use std::path::Path;

use walpha_base::Monitor;
use walpha_base::advice::Setting;

use crate::formats;
use crate::sample::PhantomBoxes;
use crate::{ReadOptions, Reason, Source, Volume, VolumeError, read_monitored, sample};

/// Opens what a user names: a sample, or else a file.
///
/// # Errors
/// Those of [`sample`] and [`read()`](crate::read()).
pub fn open(input: impl AsRef<Path>, options: &ReadOptions) -> Result<Volume, VolumeError> {
    open_monitored(input, options, &Monitor::noop())
}

/// The same, which says how far it is and can be cancelled.
///
/// # Errors
/// Those of [`open`], and [`VolumeError::Cancelled`].
pub fn open_monitored(
    input: impl AsRef<Path>,
    options: &ReadOptions,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let input = input.as_ref();
    match input.to_str() {
        Some(name) if name.starts_with("sample:") => options.part(sample(name)?),
        _ => read_monitored(input, options, monitor),
    }
}

impl Source {
    /// Opens what a user names, a sample or a file: uncompressed NRRD, `MetaImage`, `NIfTI`, NPY and raw samples,
    /// and Zarr (feature `zarr`). Of the options, `nan` is left to whoever reads.
    ///
    /// # Errors
    /// As [`read()`](crate::read()), and [`VolumeError::Format`] for what cannot be read in parts.
    pub fn open(input: impl AsRef<Path>, options: &ReadOptions) -> Result<Self, VolumeError> {
        let path = input.as_ref();
        let name = path.to_str().unwrap_or_default();
        if options.downsample.is_some() {
            let what = "cannot be made coarser while it is read in parts";
            let reason = Reason::needless(Setting::Downsample, what);
            return Err(VolumeError::Format { path: path.into(), reason });
        }
        let source = match name.strip_prefix("sample:phantom@").map(str::parse) {
            Some(Ok(size)) => PhantomBoxes::source(size)?,
            _ if name.starts_with("sample:") => {
                Self::of_volume(open(path, &ReadOptions::default())?)
            }
            _ => formats::source(path, options)?,
        };
        match &options.region {
            Some(region) => source.part(region),
            None => Ok(source),
        }
    }
}

/// Writes a volume as Zarr (feature `zarr`), part by part: OME-Zarr 0.5 with one level, in chunks of 64³
/// samples, or an array alone where nothing is known of the grid. Bytes and 16-bit integers keep their type,
/// others become `f32`; spacing, origin and unit are kept, directions are not.
///
/// # Errors
/// `folder` is there already or cannot be made; the volume cannot be read. Nothing is left behind then.
#[cfg(feature = "zarr")]
pub fn convert(source: &Source, folder: impl AsRef<Path>) -> Result<(), VolumeError> {
    convert_monitored(source, folder, &Monitor::noop())
}

/// The same, which says how far it is and can be cancelled.
///
/// # Errors
/// Those of [`convert`], and [`VolumeError::Cancelled`].
#[cfg(feature = "zarr")]
pub fn convert_monitored(
    source: &Source,
    folder: impl AsRef<Path>,
    monitor: &Monitor,
) -> Result<(), VolumeError> {
    crate::write::zarr(source, folder.as_ref(), monitor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_are_samples_or_files() {
        let volume = open("sample:phantom@5", &ReadOptions::default()).unwrap();
        assert_eq!(volume.dims().xyz(), [5, 5, 5]);
        let error = open("no/such.inr", &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("no/such.inr"), "{error}");
        assert!(error.advice().unwrap().to_string().contains("sample:phantom"));
    }
}
