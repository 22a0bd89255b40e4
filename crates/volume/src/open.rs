//! Opens what a user names: a sample, or else a file or folder.

use std::path::{Path, PathBuf};

use walpha_base::advice::Setting;

use crate::formats;
use crate::read::OpenFile;
use crate::sample::PhantomBoxes;
use crate::{ReadOptions, Reason, Source, Volume, VolumeError, read, sample};

/// Opens what a user names: a sample, or else a file or folder.
///
/// # Errors
/// See [`sample`] and [`read()`](crate::read()).
pub fn open(input: impl AsRef<Path>, options: &ReadOptions) -> Result<Volume, VolumeError> {
    let input = input.as_ref();
    match sample_name(input) {
        Some(name) => {
            let volume = sample(name)?;
            formats::accept_sample(input, options)?;
            options.part(volume)
        }
        None => read(input, options),
    }
}

/// The name of a sample, if the input names one.
fn sample_name(input: &Path) -> Option<&str> {
    input.to_str().filter(|name| name.starts_with("sample:"))
}

/// An input that is asked for several things. A file is opened only once, and all answers come from the open file; samples and
/// folders are opened by their names.
#[derive(Debug)]
pub enum OpenVolume {
    /// A sample or a folder.
    Named(PathBuf),
    /// A file.
    File(OpenFile),
}

impl OpenVolume {
    /// Opens a file, or keeps the name of a sample or folder.
    ///
    /// # Errors
    /// [`VolumeError::Io`] if the file cannot be opened.
    pub fn open(input: &Path) -> Result<Self, VolumeError> {
        Ok(if sample_name(input).is_some() || input.is_dir() {
            Self::Named(input.into())
        } else {
            Self::File(OpenFile::open(input)?)
        })
    }

    /// Reads the volume.
    ///
    /// # Errors
    /// See [`open`].
    pub fn read(&self, options: &ReadOptions) -> Result<Volume, VolumeError> {
        match self {
            Self::Named(input) => open(input, options),
            Self::File(file) => formats::read_file(file, options),
        }
    }

    /// Prepares to read the volume part by part.
    ///
    /// # Errors
    /// See [`Source::open`].
    pub fn source(&self, options: &ReadOptions) -> Result<Source, VolumeError> {
        match self {
            Self::Named(input) => Source::open(input, options),
            Self::File(file) => {
                Source::of_part(file.path(), options, || formats::source_of(file, options))
            }
        }
    }

    /// The name of its format, such as `NRRD` or `NIfTI, gzip`.
    ///
    /// # Errors
    /// Its format is not known.
    pub fn format_name(&self, options: &ReadOptions) -> Result<String, VolumeError> {
        match self {
            Self::Named(input) if sample_name(input).is_some() => Ok("sample".into()),
            Self::Named(input) => formats::format_name(input, options),
            Self::File(file) => formats::format_name_of(file, options),
        }
    }

    /// The files that hold its samples, if its header is a file of its own.
    ///
    /// # Errors
    /// The header cannot be read.
    pub fn data_files(&self, options: &ReadOptions) -> Result<Vec<PathBuf>, VolumeError> {
        match self {
            Self::Named(_) => Ok(Vec::new()),
            Self::File(file) => formats::data_files_of(file, options),
        }
    }
}

impl Source {
    /// Opens what a user names, a sample or a file: uncompressed NRRD, `MetaImage`, `NIfTI`, NPY and raw samples, and Zarr
    /// (feature `zarr`). The option `nan` is ignored: the caller handles NaN.
    ///
    /// # Errors
    /// See [`read()`](crate::read()); and [`VolumeError::Format`] for a format that cannot be read in parts.
    pub fn open(input: impl AsRef<Path>, options: &ReadOptions) -> Result<Self, VolumeError> {
        let path = input.as_ref();
        Self::of_part(path, options, || {
            if sample_name(path).is_some() {
                formats::accept_sample(path, options)?;
            }
            let name = path.to_str().unwrap_or_default();
            match name.strip_prefix("sample:phantom@").map(str::parse) {
                Some(Ok(size)) => PhantomBoxes::source(size),
                _ if sample_name(path).is_some() => {
                    Ok(Self::of_volume(open(path, &ReadOptions::default())?))
                }
                _ => formats::source(path, options),
            }
        })
    }

    /// The requested part of the source that `open` opens.
    fn of_part(
        path: &Path,
        options: &ReadOptions,
        open: impl FnOnce() -> Result<Self, VolumeError>,
    ) -> Result<Self, VolumeError> {
        if options.downsample.is_some() {
            let what = "cannot be downsampled while it is read in parts";
            let reason = Reason::needless(Setting::Downsample, what);
            return Err(VolumeError::Format { path: path.into(), reason });
        }
        let source = open()?;
        match &options.region {
            Some(region) => source.part(region),
            None => Ok(source),
        }
    }
}

/// Writes a volume as Zarr (feature `zarr`), part by part: as OME-Zarr 0.5 with one level, in chunks of 64³ samples, or as an
/// array alone if nothing is known about the grid. Bytes and 16-bit integers keep their type, others become `f32`. Spacing,
/// origin and unit are kept, directions are not.
///
/// # Errors
/// `folder` exists already or cannot be created, or the volume cannot be read. Nothing is left behind then.
#[cfg(feature = "zarr")]
pub fn convert(source: &Source, folder: impl AsRef<Path>) -> Result<(), VolumeError> {
    let monitor = &*walpha_base::Monitor::current();
    crate::write::zarr(source, folder.as_ref(), monitor)
}

#[cfg(test)]
mod tests {
    use walpha_base::advice::Advise;

    use super::*;

    #[test]
    fn inputs_are_samples_or_files() {
        let volume = open("sample:phantom@5", &ReadOptions::default()).unwrap();
        assert_eq!(volume.dims().xyz(), [5, 5, 5]);
        let error = open("no/such.inr", &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("no/such.inr"), "{error}");
        assert!(error.advice().unwrap().to_string().contains("sample:phantom"));
    }

    /// Settings of files have no use for samples, and are not passed over.
    #[test]
    fn samples_refuse_the_settings_of_files() {
        let plain = ReadOptions::default;
        for (options, words) in [
            (plain().level(1), "is not a pyramid"),
            (plain().frame(1), "with a single volume"),
            (plain().skip_damaged(true), "is not a DICOM series"),
            (plain().format("nrrd".to_owned()), "is a sample, and not a file"),
        ] {
            for name in ["sample:phantom@5", "sample:ct"] {
                let errors =
                    [open(name, &options).unwrap_err(), Source::open(name, &options).unwrap_err()];
                for error in errors {
                    assert!(error.to_string().contains(words), "{error}");
                }
            }
        }
    }
}
