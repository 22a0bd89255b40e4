//! The samples of a Zarr array, all at once or part by part.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};

use serde_json::Value;
use walpha_base::Monitor;
use walpha_base::advice::{Setting, advice};
use walpha_base::memory::asking;
use zarrs::array::{Array, DataType, ElementOwned};
use zarrs::array_subset::ArraySubset;
use zarrs::filesystem::FilesystemStore;

use super::axes::Axes;
use super::packing::Packing;
use crate::error::format_error;
use crate::formats::decoded;
use crate::source::BoxReader;
use crate::{Dims, Dtype, Reason, VolumeError};

/// Calls a method with the function that converts numbers of the array's type to samples.
macro_rules! by_type {
    ($array:expr, $packing:expr, $object:ident.$read:ident $(, $argument:expr)*) => {{
        let packing = $packing;
        match packing.stored {
            _ if *$array.data_type() == DataType::Bool => $object.$read($($argument,)* |v: bool| f32::from(v)),
            Dtype::U8 => $object.$read($($argument,)* |v: u8| packing.sample(v, v.into())),
            Dtype::I8 => $object.$read($($argument,)* |v: i8| packing.sample(v, v.into())),
            Dtype::U16 => $object.$read($($argument,)* |v: u16| packing.sample(v, v.into())),
            Dtype::I16 => $object.$read($($argument,)* |v: i16| packing.sample(v, v.into())),
            Dtype::U32 => $object.$read($($argument,)* |v: u32| packing.sample(v, v.into())),
            Dtype::I32 => $object.$read($($argument,)* |v: i32| packing.sample(v, v.into())),
            Dtype::U64 => $object.$read($($argument,)* |v: u64| packing.sample(v, v as f64)),
            Dtype::I64 => $object.$read($($argument,)* |v: i64| packing.sample(v, v as f64)),
            Dtype::F32 => $object.$read($($argument,)* |v: f32| packing.sample(v, v.into())),
            Dtype::F64 => $object.$read($($argument,)* |v: f64| packing.sample(v, v)),
        }
    }};
}

pub(super) fn samples(
    path: &Path,
    array: &Array<FilesystemStore>,
    axes: &Axes,
    packing: &Packing,
    monitor: &Monitor,
) -> Result<Vec<f32>, VolumeError> {
    let read = ArrayReader { path, array, axes, monitor };
    let samples = by_type!(array, packing, read.all)?;
    packing.rounding.say(path);
    Ok(samples)
}

/// The type of samples.
pub(super) fn dtype(path: &Path, stored: &DataType) -> Result<Dtype, VolumeError> {
    Ok(match stored {
        DataType::UInt8 => Dtype::U8,
        // Booleans are bytes of 0 and 1, but not gray levels.
        DataType::Int8 | DataType::Bool => Dtype::I8,
        DataType::UInt16 => Dtype::U16,
        DataType::Int16 => Dtype::I16,
        DataType::UInt32 => Dtype::U32,
        DataType::Int32 => Dtype::I32,
        DataType::UInt64 => Dtype::U64,
        DataType::Int64 => Dtype::I64,
        DataType::Float32 => Dtype::F32,
        DataType::Float64 => Dtype::F64,
        other => {
            let reason = Reason::unsupported(
                format!(
                    "holds samples of type {other}: bool, integers of 8 to 64 bits, float32 and \
                         float64 are read"
                ),
                "convert it first",
            );
            return Err(format_error(path, reason));
        }
    })
}

/// The number of samples read at a time, unless one row of chunks has more.
const PIECE: u64 = 1 << 22;
/// The largest number of samples in a chunk, which is decoded as a whole. A larger chunk must be the only one of its array.
const MOST_IN_CHUNK: u64 = 1 << 26;

pub(super) fn check_chunk(
    path: &Path,
    chunk: &[NonZeroU64],
    dims: Dims,
) -> Result<(), VolumeError> {
    let in_chunk = chunk.iter().fold(1u64, |product, size| product.saturating_mul(size.get()));
    if in_chunk > MOST_IN_CHUNK.max(8 * dims.samples() as u64) {
        let what = format!("has chunks of {in_chunk} samples, far more than the array");
        return Err(format_error(path, Reason::unsupported(what, "store it in smaller chunks")));
    }
    Ok(())
}

/// An array that is read part by part.
pub(super) struct ZarrBoxes {
    pub path: PathBuf,
    pub array: Array<FilesystemStore>,
    pub axes: Axes,
    pub packing: Packing,
}

impl BoxReader for ZarrBoxes {
    fn read(&self, first: [usize; 3], size: [usize; 3]) -> Result<Vec<f32>, VolumeError> {
        let ranges = [2, 1, 0].map(|k| first[k] as u64..(first[k] + size[k]) as u64);
        let part = self.axes.subset(ranges);
        let [x, y, z] = size;
        let samples = decoded(&self.path, || {
            by_type!(self.array, &self.packing, self.part, &part, [z, y, x])
        })?;
        self.packing.rounding.say(&self.path);
        Ok(samples)
    }
}

impl ZarrBoxes {
    fn part<T: ElementOwned + Copy>(
        &self,
        part: &ArraySubset,
        sizes: [usize; 3],
        convert: impl Fn(T) -> f32,
    ) -> Result<Vec<f32>, VolumeError> {
        check_shards(&self.array, part).map_err(|error| damaged(&self.path, &error))?;
        let read = self.array.retrieve_array_subset_elements::<T>(part);
        let part = read.map_err(|error| damaged(&self.path, &error))?;
        let mut samples = Vec::with_capacity(part.len());
        self.axes.rows(&part, sizes, |_, row| {
            samples.extend(row.iter().map(|&element| convert(element)));
        });
        Ok(samples)
    }
}

struct ArrayReader<'a> {
    path: &'a Path,
    array: &'a Array<FilesystemStore>,
    axes: &'a Axes,
    monitor: &'a Monitor,
}

/// The size in bytes of an array that is accepted without any stored data. Zarr leaves out chunks that contain only the fill
/// value, so an array may be larger than its stored data.
const MOST_UNSTORED: u64 = 1 << 28;
/// The largest expansion of any codec: zstd repeats a byte 128 KiB long for 4 bytes of code.
const MOST_EXPANSION: u64 = 1 << 15;

/// Refuses an array that claims far more than its stored data can contain, before memory is requested and before its parts are
/// read.
pub(super) fn check_stored(path: &Path, dims: Dims) -> Result<(), VolumeError> {
    let needed = (dims.samples() as u64).saturating_mul(size_of::<f32>() as u64);
    if needed <= MOST_UNSTORED {
        return Ok(());
    }
    let enough = needed.div_ceil(MOST_EXPANSION);
    let found = stored(path, enough);
    if found >= enough {
        return Ok(());
    }
    let what =
        format!("claims {dims} samples and holds {found} bytes: nearly all its chunks are missing");
    Err(format_error(path, Reason::content(what, "copy the whole store, or correct its shape")))
}

/// The number of bytes in a folder and its subfolders; counting stops at `enough`.
fn stored(folder: &Path, enough: u64) -> u64 {
    let (mut folders, mut bytes) = (vec![folder.to_owned()], 0u64);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            match entry.metadata() {
                Ok(about) if about.is_dir() => folders.push(entry.path()),
                Ok(about) => bytes = bytes.saturating_add(about.len()),
                Err(_) => {}
            }
            if bytes >= enough {
                return bytes;
            }
        }
    }
    bytes
}

impl ArrayReader<'_> {
    /// All samples. A step reads as many slices as a chunk is thick, and as many rows as fit a piece.
    fn all<T: ElementOwned + Copy>(
        &self,
        convert: impl Fn(T) -> f32,
    ) -> Result<Vec<f32>, VolumeError> {
        let Self { path, array, axes, monitor } = self;
        let fail = |reason: Reason| format_error(path, reason);
        let dims = axes.dims;
        let damaged = |error: &dyn std::fmt::Display| damaged(path, error);
        let chunk =
            array.chunk_shape(&vec![0; array.dimensionality()]).map_err(|error| damaged(&error))?;
        check_chunk(path, &chunk, dims)?;
        check_stored(path, dims)?;
        let [thick, high, _] = axes.sizes(&chunk);
        let mut samples = Vec::new();
        asking(|| samples.try_reserve_exact(dims.samples())).map_err(|_| {
            let bytes = dims.bytes(size_of::<f32>());
            fail(Reason::choice(
                Setting::Level,
                format!("needs {bytes} bytes of memory, more than is available"),
                advice!["choose a coarser ", Setting::Level],
            ))
        })?;
        let [x, y, z] = dims.xyz().map(|size| size as u64);
        samples.resize(dims.samples(), 0.0);
        // Only whole chunks are read, so that none is decoded twice.
        let row_of_chunks = thick.saturating_mul(high).saturating_mul(x);
        let high = high.saturating_mul((PIECE / row_of_chunks).max(1));
        let steps = |size: u64, step: u64| {
            let step = step.min(size);
            (0..size.div_ceil(step)).map(move |k| k * step..((k + 1) * step).min(size))
        };
        for (slices, rows) in steps(z, thick)
            .flat_map(|slices| steps(y, high).map(move |rows| (slices.clone(), rows)))
        {
            let part = axes.subset([slices.clone(), rows.clone(), 0..x]);
            check_shards(array, &part).map_err(|error| damaged(&error))?;
            let part: Vec<T> =
                array.retrieve_array_subset_elements(&part).map_err(|error| damaged(&error))?;
            let [slices_here, rows_here] =
                [&slices, &rows].map(|range| (range.end - range.start) as usize);
            let row_length = x as usize;
            axes.rows(&part, [slices_here, rows_here, row_length], |i, row| {
                let (slice, y_of_row) =
                    (slices.start as usize + i / rows_here, rows.start as usize + i % rows_here);
                let at = (slice * y as usize + y_of_row) * row_length;
                let samples = &mut samples[at..at + row_length];
                samples
                    .iter_mut()
                    .zip(row)
                    .for_each(|(sample, &element)| *sample = convert(element));
            });
            monitor.report(slices.start * y + rows.end * (slices.end - slices.start), z * y)?;
        }
        Ok(samples)
    }
}

/// The error for a damaged chunk or shard.
pub(super) fn damaged(path: &Path, error: &dyn std::fmt::Display) -> VolumeError {
    let what = format!("is a Zarr store with a chunk that cannot be read ({error})");
    let advice = "copy the whole store again, or write it anew with the program that made it";
    format_error(path, Reason::content(what, advice))
}

// Shards are chunks that contain chunks and an index of their positions. The index is checked before it is used: the reader adds
// an offset to a length without checking for overflow.

/// The layout of a shard's index in its file.
struct Index {
    /// The number of chunks in a shard. Each has an offset and a length of 64 bits.
    chunks: u64,
    at_start: bool,
    /// The size in bytes of a checksum behind the index.
    sum: u64,
}

/// Checks that the shards of a part of an array refer to positions in their own files. Arrays without shards pass, and so do
/// shards with a compressed index, which no known program writes.
///
/// # Errors
/// The message says what is wrong.
fn check_shards(array: &Array<FilesystemStore>, part: &ArraySubset) -> io::Result<()> {
    let Some(index) = Index::of(array) else { return Ok(()) };
    let Ok(Some(shards)) = array.chunks_in_array_subset(part) else { return Ok(()) };
    let store = array.storage();
    for place in &shards.indices() {
        let path = store.key_to_fspath(&array.chunk_key(&place));
        match File::open(path) {
            Ok(file) => index.check(file)?,
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

impl Index {
    fn of(array: &Array<FilesystemStore>) -> Option<Self> {
        let metadata = serde_json::to_value(array.metadata()).ok()?;
        let codecs = metadata["codecs"].as_array()?;
        let sharding = codecs.iter().find(|codec| codec["name"] == "sharding_indexed")?;
        let about = &sharding["configuration"];
        let product = |sizes: &Value| -> Option<u64> {
            sizes
                .as_array()?
                .iter()
                .try_fold(1u64, |product, size| product.checked_mul(size.as_u64()?))
        };
        let shard = product(&metadata["chunk_grid"]["configuration"]["chunk_shape"])?;
        let chunks = shard.checked_div(product(&about["chunk_shape"])?)?;
        let mut sum = 0;
        for codec in about["index_codecs"].as_array()? {
            match codec["name"].as_str()? {
                "bytes" if codec["configuration"]["endian"] != "big" => {}
                "crc32c" => sum = 4,
                _ => return None,
            }
        }
        Some(Self { chunks, at_start: about["index_location"] == "start", sum })
    }

    /// Checks the index of a shard.
    fn check(&self, mut shard: File) -> io::Result<()> {
        /// The offset and length of a missing chunk.
        const NONE: [u64; 2] = [u64::MAX; 2];
        let wrong = |what: String| io::Error::new(ErrorKind::InvalidData, what);
        let length = shard.metadata()?.len();
        let bytes = self.chunks.checked_mul(16).filter(|bytes| *bytes <= length);
        let from = bytes.and_then(|bytes| length.checked_sub(bytes.checked_add(self.sum)?));
        let (Some(bytes), Some(from)) = (bytes, from) else {
            return Err(wrong(format!("a shard of {length} bytes is too short for its index")));
        };
        shard.seek(SeekFrom::Start(if self.at_start { 0 } else { from }))?;
        let mut index = Vec::new();
        shard.take(bytes).read_to_end(&mut index)?;
        for entry in index.as_chunks::<16>().0 {
            let [at, size] =
                [0, 8].map(|k| u64::from_le_bytes(entry[k..k + 8].try_into().expect("8 bytes")));
            if [at, size] != NONE && at.checked_add(size).is_none_or(|end| end > length) {
                return Err(wrong(format!(
                    "a shard of {length} bytes says that a chunk of {size} is at {at}"
                )));
            }
        }
        Ok(())
    }
}
