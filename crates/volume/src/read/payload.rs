//! Reads and decodes as many bytes of samples as a header claims.

use std::io::{self, Read};
use std::path::Path;

use walpha_base::memory::asking;
use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, Monitor};

use crate::error::format_error;
use crate::rounding::Rounding;
use crate::{Dims, Dtype, Endian, Reason, Sample, VolumeError};

/// The number of bytes decoded at a time, so that a file is never held in memory along with its samples.
const CHUNK_BYTES: usize = 8 << 20;

/// The data behind a header: a sequence of samples, and the number of bytes that they may have.
pub(super) struct Payload<R> {
    /// The reader, at the first sample.
    pub reader: R,
    /// What is known about the length before reading.
    pub length: Length,
}

/// The largest factor by which Deflate expands data (zlib's technical details), and other lossless codes, too. A header that
/// claims more is wrong.
pub(super) const MOST_EXPANSION: u64 = 1032;

/// What is known about the number of bytes left to read.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Length {
    /// The length of an uncompressed file or archive member.
    Exactly(u64),
    /// The largest possible length of a gzip stream, whose length is known only once it is read.
    AtMost(u64),
}

impl Length {
    /// The length for a gzip stream. A small file that claims a huge volume is refused before anything is allocated.
    pub(crate) fn of_gzip(compressed: u64) -> Self {
        Self::AtMost(compressed.saturating_mul(MOST_EXPANSION))
    }

    /// The length for a bzip2 stream, which packs 900 kB of runs, each of 255 bytes in 5, into as few as 40 bytes.
    pub(crate) fn of_bzip2(compressed: u64) -> Self {
        Self::AtMost(compressed.saturating_mul(1 << 21))
    }

    /// The length left after a header.
    pub(crate) fn minus(self, header: u64) -> Self {
        match self {
            Self::Exactly(bytes) => Self::Exactly(bytes.saturating_sub(header)),
            Self::AtMost(bytes) => Self::AtMost(bytes.saturating_sub(header)),
        }
    }
}

/// Why a payload does not contain the samples that its header claims.
#[derive(Debug)]
pub(super) enum PayloadError {
    /// The bytes needed, and those that exist; `bound` is empty, "at most " or "at least ".
    Length { needed: u64, found: u64, bound: &'static str },
    /// The samples fit the file but not the memory.
    Memory { needed: u64 },
    /// Reading was cancelled.
    Cancelled,
    /// The system refused, or the gzip stream is damaged.
    Io(io::Error),
}

impl<R: Read> Payload<R> {
    /// Reads exactly `count` samples, which must be all of the payload. The length is compared with the claim before anything is
    /// allocated; decoding runs in parallel, a few MB at a time.
    pub(super) fn samples<T: Element>(
        mut self,
        path: &Path,
        dtype: Dtype,
        endian: Endian,
        count: u64,
        monitor: &Monitor,
    ) -> Result<Vec<T>, PayloadError> {
        let needed = count.saturating_mul(dtype.size() as u64);
        match self.length {
            Length::Exactly(found) if found != needed => {
                return Err(PayloadError::Length { needed, found, bound: "" });
            }
            Length::AtMost(found) if found < needed => {
                return Err(PayloadError::Length { needed, found, bound: "at most " });
            }
            _ => {}
        }
        let mut samples = Vec::<T>::new();
        let memory =
            |_| PayloadError::Memory { needed: count.saturating_mul(size_of::<T>() as u64) };
        asking(|| samples.try_reserve_exact(usize::try_from(count).unwrap_or(usize::MAX)))
            .map_err(memory)?;
        let chunk = |left: u64| usize::try_from(left).unwrap_or(usize::MAX).min(CHUNK_BYTES);
        let mut bytes = vec![0; chunk(needed)];
        let mut left = needed;
        let rounding = Rounding::default();
        while left > 0 {
            let chunk = &mut bytes[..chunk(left)];
            let found = read_up_to(&mut self.reader, chunk).map_err(PayloadError::Io)?;
            left -= found as u64;
            if found < chunk.len() {
                let found = needed - left;
                return Err(PayloadError::Length { needed, found, bound: "" });
            }
            let start = samples.len();
            samples.resize(start + chunk.len() / dtype.size(), T::default());
            rounding.note(T::decode(chunk, dtype, endian, &mut samples[start..]));
            monitor.report(needed - left, needed).map_err(|_| PayloadError::Cancelled)?;
        }
        if read_up_to(&mut self.reader, &mut [0]).map_err(PayloadError::Io)? > 0 {
            return Err(PayloadError::Length { needed, found: needed + 1, bound: "at least " });
        }
        rounding.say(path);
        Ok(samples)
    }
}

/// The error for a file whose header claims a volume that it does not contain.
pub(super) fn payload_error(
    path: &Path,
    dims: &Dims,
    dtype: Dtype,
) -> impl Fn(PayloadError) -> VolumeError {
    let claim = format!("a volume of {dims} samples of type {dtype}");
    move |error| payload_error_of(path, &claim, error)
}

/// The error for data before the samples that cannot be read.
pub(super) fn unreadable(path: &Path) -> impl Fn(io::Error) -> VolumeError {
    move |error| payload_error_of(path, "what comes before its samples", PayloadError::Io(error))
}

/// The error for a file whose header claims something that it does not contain.
pub(super) fn payload_error_of(path: &Path, claim: &str, error: PayloadError) -> VolumeError {
    let reason = match error {
        PayloadError::Io(source) if source.kind() == io::ErrorKind::UnexpectedEof => {
            Reason::truncated(format!(
                "its compressed data (gzip, zlib or bzip2) end early, inside {claim}: it is \
                     truncated"
            ))
        }
        PayloadError::Io(source)
            if matches!(
                source.kind(),
                io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData
            ) =>
        {
            Reason::damaged(format!(
                "its encoded data (gzip, zlib, bzip2, LZ4 or base64) are damaged ({source})"
            ))
        }
        PayloadError::Io(source) => return VolumeError::Io { path: path.into(), source },
        PayloadError::Cancelled => return Cancelled.into(),
        PayloadError::Memory { needed } => Reason::Memory { claim: claim.into(), needed },
        PayloadError::Length { needed, found, bound } => {
            Reason::Length { claim: claim.into(), needed, found, bound }
        }
    };
    format_error(path, reason)
}

/// Fills the buffer as far as the data suffice.
fn read_up_to(reader: &mut impl Read, buffer: &mut [u8]) -> io::Result<usize> {
    let mut filled = 0;
    while filled < buffer.len() {
        match reader.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(n) => filled += n,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}

/// The number type that samples become: `f32` for volumes, `f64` for columns of points.
pub trait Element: Copy + Default + Send + Sync {
    /// Decodes as many samples as `out` is long. Returns whether whole numbers were rounded to `f32`.
    fn decode(bytes: &[u8], dtype: Dtype, endian: Endian, out: &mut [Self]) -> bool;
}

/// Implements [`Element`] with the language's `as`, which rounds to nearest.
macro_rules! element {
    ($target:ty) => {
        impl Element for $target {
            fn decode(bytes: &[u8], dtype: Dtype, endian: Endian, out: &mut [Self]) -> bool {
                macro_rules! each {
                    ($source:ty) => {{
                        const SIZE: usize = size_of::<$source>();
                        let from: fn([u8; SIZE]) -> $source = match endian {
                            Endian::Little => <$source>::from_le_bytes,
                            Endian::Big => <$source>::from_be_bytes,
                        };
                        let (words, _) = bytes.as_chunks::<SIZE>();
                        out.par_iter_mut()
                            .with_min_len(1 << 14)
                            .zip(words)
                            .map(|(value, &word)| {
                                let number = from(word);
                                *value = number as $target;
                                size_of::<$target>() == size_of::<f32>() && number.is_rounded()
                            })
                            .reduce(|| false, |one, other| one | other)
                    }};
                }
                match dtype {
                    Dtype::U8 => each!(u8),
                    Dtype::I8 => each!(i8),
                    Dtype::U16 => each!(u16),
                    Dtype::I16 => each!(i16),
                    Dtype::U32 => each!(u32),
                    Dtype::I32 => each!(i32),
                    Dtype::U64 => each!(u64),
                    Dtype::I64 => each!(i64),
                    Dtype::F32 => each!(f32),
                    Dtype::F64 => each!(f64),
                }
            }
        }
    };
}
element!(f32);
element!(f64);
