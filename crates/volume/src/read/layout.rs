//! What the header of a file says of its samples, and reading them as it says.

use std::io::{BufReader, Read};
use std::path::Path;

use bzip2::read::MultiBzDecoder;
use flate2::read::{MultiGzDecoder, ZlibDecoder};
use ndarray::Array3;
use walpha_base::Monitor;

use super::frames::FrameChoice;
use super::payload::{Length, Payload, payload_error};
use super::text;
use crate::error::format_error;
use crate::{Coordinates, Dims, Dtype, Endian, Frame, Reason, Volume, VolumeError};

/// A volume as the header of a file describes it, x fastest.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub dims: Dims,
    pub dtype: Dtype,
    pub endian: Endian,
    pub frame: Frame,
    pub encoding: Encoding,
    pub frames: FrameChoice,
}

/// How samples become bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// As they are.
    Raw,
    /// As numbers with white space between them.
    Text,
    /// Compressed, with the header of gzip.
    Gzip,
    /// Compressed, with the header of zlib.
    Zlib,
    /// Compressed with bzip2.
    Bzip2,
}

impl Layout {
    /// Bytes of all volumes of the file where they are not compressed.
    pub(super) fn bytes(&self) -> u64 {
        self.each().saturating_mul(self.frames.count)
    }

    /// Bytes of one volume.
    pub(super) fn each(&self) -> u64 {
        self.dims.bytes(self.dtype.size())
    }

    /// Reads the samples, which are all there is in `bytes` bytes.
    pub(super) fn read(
        self,
        path: &Path,
        source: impl Read,
        bytes: u64,
        monitor: &Monitor,
    ) -> Result<Volume, VolumeError> {
        self.dims.bounded()?;
        let compressed = BufReader::new(source);
        match self.encoding {
            Encoding::Raw => self.decode(path, compressed, Length::Exactly(bytes), monitor),
            Encoding::Gzip => {
                self.decode(path, MultiGzDecoder::new(compressed), Length::of_gzip(bytes), monitor)
            }
            Encoding::Zlib => {
                self.decode(path, ZlibDecoder::new(compressed), Length::of_gzip(bytes), monitor)
            }
            Encoding::Bzip2 => {
                self.decode(path, MultiBzDecoder::new(compressed), Length::of_bzip2(bytes), monitor)
            }
            Encoding::Text => {
                let count = self.dims.samples();
                let all = (count as u64).saturating_mul(self.frames.count);
                let mut samples = text::numbers(compressed, bytes, self.dtype, all)
                    .map_err(|reason| format_error(path, reason))?;
                samples.drain(..count * self.frames.index as usize);
                samples.truncate(count);
                self.volume(samples)
            }
        }
    }

    fn decode(
        self,
        path: &Path,
        reader: impl Read,
        length: Length,
        monitor: &Monitor,
    ) -> Result<Volume, VolumeError> {
        let (reader, length) = self.frames.select(path, reader, length, self.each())?;
        let samples = Payload { reader, length }
            .samples(self.dtype, self.endian, self.dims.samples() as u64, monitor)
            .map_err(payload_error(path, &self.dims, self.dtype))?;
        self.volume(samples)
    }

    /// The volume of as many samples as were claimed.
    pub(super) fn volume(self, samples: Vec<f32>) -> Result<Volume, VolumeError> {
        let samples =
            Array3::from_shape_vec(self.dims.shape(), samples).expect("count was checked");
        let volume = Volume::of_file(samples, self.frame)?.with_dtype(self.dtype);
        Ok(volume)
    }
}

/// The frame a header gives, or the error that says which number is none.
pub(super) fn frame(
    path: &Path,
    origin: [f64; 3],
    axes: [[f64; 3]; 3],
    coordinates: Coordinates,
) -> Result<Frame, VolumeError> {
    let frame = Frame::from_axes(origin, axes).map(|frame| frame.with_coordinates(coordinates));
    frame.ok_or_else(|| {
        let reason = Reason::header(format!(
            "places its grid at {origin:?} with steps {axes:?} along its axes: spacing must not \
             be 0, and all numbers finite"
        ));
        format_error(path, reason)
    })
}

/// Steps along the world's axes.
pub(super) fn diagonal(spacing: [f64; 3]) -> [[f64; 3]; 3] {
    let [x, y, z] = spacing;
    [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]
}
