//! The layout of samples according to the header of a file, and the reading of samples in this layout.

use std::io::{BufReader, Read};
use std::path::Path;

use bzip2::read::MultiBzDecoder;
use flate2::read::ZlibDecoder;
use ndarray::Array3;
use walpha_base::Monitor;
use walpha_base::shown::shown;

use super::frames::FrameChoice;
use super::gunzip::Gunzip;
use super::payload::{Length, Payload, payload_error};
use super::text;
use crate::error::format_error;
use crate::{Coordinates, Dims, Dtype, Endian, Frame, LengthUnit, Reason, Volume, VolumeError};

/// A volume as the header of a file describes it, with x fastest.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub dims: Dims,
    pub dtype: Dtype,
    pub endian: Endian,
    pub frame: Frame,
    pub encoding: Encoding,
    pub frames: FrameChoice,
}

/// The encoding of samples as bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Uncompressed.
    Raw,
    /// Numbers as text, separated by white space.
    Text,
    /// Compressed, with the header of gzip.
    Gzip,
    /// Compressed, with the header of zlib.
    Zlib,
    /// Compressed with bzip2.
    Bzip2,
}

impl Layout {
    /// The uncompressed size in bytes of all volumes of the file.
    pub(super) fn bytes(&self) -> u64 {
        self.each().saturating_mul(self.frames.count)
    }

    /// The size in bytes of one volume.
    pub(super) fn each(&self) -> u64 {
        self.dims.bytes(self.dtype.size())
    }

    /// Reads the samples, which must be all of the `bytes` bytes.
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
                self.decode(path, Gunzip::new(path, compressed), Length::of_gzip(bytes), monitor)
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
                let mut samples = text::numbers(path, compressed, bytes, self.dtype, all)
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
            .samples(path, self.dtype, self.endian, self.dims.samples() as u64, monitor)
            .map_err(payload_error(path, &self.dims, self.dtype))?;
        self.volume(samples)
    }

    /// The volume of as many samples as the header claims.
    pub(super) fn volume(self, samples: Vec<f32>) -> Result<Volume, VolumeError> {
        let samples =
            Array3::from_shape_vec(self.dims.shape(), samples).expect("count was checked");
        let volume = Volume::of_file(samples, self.frame)?.with_dtype(self.dtype);
        Ok(volume)
    }
}

/// The frame that a header gives, or an error that says which number is not valid.
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

/// Axes along those of the world, with these steps.
pub(super) fn diagonal(spacing: [f64; 3]) -> [[f64; 3]; 3] {
    let [x, y, z] = spacing;
    [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]
}

/// The unit that a file names. For an unknown unit there is a warning, and lengths have no unit.
pub(super) fn unit_named(path: &Path, name: &str) -> LengthUnit {
    let unit = LengthUnit::named(name);
    let said = name.trim().trim_matches('"');
    if unit == LengthUnit::Unstated && !matches!(said, "" | "?" | "???" | "unit" | "unknown") {
        tracing::warn!("{}: the unit {said:?} is not known, and passed over", shown(path));
    }
    unit
}

/// The first unit of the axes, and the factors that convert lengths along each axis to it. `None` stands for an axis without a
/// unit.
pub(super) fn one_unit(
    path: &Path,
    units: [Option<LengthUnit>; 3],
) -> Result<(LengthUnit, [f64; 3]), VolumeError> {
    let first = units.into_iter().flatten().next().unwrap_or_default();
    let mut factors = [1.0; 3];
    for (factor, unit) in factors.iter_mut().zip(units) {
        let unit = unit.unwrap_or(first);
        if unit == first {
            continue;
        }
        let [from, to] = [unit, first].map(|unit| Coordinates { unit, ..Coordinates::default() });
        let conversion = from.to(to);
        if conversion.to != to {
            let [first, other] = [first, unit].map(|unit| format!("{:?}", unit.symbol()));
            let what = format!(
                "has axes in the units {first} and {other}, which are not converted to each other"
            );
            return Err(format_error(path, Reason::header(what)));
        }
        *factor = conversion.length(1.0);
    }
    Ok((first, factors))
}
