use ndarray::Array3;
use serde::{Deserialize, Serialize};
use walpha_base::Monitor;
use walpha_base::advice::{Setting, advice};
use walpha_base::setters;

use super::OpenFile;
use super::payload::payload_error;
use super::payload::{Length, Payload, PayloadError};
use super::uncompressed::Uncompressed;
use crate::{Dims, Dtype, Endian, Frame, Reason, Volume, VolumeError, any_size};

/// The layout of a file of bare samples, which does not state it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RawLayout {
    /// The number of samples along x (fastest), y and z (slowest).
    #[serde(deserialize_with = "any_size")]
    pub dims: Dims,
    /// The type of each sample.
    pub dtype: Dtype,
    /// The byte order of samples.
    pub endian: Endian,
    /// The number of bytes before the first sample: a header to be skipped.
    pub offset: u64,
}

impl RawLayout {
    /// The layout of samples from the first byte on, little-endian.
    pub fn new(dims: Dims, dtype: Dtype) -> Self {
        Self { dims, dtype, endian: Endian::Little, offset: 0 }
    }

    setters! { endian: Endian, offset: u64 }
}

/// Reads a file that contains `offset` bytes and then exactly the samples of the layout.
pub(crate) fn read(
    file: &OpenFile,
    layout: &RawLayout,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let (path, length) = (file.path(), file.length());
    let RawLayout { dims, dtype, endian, offset } = *layout;
    dims.bounded()?;
    let reader = file.reader_at(offset.min(length))?;
    let payload = Payload { reader, length: Length::Exactly(length.saturating_sub(offset)) };
    let samples =
        payload.samples(path, dtype, endian, dims.samples() as u64, monitor).map_err(|error| {
            match error {
                PayloadError::Length { needed, .. } => VolumeError::Format {
                    path: path.into(),
                    reason: wrong_length(layout, needed, length),
                },
                other => payload_error(path, &dims, dtype)(other),
            }
        })?;
    let samples = Array3::from_shape_vec(dims.shape(), samples).expect("count was checked");
    Ok(Volume::of_file(samples, Frame::VOXEL)?.with_dtype(dtype))
}

/// Locates the samples of a volume, to be read part by part.
pub(crate) fn box_reader(file: &OpenFile, layout: &RawLayout) -> Result<Uncompressed, VolumeError> {
    let (path, length) = (file.path(), file.length());
    let RawLayout { dims, dtype, endian, offset } = *layout;
    let needed = dims.bytes(dtype.size());
    if length != offset.saturating_add(needed) {
        let reason = wrong_length(layout, needed, length);
        return Err(VolumeError::Format { path: path.into(), reason });
    }
    Uncompressed::new(file, dims, Frame::VOXEL, dtype, endian, offset)
}

fn wrong_length(layout: &RawLayout, needed: u64, length: u64) -> Reason {
    let RawLayout { dims, dtype, offset, .. } = *layout;
    let behind =
        if offset == 0 { String::new() } else { format!(", {offset} of them before the samples") };
    let all = offset.saturating_add(needed);
    let what = format!(
        "a volume of {dims} samples of type {dtype} needs {all} bytes{behind}, the file has \
             {length}"
    );
    let (setting, advice) = if length == 0 {
        (Setting::Dims, advice!["it is empty, write it again"])
    } else if length > needed && offset == 0 {
        let header = format!("is a header of {} bytes to be skipped with ", length - needed);
        (Setting::Offset, advice![header, Setting::Offset, "?"])
    } else if offset > 0 {
        let all = [Setting::Dims, Setting::Dtype, Setting::Offset];
        (all[0], advice!["check ", all[0], ", ", all[1], " and ", all[2]])
    } else {
        let (dims, dtype) = (Setting::Dims, Setting::Dtype);
        (dims, advice!["is it cut off, or are ", dims, " or ", dtype, " others?"])
    };
    Reason::choice(setting, what, advice)
}
