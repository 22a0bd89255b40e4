//! The bytes of a header, and what they say of samples.

use std::io::Read;
use std::path::Path;

use super::super::described::{Described, Encoding};
use super::super::frames::Frames;
use super::super::{format_error, io_error};
use crate::formats::{NIFTI_HEADERS, nifti_version};
use crate::{Dims, Dtype, Endian, Reason, VolumeError};

/// The bytes of a header; places are those of version 1 and version 2.
pub(super) struct Header {
    pub bytes: Vec<u8>,
    pub version: u8,
    pub endian: Endian,
}

impl Header {
    /// Reads a header, and nothing behind it.
    pub(super) fn read(path: &Path, reader: &mut dyn Read) -> Result<Self, VolumeError> {
        let mut bytes = Vec::new();
        let mut fill = |size: usize, bytes: &mut Vec<u8>| -> Result<(), VolumeError> {
            let left = (size - bytes.len()) as u64;
            reader.take(left).read_to_end(bytes).map_err(io_error(path))?;
            if bytes.len() < size {
                return Err(format_error(
                    path,
                    Reason::truncated("ends inside its NIfTI header: it is truncated"),
                ));
            }
            Ok(())
        };
        fill(NIFTI_HEADERS[0], &mut bytes)?;
        let Some((version, endian)) = nifti_version(&bytes) else {
            let reason = Reason::other(
                "is no NIfTI file: it begins with neither 348 nor 540, the length of its header",
            );
            return Err(format_error(path, reason));
        };
        if version == 2 {
            fill(NIFTI_HEADERS[1], &mut bytes)?;
        }
        Ok(Self { bytes, version, endian })
    }

    /// As many bytes as asked for, least significant first.
    pub(super) fn at<const N: usize>(&self, one: usize, two: usize) -> [u8; N] {
        let place = if self.version == 1 { one } else { two };
        let mut bytes: [u8; N] = self.bytes[place..place + N].try_into().expect("inside");
        if self.endian == Endian::Big {
            bytes.reverse();
        }
        bytes
    }

    fn short(&self, one: usize, two: usize) -> i16 {
        i16::from_le_bytes(self.at(one, two))
    }

    /// A code: 16 bits in version 1, 32 in version 2.
    pub(super) fn code(&self, one: usize, two: usize) -> i32 {
        match self.version {
            1 => i32::from(self.short(one, two)),
            _ => i32::from_le_bytes(self.at(one, two)),
        }
    }

    /// A real number: `f32` in version 1, `f64` in version 2. `i` counts numbers from the place.
    pub(super) fn real(&self, one: usize, two: usize, i: usize) -> f64 {
        match self.version {
            1 => f32::from_le_bytes(self.at(one + 4 * i, 0)).into(),
            _ => f64::from_le_bytes(self.at(0, two + 8 * i)),
        }
    }

    fn dim(&self, axis: usize) -> i64 {
        match self.version {
            1 => self.short(40 + 2 * axis, 0).into(),
            _ => i64::from_le_bytes(self.at(0, 16 + 8 * axis)),
        }
    }

    /// Whether the samples are in a separate file.
    pub(super) fn is_pair(&self, path: &Path) -> Result<bool, VolumeError> {
        let place = if self.version == 1 { 344 } else { 4 };
        match &self.bytes[place..place + 4] {
            b"n+1\0" | b"n+2\0" => Ok(false),
            b"ni1\0" | b"ni2\0" => Ok(true),
            [0, ..] if self.version == 1 => Err(format_error(
                path,
                Reason::unsupported(
                    "is an Analyze 7.5 header, which says nothing of orientation and is not read",
                    "convert it to NIfTI",
                ),
            )),
            magic => Err(format_error(
                path,
                Reason::other(format!(
                    "is not a NIfTI file: its magic is {:?}, and not n+1",
                    String::from_utf8_lossy(magic)
                )),
            )),
        }
    }

    pub(super) fn vox_offset(&self) -> f64 {
        match self.version {
            1 => f64::from(f32::from_le_bytes(self.at(108, 0))),
            _ => i64::from_le_bytes(self.at(0, 168)) as f64,
        }
    }

    /// Where the samples begin in a file of its own.
    pub(super) fn offset(&self, path: &Path) -> Result<u64, VolumeError> {
        let offset = self.vox_offset();
        if offset >= self.bytes.len() as f64 && offset.fract() == 0.0 {
            return Ok(offset as u64);
        }
        // Some writers leave 0 for "behind the header", which 4 bytes of extension flags follow.
        if offset == 0.0 {
            return Ok(self.bytes.len() as u64 + 4);
        }
        Err(format_error(
            path,
            Reason::header(format!("has samples at byte {offset} (vox_offset), in its header")),
        ))
    }

    pub(super) fn described(
        &self,
        path: &Path,
        frame: Option<u64>,
    ) -> Result<Described, VolumeError> {
        let said = |reason: Reason| format_error(path, reason);
        let axes = self.dim(0);
        if !(1..=7).contains(&axes) {
            return Err(said(Reason::header(format!(
                "has dim[0] = {axes}: 1 to 7 axes are possible"
            ))));
        }
        let size = |axis: usize| if axis as i64 <= axes { self.dim(axis) } else { 1 };
        let sizes = [1, 2, 3, 4, 5, 6, 7].map(size);
        if sizes.iter().any(|&size| size < 0) {
            return Err(said(Reason::damaged(format!(
                "has axes of {sizes:?} samples: its header is damaged"
            ))));
        }
        let sizes = sizes.map(|size| size as u64);
        let frames = Frames::choose(path, &sizes[3..], frame)?;
        let [x, y, z, ..] = sizes;
        let dims = Dims::unbounded(x, y, z)?;
        let dtype = match self.short(70, 12) {
            2 => Dtype::U8,
            4 => Dtype::I16,
            8 => Dtype::I32,
            16 => Dtype::F32,
            64 => Dtype::F64,
            256 => Dtype::I8,
            512 => Dtype::U16,
            768 => Dtype::U32,
            1024 => Dtype::I64,
            1280 => Dtype::U64,
            code => {
                let name = match code {
                    1 => "single bits",
                    128 | 2304 => {
                        let dims = Some([x, y, z]);
                        return Err(said(Reason::not_scalar("colours", dims)));
                    }
                    32 | 1792 | 2048 => "complex numbers",
                    1536 => "128-bit floats",
                    _ => "an unknown type",
                };
                return Err(said(Reason::unsupported(
                    format!(
                        "holds {name} (datatype {code}): integers of 8 to 64 bits, float32 \
                             and float64 are read"
                    ),
                    "convert it",
                )));
            }
        };
        let frame = self.frame(path, dims)?;
        let (endian, encoding) = (self.endian, Encoding::Raw);
        Ok(Described { dims, dtype, endian, frame, encoding, frames })
    }

    /// Slope and intercept; a slope of 0 means none.
    pub(super) fn scaling(&self) -> (f64, f64) {
        let (slope, inter) = (self.real(112, 176, 0), self.real(116, 184, 0));
        if slope != 0.0 && slope.is_finite() && inter.is_finite() {
            (slope, inter)
        } else {
            (1.0, 0.0)
        }
    }
}
