//! Options for reading.

use std::num::NonZeroUsize;

use serde::{Deserialize, Serialize};
use walpha_base::setters;

use super::raw::RawLayout;
use crate::{Nan, Region, Volume, VolumeError, downsample};

/// How to read a file, as far as its name and content do not determine it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ReadOptions {
    /// Reads the file as bare samples in this layout, whatever its content looks like.
    pub raw: Option<RawLayout>,
    /// The extension of the file's format, to be used instead of its own. The content takes precedence.
    pub format: Option<String>,
    /// The level of a pyramid to read (OME-Zarr), 0 being the finest. Files without levels refuse it.
    pub level: Option<u32>,
    /// The name of the array to read from a file that may contain several (VTK, NPZ).
    pub array: Option<String>,
    /// The number of the volume to read from a file of several (a fourth axis), from 0.
    pub frame: Option<u64>,
    /// The series to read from a folder of several (DICOM): its number, from 1, or the end of its UID, if that is not a number.
    pub series: Option<String>,
    /// Leaves out damaged slices of a series (DICOM), with a warning that names them; otherwise they are refused.
    pub skip_damaged: bool,
    /// Refuses slices at different distances (DICOM); otherwise they are resampled linearly to the smallest distance.
    #[serde(default)]
    pub no_resample: bool,
    /// How to treat samples that are NaN or infinite; by default they are an error. Samples that a file states as padding (DICOM)
    /// are masked, unless a value here replaces them.
    pub nan: Option<Nan>,
    /// The region to crop to.
    pub region: Option<Region>,
    /// The number of samples along each axis that become one; `None` leaves them unchanged.
    pub downsample: Option<NonZeroUsize>,
}

impl ReadOptions {
    setters! {
        raw: Option<RawLayout>,
        format: Option<String>,
        level: Option<u32>,
        array: Option<String>,
        frame: Option<u64>,
        series: Option<String>,
        skip_damaged: bool,
        no_resample: bool,
        nan: Option<Nan>,
        region: Option<Region>,
        downsample: Option<NonZeroUsize>,
    }

    /// The requested part of a volume.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn part(&self, volume: Volume) -> Result<Volume, VolumeError> {
        Ok(self.coarse(self.cropped(volume)?))
    }

    /// The requested region of a volume.
    pub(crate) fn cropped(&self, volume: Volume) -> Result<Volume, VolumeError> {
        match &self.region {
            Some(region) => region.of(&volume),
            None => Ok(volume),
        }
    }

    /// A volume, coarser if that is requested.
    pub(crate) fn coarse(&self, volume: Volume) -> Volume {
        match self.downsample {
            Some(n) => downsample(volume, n),
            None => volume,
        }
    }
}
