//! `FreeSurfer`'s volumes: MGH, and MGZ, which is MGH compressed with gzip.

use std::io::Read;
use std::path::Path;

use super::OpenFile;
use super::frames::FrameChoice;
use super::layout::{Encoding, Layout, frame};
use super::payload::{Length, Payload, payload_error, unreadable};
use super::uncompressed::Uncompressed;
use crate::error::format_error;
use crate::{
    Coordinates, Dims, Dtype, Endian, Frame, LengthUnit, Reason, Space, Volume, VolumeError,
};
use walpha_base::Monitor;

/// The number of bytes before the samples.
pub(crate) const HEADER: usize = 284;

/// Reads an MGH file or one of its frames: a header of 284 bytes, big-endian, then samples, x fastest. The settings of a scanner
/// may follow, and are ignored.
///
/// The frame is RAS, in mm; the header contains the position of the grid's centre. Without `goodRASFlag` the position is unknown.
pub(crate) fn read(
    file: &OpenFile,
    frame: Option<u64>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let (mut reader, length) = file.unpacked()?;
    let layout = layout(path, &mut reader, frame)?;
    layout.dims.bounded()?;
    let all = layout.bytes();
    // The data after the samples are not samples.
    let length = match length.minus(HEADER as u64) {
        Length::Exactly(bytes) => Length::Exactly(bytes.min(all)),
        bounded @ Length::AtMost(_) => bounded,
    };
    let Layout { dims, dtype, endian, frames, .. } = layout;
    let (reader, length) = frames.select(path, reader.take(all), length, layout.each())?;
    let samples = Payload { reader, length }
        .samples(path, dtype, endian, dims.samples() as u64, monitor)
        .map_err(payload_error(path, &dims, dtype))?;
    layout.volume(samples)
}

/// Locates the samples of an uncompressed volume, to be read part by part.
pub(crate) fn box_reader(file: &OpenFile, frame: Option<u64>) -> Result<Uncompressed, VolumeError> {
    let path = file.path();
    let layout = layout(path, &mut file.reader()?, frame)?;
    let (needed, found) = (layout.bytes(), file.length().saturating_sub(HEADER as u64));
    let Layout { dims, dtype, endian, frames, frame, .. } = layout;
    if found < needed {
        let claim = format!("a volume of {dims} samples of type {dtype}");
        return Err(format_error(path, Reason::Length { claim, needed, found, bound: "" }));
    }
    let offset = HEADER as u64 + frames.index * layout.each();
    Uncompressed::new(file, dims, frame, dtype, endian, offset)
}

/// Reads a header.
fn layout(path: &Path, reader: &mut dyn Read, asked: Option<u64>) -> Result<Layout, VolumeError> {
    let mut bytes = Vec::new();
    reader.take(HEADER as u64).read_to_end(&mut bytes).map_err(unreadable(path))?;
    let Ok(bytes) = <[u8; HEADER]>::try_from(bytes) else {
        let what = "ends inside its MGH header: it is truncated";
        return Err(format_error(path, Reason::truncated(what)));
    };
    let whole = |place: usize| i32::from_be_bytes(bytes[place..place + 4].try_into().expect("4"));
    let real = |place: usize| {
        f64::from(f32::from_be_bytes(bytes[place..place + 4].try_into().expect("4")))
    };
    let version = whole(0);
    if version != 1 {
        let what = format!("is not an MGH file: its version is {version}, and not 1");
        return Err(format_error(path, Reason::other(what)));
    }
    let sizes = [4, 8, 12, 16].map(whole);
    if sizes.iter().any(|&size| size < 1) {
        let what = format!("has axes of {sizes:?} samples");
        return Err(format_error(path, Reason::header(what)));
    }
    let [x, y, z, count] = sizes.map(|size| size as u64);
    let dtype = match whole(20) {
        0 => Dtype::U8,
        1 => Dtype::I32,
        3 => Dtype::F32,
        4 => Dtype::I16,
        10 => Dtype::U16,
        code => {
            let what = format!(
                "holds samples of type {code}: of MGH unsigned bytes, 16-bit and 32-bit integers and \
                 float are read"
            );
            return Err(format_error(path, Reason::unsupported(what, "convert it")));
        }
    };
    let dims = Dims::unbounded(x, y, z)?;
    let frames = FrameChoice::choose(path, &[count], asked)?;
    let vector = |place: usize| [0, 4, 8].map(|k| real(place + k));
    let placed = i16::from_be_bytes([bytes[28], bytes[29]]) != 0;
    let frame = if placed {
        let spacing = vector(30);
        let axes = [0, 1, 2].map(|k| vector(42 + 12 * k).map(|step| step * spacing[k]));
        let middle = [x, y, z].map(|n| n as f64 / 2.0);
        let centre = vector(78);
        let origin =
            [0, 1, 2].map(|r| centre[r] - (0..3).map(|k| axes[k][r] * middle[k]).sum::<f64>());
        frame(path, origin, axes, Coordinates { space: Space::Ras, unit: LengthUnit::Millimetre })?
    } else {
        Frame::VOXEL
    };
    let (endian, encoding) = (Endian::Big, Encoding::Raw);
    Ok(Layout { dims, dtype, endian, frame, encoding, frames })
}
