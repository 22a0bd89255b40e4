//! Zarr arrays, and pyramids of them as OME-Zarr lays them out.

mod samples;

use std::path::{Component, Path};
use std::sync::Arc;

use serde_json::Value;
use walpha_base::Monitor;
use walpha_base::advice::{Setting, advice};
use walpha_base::shown::shown;
use zarrs::array::Array;
use zarrs::filesystem::FilesystemStore;
use zarrs::group::Group;

use super::frames::FrameChoice;
use super::layout::{Encoding, Layout, diagonal, frame};
use super::series::is_zarr;
use crate::error::format_error;
use crate::source::Source;
use crate::{Coordinates, Dims, Endian, Frame, LengthUnit, Reason, Volume, VolumeError};
use samples::{ZarrBoxes, check_chunk, damaged, dtype, samples};

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
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let PlacedArray { array, leading, dims, frame } = open(path, level, frame_index)?;
    let (dtype, samples) = samples(path, &array, dims.bounded()?, &leading, monitor)?;
    let (endian, encoding) = (Endian::Little, Encoding::Raw);
    Layout { dims, dtype, endian, frame, encoding, frames: FrameChoice::ONE }.volume(samples)
}

/// The same, to be read part by part.
pub(crate) fn source(
    path: &Path,
    level: Option<u32>,
    frame_index: Option<u64>,
) -> Result<Source, VolumeError> {
    let PlacedArray { array, leading, dims, frame } = open(path, level, frame_index)?;
    let dtype = dtype(path, array.data_type())?;
    let axes = array.dimensionality();
    let chunk = array.chunk_shape(&vec![0; axes]).map_err(|error| damaged(path, &error))?;
    let grain = [1, 2, 3].map(|axis| chunk[axes - axis].get() as usize);
    check_chunk(path, &chunk, dims)?;
    let parts = ZarrBoxes { path: path.into(), array, leading };
    Ok(Source::new(dims, frame, dtype, grain, Box::new(parts)))
}

/// An array of a store, and where the volume in it is.
struct PlacedArray {
    array: Array<FilesystemStore>,
    /// Indices along the axes before the last three.
    leading: Vec<u64>,
    dims: Dims,
    frame: Frame,
}

fn open(
    path: &Path,
    level: Option<u32>,
    frame_index: Option<u64>,
) -> Result<PlacedArray, VolumeError> {
    let fail = |reason: Reason| format_error(path, reason);
    let damaged = |error: &dyn std::fmt::Display| damaged(path, error);
    let store = Arc::new(FilesystemStore::new(path).map_err(|error| damaged(&error))?);
    if is_array(path) {
        if let Some(level) = level {
            return Err(fail(Reason::needless(
                Setting::Level,
                format!("is one array and has no level {level}"),
            )));
        }
        let array = Array::open(store, "/").map_err(|error| damaged(&error))?;
        return placed(path, array, &[], Coordinates::VOXEL, frame_index);
    }
    let group = Group::open(Arc::clone(&store), "/").map_err(|error| damaged(&error))?;
    let attributes = Value::Object(group.attributes().clone());
    let pyramid = ["/ome/multiscales/0", "/multiscales/0"];
    let Some(pyramid) = pyramid.iter().find_map(|at| attributes.pointer(at)) else {
        return Err(fail(Reason::unsupported(
            format!("is a Zarr group without the levels of OME-Zarr, of {}", children(path)),
            "name one of these",
        )));
    };
    let (dataset, name) = dataset(pyramid, level).map_err(fail)?;
    let array = Array::open(store, &format!("/{}", name.trim_matches('/')))
        .map_err(|error| damaged(&error))?;
    let transforms = [&dataset["coordinateTransformations"], &pyramid["coordinateTransformations"]];
    let transforms: Vec<&Value> =
        transforms.into_iter().filter_map(Value::as_array).flatten().collect();
    let unit = unit(&pyramid["axes"]).map_err(fail)?;
    let coordinates = Coordinates { unit, ..Coordinates::default() };
    placed(path, array, &transforms, coordinates, frame_index)
}

/// A level of a pyramid, and the path of its array.
fn dataset(pyramid: &Value, level: Option<u32>) -> Result<(&Value, &str), Reason> {
    let levels = pyramid["datasets"].as_array().map_or(&[][..], Vec::as_slice);
    let wanted = level.unwrap_or(0);
    let Some(dataset) = levels.get(wanted as usize) else {
        let count = levels.len();
        return Err(Reason::choice(
            Setting::Level,
            format!("has no level {wanted}, there are {count}"),
            advice![
                "give ",
                Setting::Level,
                format!(" 0 (the finest) to {}", count.saturating_sub(1))
            ],
        ));
    };
    let Some(name) = dataset["path"].as_str() else {
        return Err(Reason::damaged(format!(
            "names no array for level {wanted}: its metadata are damaged"
        )));
    };
    // An upward step would lead to files that nobody named.
    if Path::new(name).components().any(|part| part == Component::ParentDir) {
        return Err(Reason::damaged(format!(
            "names {name:?} for level {wanted}, outside the store: its metadata are damaged"
        )));
    }
    Ok((dataset, name))
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

/// A volume of an array, placed by the transformations of OME-Zarr, the first first.
fn placed(
    path: &Path,
    array: Array<FilesystemStore>,
    transforms: &[&Value],
    coordinates: Coordinates,
    frame_index: Option<u64>,
) -> Result<PlacedArray, VolumeError> {
    let fail = |reason: Reason| format_error(path, reason);
    let shape = array.shape().to_vec();
    let [before @ .., z, y, x] = &shape[..] else {
        return Err(fail(Reason::header(format!(
            "has the shape {shape:?}: a volume has three axes, z, y and x"
        ))));
    };
    let mut left = FrameChoice::choose(path, before, frame_index)?.index;
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
                return Err(fail(Reason::unsupported(
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
    Ok(PlacedArray { array, leading, dims, frame })
}
