use std::fs::File;
use std::io::{Seek, SeekFrom};
use std::path::Path;

use ndarray::Array3;

use super::payload::{Length, Payload, PayloadError};
use super::{io_error, payload_error};
use crate::volume::{Dims, Dtype, Endian, Frame, Volume, VolumeError};

/// What a file of bare samples does not say of itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawLayout {
    /// Samples along x (fastest), y and z (slowest).
    pub dims: Dims,
    /// The type of each.
    pub dtype: Dtype,
    /// The order of their bytes.
    pub endian: Endian,
    /// Bytes before the first sample, a header to be skipped.
    pub offset: u64,
}

/// Reads a file that holds `offset` bytes and then exactly the samples of the layout.
pub(super) fn read(path: &Path, layout: &RawLayout) -> Result<Volume, VolumeError> {
    let RawLayout { dims, dtype, endian, offset } = *layout;
    let mut reader = File::open(path).map_err(io_error(path))?;
    let length = reader.metadata().map_err(io_error(path))?.len();
    reader.seek(SeekFrom::Start(offset.min(length))).map_err(io_error(path))?;
    let payload = Payload { reader, length: Length::Exactly(length.saturating_sub(offset)) };
    let samples =
        payload.samples(dtype, endian, dims.samples() as u64).map_err(|error| match error {
            PayloadError::Length { needed, .. } => VolumeError::Format {
                path: path.into(),
                what: wrong_length(layout, needed, length),
            },
            other => payload_error(path, &dims, dtype)(other),
        })?;
    let samples = Array3::from_shape_vec(dims.shape(), samples).expect("count was checked");
    Ok(Volume::of_file(samples, Frame::VOXEL)?.with_dtype(dtype))
}

fn wrong_length(layout: &RawLayout, needed: u64, length: u64) -> String {
    let RawLayout { dims, dtype, offset, .. } = *layout;
    let [x, y, z] = dims.xyz();
    let claim = if offset == 0 {
        format!("--dims {x},{y},{z} as {dtype} needs {needed} bytes")
    } else {
        let all = offset.saturating_add(needed);
        format!("--dims {x},{y},{z} as {dtype} after --offset {offset} needs {all} bytes")
    };
    let advice = if length == 0 {
        "it is empty".to_owned()
    } else if length > needed && offset == 0 {
        format!("is a header of {} bytes to be skipped with --offset?", length - needed)
    } else if offset > 0 {
        "check --dims, --dtype and --offset".to_owned()
    } else {
        "is it cut off, or are --dims or --dtype others?".to_owned()
    };
    format!("{claim}, the file has {length}: {advice}")
}
