//! Zarr arrays, and pyramids of them as OME-Zarr lays them out.

use std::num::NonZeroU64;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;
use serde_json::Value;
use zarrs::array::{Array, DataType, ElementOwned};
use zarrs::array_subset::ArraySubset;
use zarrs::filesystem::FilesystemStore;
use zarrs::group::Group;

use super::described::{Described, Encoding, diagonal, frame};
use super::format_error;
use super::frames::Frames;
use super::series::is_zarr;
use crate::advice::{Setting, advice};
use crate::progress;
use crate::shown::shown;
use crate::volume::source::{Parts, Source};
use crate::volume::{
    Coordinates, Dims, Dtype, Endian, Frame, LengthUnit, Reason, Volume, VolumeError,
};

/// Reads a Zarr array of version 2 or 3 in a folder, or a level of an OME-Zarr pyramid (0, the finest,
/// unless `level` says otherwise).
///
/// The last three axes are z, y and x; those before them count volumes, of which
/// the one numbered `frame_index` is read. Scale and translation
/// of a pyramid give the frame. Memory for the samples and some rows of chunks at a time.
pub(crate) fn read(
    path: &Path,
    level: Option<u32>,
    frame_index: Option<u64>,
) -> Result<Volume, VolumeError> {
    let Stored { array, leading, dims, frame } = open(path, level, frame_index)?;
    let (dtype, samples) = samples(path, &array, dims.bounded()?, &leading)?;
    let (endian, encoding) = (Endian::Little, Encoding::Raw);
    Described { dims, dtype, endian, frame, encoding, frames: Frames::ONE }.volume(samples)
}

/// The same, to be read part by part.
pub(crate) fn source(
    path: &Path,
    level: Option<u32>,
    frame_index: Option<u64>,
) -> Result<Source, VolumeError> {
    let Stored { array, leading, dims, frame } = open(path, level, frame_index)?;
    let dtype = dtype(path, array.data_type())?;
    let axes = array.dimensionality();
    let chunk = array.chunk_shape(&vec![0; axes]).map_err(|error| damaged(path, &error))?;
    let grain = [1, 2, 3].map(|axis| chunk[axes - axis].get() as usize);
    check_chunk(path, &chunk, dims)?;
    let parts = ZarrParts { path: path.into(), array, leading };
    Ok(Source::new(dims, frame, dtype, grain, Box::new(parts)))
}

/// An array of a store, and where the volume in it is.
struct Stored {
    array: Array<FilesystemStore>,
    /// Indices along the axes before the last three.
    leading: Vec<u64>,
    dims: Dims,
    frame: Frame,
}

fn open(path: &Path, level: Option<u32>, frame_index: Option<u64>) -> Result<Stored, VolumeError> {
    let said = |reason: Reason| format_error(path, reason);
    let damaged = |error: &dyn std::fmt::Display| damaged(path, error);
    let store = Arc::new(FilesystemStore::new(path).map_err(|error| damaged(&error))?);
    if is_array(path) {
        if let Some(level) = level {
            return Err(said(Reason::needless(
                Setting::Level,
                format!("is one array and has no level {level}"),
            )));
        }
        let array = Array::open(store, "/").map_err(|error| damaged(&error))?;
        return stored(path, array, &[], Coordinates::VOXEL, frame_index);
    }
    let group = Group::open(Arc::clone(&store), "/").map_err(|error| damaged(&error))?;
    let attributes = Value::Object(group.attributes().clone());
    let pyramid = ["/ome/multiscales/0", "/multiscales/0"];
    let Some(pyramid) = pyramid.iter().find_map(|at| attributes.pointer(at)) else {
        return Err(said(Reason::unsupported(
            format!("is a Zarr group without the levels of OME-Zarr, of {}", children(path)),
            "name one of these",
        )));
    };
    let levels = pyramid["datasets"].as_array().map_or(&[][..], Vec::as_slice);
    let wanted = level.unwrap_or(0);
    let Some(dataset) = levels.get(wanted as usize) else {
        let count = levels.len();
        return Err(said(Reason::choice(
            Setting::Level,
            format!("has no level {wanted}, there are {count}"),
            advice![
                "give ",
                Setting::Level,
                format!(" 0 (the finest) to {}", count.saturating_sub(1))
            ],
        )));
    };
    let Some(name) = dataset["path"].as_str() else {
        return Err(said(Reason::damaged(format!(
            "names no array for level {wanted}: its metadata are damaged"
        ))));
    };
    // An upward step would lead to files that nobody named.
    if Path::new(name).components().any(|part| part == Component::ParentDir) {
        let reason = Reason::damaged(format!(
            "names {name:?} for level {wanted}, outside the store: its metadata are damaged"
        ));
        return Err(said(reason));
    }
    let array = Array::open(store, &format!("/{}", name.trim_matches('/')))
        .map_err(|error| damaged(&error))?;
    let transforms = [&dataset["coordinateTransformations"], &pyramid["coordinateTransformations"]];
    let transforms: Vec<&Value> =
        transforms.into_iter().filter_map(Value::as_array).flatten().collect();
    let unit = unit(&pyramid["axes"]).map_err(said)?;
    let coordinates = Coordinates { unit, ..Coordinates::default() };
    stored(path, array, &transforms, coordinates, frame_index)
}

/// The unit of the axes of space, which must have one in common.
fn unit(axes: &Value) -> Result<LengthUnit, Reason> {
    let of_space = |axis: &&Value| axis["type"] == "space";
    let axes = axes.as_array().into_iter().flatten().filter(of_space);
    let mut units = axes.map(|axis| axis["unit"].as_str().unwrap_or_default());
    let first = units.next().unwrap_or_default();
    match units.find(|&unit| unit != first) {
        None => Ok(LengthUnit::named(first)),
        Some(other) => Err(Reason::unsupported(
            format!("has axes in {first:?} and {other:?}"),
            "give them one unit in its metadata",
        )),
    }
}

fn is_array(folder: &Path) -> bool {
    let node = || -> Option<Value> {
        serde_json::from_slice(&std::fs::read(folder.join("zarr.json")).ok()?).ok()
    };
    folder.join(".zarray").is_file() || node().is_some_and(|node| node["node_type"] == "array")
}

/// The stores in a store, for a message.
fn children(folder: &Path) -> String {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .map(|entry| entry.path())
        .filter(|path| is_zarr(path))
        .map(|path| shown(&path))
        .collect();
    names.sort();
    if names.is_empty() { "nothing".to_owned() } else { names.join(", ") }
}

fn damaged(path: &Path, error: &dyn std::fmt::Display) -> VolumeError {
    let what = format!("is a Zarr store that cannot be read ({error})");
    format_error(path, Reason::damaged(what))
}

/// A volume of an array, placed by the transformations of OME-Zarr, the first first.
fn stored(
    path: &Path,
    array: Array<FilesystemStore>,
    transforms: &[&Value],
    coordinates: Coordinates,
    frame_index: Option<u64>,
) -> Result<Stored, VolumeError> {
    let said = |reason: Reason| format_error(path, reason);
    let shape = array.shape().to_vec();
    let [before @ .., z, y, x] = &shape[..] else {
        return Err(said(Reason::header(format!(
            "has the shape {shape:?}: a volume has three axes, z, y and x"
        ))));
    };
    let mut left = Frames::choose(path, before, frame_index)?.index;
    let mut leading = vec![0; before.len()];
    for (index, &size) in leading.iter_mut().zip(before).rev() {
        (*index, left) = (left % size, left / size);
    }
    let dims = Dims::unbounded(*x, *y, *z)?;
    let (mut scale, mut origin) = ([1.0; 3], [0.0; 3]);
    for transform in transforms {
        let numbers = |name: &str| -> Option<[f64; 3]> {
            let numbers: Vec<f64> =
                transform[name].as_array()?.iter().filter_map(Value::as_f64).collect();
            let [.., z, y, x] = numbers[..] else { return None };
            (numbers.len() == shape.len()).then_some([x, y, z])
        };
        let kind = transform["type"].as_str().unwrap_or_default();
        match (kind, numbers("scale"), numbers("translation")) {
            ("scale", Some(by), _) => {
                (0..3).for_each(|k| (scale[k], origin[k]) = (scale[k] * by[k], origin[k] * by[k]));
            }
            ("translation", _, Some(by)) => (0..3).for_each(|k| origin[k] += by[k]),
            ("identity", ..) => {}
            _ => {
                return Err(said(Reason::unsupported(
                    format!(
                        "is placed by {transform}, which is not read: only scale and \
                             translation of as many numbers as axes are"
                    ),
                    "convert it first",
                )));
            }
        }
    }
    let frame = frame(path, origin, diagonal(scale), coordinates)?;
    Ok(Stored { array, leading, dims, frame })
}

/// Calls a method with what turns samples of this type into `f32`.
macro_rules! by_type {
    ($dtype:expr, $object:ident.$read:ident $(, $argument:expr)*) => {
        match $dtype {
            Dtype::U8 => $object.$read($($argument,)* |v: u8| v.into()),
            Dtype::I8 => $object.$read($($argument,)* |v: i8| v.into()),
            Dtype::U16 => $object.$read($($argument,)* |v: u16| v.into()),
            Dtype::I16 => $object.$read($($argument,)* |v: i16| v.into()),
            Dtype::U32 => $object.$read($($argument,)* |v: u32| v as f32),
            Dtype::I32 => $object.$read($($argument,)* |v: i32| v as f32),
            Dtype::U64 => $object.$read($($argument,)* |v: u64| v as f32),
            Dtype::I64 => $object.$read($($argument,)* |v: i64| v as f32),
            Dtype::F32 => $object.$read($($argument,)* |v: f32| v),
            Dtype::F64 => $object.$read($($argument,)* |v: f64| v as f32),
        }
    };
}

fn samples(
    path: &Path,
    array: &Array<FilesystemStore>,
    dims: Dims,
    leading: &[u64],
) -> Result<(Dtype, Vec<f32>), VolumeError> {
    let dtype = dtype(path, array.data_type())?;
    let read = Read { path, array, dims, leading };
    Ok((dtype, by_type!(dtype, read.all)?))
}

/// The type of samples.
fn dtype(path: &Path, stored: &DataType) -> Result<Dtype, VolumeError> {
    Ok(match stored {
        DataType::UInt8 => Dtype::U8,
        DataType::Int8 => Dtype::I8,
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
                    "holds samples of type {other}: integers of 8 to 64 bits, float32 and \
                         float64 are read"
                ),
                "convert it first",
            );
            return Err(format_error(path, reason));
        }
    })
}

/// Samples read at a time, or one row of chunks if that is more.
const PIECE: u64 = 1 << 22;
/// A chunk is decoded as a whole; larger ones must be of an array of their size.
const MOST_IN_CHUNK: u64 = 1 << 26;

fn check_chunk(path: &Path, chunk: &[NonZeroU64], dims: Dims) -> Result<(), VolumeError> {
    let in_chunk = chunk.iter().fold(1u64, |product, size| product.saturating_mul(size.get()));
    if in_chunk > MOST_IN_CHUNK.max(8 * dims.samples() as u64) {
        let what = format!(
            "has chunks of {in_chunk} samples, far more than the array: it is damaged, or store it \
             in smaller chunks"
        );
        return Err(format_error(path, Reason::damaged(what)));
    }
    Ok(())
}

/// An array that is read part by part.
struct ZarrParts {
    path: PathBuf,
    array: Array<FilesystemStore>,
    /// Indices along the axes before the last three.
    leading: Vec<u64>,
}

impl Parts for ZarrParts {
    fn read(&self, first: [usize; 3], size: [usize; 3]) -> Result<Vec<f32>, VolumeError> {
        let dtype = dtype(&self.path, self.array.data_type())?;
        let mut ranges: Vec<_> = self.leading.iter().map(|&i| i..i + 1).collect();
        ranges.extend([2, 1, 0].map(|k| first[k] as u64..(first[k] + size[k]) as u64));
        let part = ArraySubset::new_with_ranges(&ranges);
        by_type!(dtype, self.part, &part)
    }
}

impl ZarrParts {
    fn part<T: ElementOwned + Copy>(
        &self,
        part: &ArraySubset,
        convert: impl Fn(T) -> f32,
    ) -> Result<Vec<f32>, VolumeError> {
        let read = self.array.retrieve_array_subset_elements::<T>(part);
        let samples = read.map_err(|error| damaged(&self.path, &error))?;
        Ok(samples.into_iter().map(convert).collect())
    }
}

struct Read<'a> {
    path: &'a Path,
    array: &'a Array<FilesystemStore>,
    dims: Dims,
    /// Along the axes before the last three.
    leading: &'a [u64],
}

impl Read<'_> {
    /// All samples, by as many slices at once as a chunk is thick, and as many rows as fit a piece.
    fn all<T: ElementOwned + Copy + Send + Sync>(
        &self,
        convert: impl Fn(T) -> f32 + Send + Sync,
    ) -> Result<Vec<f32>, VolumeError> {
        let Self { path, array, dims, leading } = self;
        let said = |reason: Reason| format_error(path, reason);
        let axes = array.dimensionality();
        let damaged = |error: &dyn std::fmt::Display| {
            said(Reason::damaged(format!("is a Zarr array that cannot be read ({error})")))
        };
        let chunk = array.chunk_shape(&vec![0; axes]).map_err(|error| damaged(&error))?;
        check_chunk(path, &chunk, *dims)?;
        let [thick, high] = [3, 2].map(|axis| chunk[axes - axis].get());
        let mut samples = Vec::new();
        samples.try_reserve_exact(dims.samples()).map_err(|_| {
            let bytes = dims.samples() * size_of::<f32>();
            said(Reason::choice(
                Setting::Level,
                format!("needs {bytes} bytes of memory, which cannot be had"),
                advice!["choose a coarser ", Setting::Level],
            ))
        })?;
        let [x, y, z] = dims.xyz().map(|size| size as u64);
        samples.resize(dims.samples(), 0.0);
        // Whole chunks, so that none is decoded twice.
        let row_of_chunks = thick.saturating_mul(high).saturating_mul(x);
        let high = high.saturating_mul((PIECE / row_of_chunks).max(1));
        let steps = |size: u64, step: u64| {
            let step = step.min(size);
            (0..size.div_ceil(step)).map(move |k| k * step..((k + 1) * step).min(size))
        };
        for (slices, rows) in steps(z, thick)
            .flat_map(|slices| steps(y, high).map(move |rows| (slices.clone(), rows)))
        {
            let mut ranges: Vec<_> = leading.iter().map(|&i| i..i + 1).collect();
            ranges.extend([slices.clone(), rows.clone(), 0..x]);
            let part = ArraySubset::new_with_ranges(&ranges);
            let part: Vec<T> =
                array.retrieve_array_subset_elements(&part).map_err(|error| damaged(&error))?;
            let in_slice = ((rows.end - rows.start) * x) as usize;
            for (slice, part) in slices.clone().zip(part.chunks(in_slice)) {
                let at = ((slice * y + rows.start) * x) as usize;
                let samples = &mut samples[at..at + in_slice];
                samples.par_iter_mut().zip(part).for_each(|(sample, &v)| *sample = convert(v));
            }
            progress::report(slices.start * y + rows.end * (slices.end - slices.start), z * y);
        }
        Ok(samples)
    }
}
