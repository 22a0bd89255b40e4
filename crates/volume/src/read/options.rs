//! Options of reading.

use std::num::NonZeroUsize;

use serde::{Deserialize, Serialize};
use walpha_base::setters;

use super::raw::RawLayout;
use crate::{Nan, Region, Volume, VolumeError, downsample};

/// How to read a file: what its name and content leave open.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ReadOptions {
    /// Reads the file as bare samples in this layout, whatever it looks like.
    pub raw: Option<RawLayout>,
    /// The extension of the format that the file is of, whatever its own; content still says more.
    pub format: Option<String>,
    /// The level of a pyramid to read (OME-Zarr), 0 being the finest. Files without levels refuse it.
    pub level: Option<u32>,
    /// The array to read, by its name, of a file that may hold several (VTK, NPZ).
    pub array: Option<String>,
    /// The volume to read of a file of several (a fourth axis), from 0.
    pub frame: Option<u64>,
    /// The series to read of a folder of several (DICOM): its number, from 1, or the end of its UID, if
    /// that is not a number.
    pub series: Option<String>,
    /// Goes on without damaged slices of a series (DICOM), which a warning names; without it they are refused.
    pub skip_damaged: bool,
    /// Refuses slices at several distances (DICOM); without it they are resampled linearly to the finest distance.
    #[serde(default)]
    pub no_resample: bool,
    /// How to treat samples that are NaN or infinite; by default they are an error. What a file states as padding (DICOM) is
    /// masked, unless a value replaces it here.
    pub nan: Option<Nan>,
    /// The region to crop to.
    pub region: Option<Region>,
    /// How many samples along each axis become one; `None` leaves them as they are.
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

    /// The part of a volume that is asked for.
    ///
    /// # Errors
    /// [`VolumeError`]: what cannot be read, and why.
    pub fn part(&self, volume: Volume) -> Result<Volume, VolumeError> {
        let volume = match &self.region {
            Some(region) => region.of(&volume)?,
            None => volume,
        };
        Ok(match self.downsample {
            Some(n) => downsample(volume, n),
            None => volume,
        })
    }
}
