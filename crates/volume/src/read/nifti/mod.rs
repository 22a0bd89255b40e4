//! NIfTI-1 and NIfTI-2.

mod frame;
mod header;

use std::io::Read;
use std::path::{Path, PathBuf};

use super::described::Described;
use super::detached::naming;
use super::payload::{Length, Payload};
use super::uncompressed::Uncompressed;
use super::{OpenFile, format_error, io_error, payload_error};
use crate::formats::nifti_version;
use crate::{Dtype, Reason, Volume, VolumeError};
use walpha_base::Monitor;

use header::Header;

/// Reads NIfTI-1 and NIfTI-2 (nifti.nimh.nih.gov): `.nii`, `.nii.gz`, or a pair `.hdr` and `.img`.
///
/// `scl_slope` and `scl_inter` are applied. The frame is that of `sform`, else of `qform`, else of
/// `pixdim` alone, which says nothing of the space; the other two are RAS. Axes beyond
/// the third count volumes, of which `frame` is read; colours and complex numbers are refused.
pub(crate) fn read(
    file: &OpenFile,
    frame: Option<u64>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let (mut reader, length) = file.unpacked()?;
    let header = Header::read(path, &mut reader)?;
    let described = header.described(path, frame)?;
    let (slope, inter) = header.scaling();
    if header.is_pair(path)? {
        let image = path.with_extension("img");
        let data = OpenFile::open(&image)?;
        let offset = header.vox_offset().clamp(0.0, data.length() as f64) as u64;
        let left = Length::Exactly(data.length() - offset);
        return samples(path, described, slope, inter, data.reader_at(offset)?, left, monitor)
            .map_err(naming(path, &[image]));
    }
    let offset = header.offset(path)?;
    let skip = offset - header.bytes.len() as u64;
    let skipped = std::io::copy(&mut (&mut reader).take(skip), &mut std::io::sink());
    if skipped.map_err(io_error(path))? < skip {
        return Err(format_error(
            path,
            Reason::truncated(format!("ends before its samples at byte {offset}")),
        ));
    }
    samples(path, described, slope, inter, reader, length.minus(offset), monitor)
}

/// Where the samples of a volume lie, to be read part by part.
pub(crate) fn rows(file: &OpenFile, frame: Option<u64>) -> Result<Uncompressed, VolumeError> {
    let path = file.path();
    let header = Header::read(path, &mut file.reader()?)?;
    let described = header.described(path, frame)?;
    let scaling = header.scaling();
    let rows = if header.is_pair(path)? {
        let offset = header.vox_offset().max(0.0) as u64;
        Uncompressed::beside(path, described, &[path.with_extension("img")], Some(offset))?
    } else {
        Uncompressed::behind(file, described, header.offset(path)?, Some(0))?
    };
    Ok(rows.scaled(scaling))
}

/// The file that holds the samples, where the header has one of its own.
pub(crate) fn data_files(file: &OpenFile) -> Result<Vec<PathBuf>, VolumeError> {
    let path = file.path();
    let Some((version, endian)) = nifti_version(file.start()) else { return Ok(Vec::new()) };
    let header = Header { bytes: file.start().to_vec(), version, endian };
    Ok(if header.is_pair(path)? { vec![path.with_extension("img")] } else { Vec::new() })
}

/// Reads samples and scales them, in doubles where `f32` does not hold the numbers of the file.
fn samples(
    path: &Path,
    described: Described,
    slope: f64,
    inter: f64,
    reader: impl Read,
    length: Length,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let Described { dims, dtype, endian, frames, .. } = described;
    dims.bounded()?;
    let each = (dims.samples() * dtype.size()) as u64;
    let (reader, length) = frames.one(path, reader, length, each)?;
    let payload = Payload { reader, length };
    let fail = payload_error(path, &dims, dtype);
    let count = dims.samples() as u64;
    if (slope, inter) == (1.0, 0.0) {
        let samples = payload.samples(dtype, endian, count, monitor).map_err(fail)?;
        return described.volume(samples);
    }
    let scaled: Vec<f32> = if dtype.size() < 4 || dtype == Dtype::F32 {
        let mut samples: Vec<f32> = payload.samples(dtype, endian, count, monitor).map_err(fail)?;
        samples.iter_mut().for_each(|v| *v = (f64::from(*v) * slope + inter) as f32);
        samples
    } else {
        let samples: Vec<f64> = payload.samples(dtype, endian, count, monitor).map_err(fail)?;
        samples.iter().map(|v| (v * slope + inter) as f32).collect()
    };
    // Scaled bytes are not gray levels.
    Ok(described.volume(scaled)?.with_dtype(Dtype::F32))
}
