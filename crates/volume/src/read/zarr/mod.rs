//! Zarr arrays, and pyramids of them as OME-Zarr lays them out.

mod axes;
mod samples;

use std::path::{Component, Path};
use std::sync::Arc;

use serde_json::Value;
use walpha_base::Monitor;
use walpha_base::advice::{Setting, advice};
use walpha_base::shown::shown;
use zarrs::array::{Array, ArrayCreateError, ArrayMetadata, ArrayMetadataV2};
use zarrs::filesystem::FilesystemStore;
use zarrs::group::Group;

use super::frames::FrameChoice;
use super::layout::{Encoding, Layout, diagonal, frame, one_unit, unit_named};
use super::series::is_zarr;
use crate::error::format_error;
use crate::source::Source;
use crate::{Coordinates, Endian, Frame, Reason, Volume, VolumeError};
use axes::{Axes, NamedAxis};
use samples::{ZarrBoxes, check_chunk, check_stored, damaged, dtype, samples};

/// Reads a Zarr array of version 2 or 3 in a folder, or a level of an OME-Zarr pyramid (0, the finest,
/// unless `level` says otherwise).
///
/// Axes called x, y and z are these, whatever their order; where none has a name the last three are z, y and x.
/// The others count volumes, of which the one numbered `frame_index` is read. Scale and translation
/// of a pyramid give the frame. Memory for the samples and some rows of chunks at a time.
pub(crate) fn read(
    path: &Path,
    level: Option<u32>,
    frame_index: Option<u64>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let PlacedArray { array, axes, frame } = open(path, level, frame_index)?;
    let dims = axes.dims.bounded()?;
    let (dtype, samples) = samples(path, &array, &axes, monitor)?;
    let (endian, encoding) = (Endian::Little, Encoding::Raw);
    Layout { dims, dtype, endian, frame, encoding, frames: FrameChoice::ONE }.volume(samples)
}

/// The same, to be read part by part.
pub(crate) fn source(
    path: &Path,
    level: Option<u32>,
    frame_index: Option<u64>,
) -> Result<Source, VolumeError> {
    let PlacedArray { array, axes, frame } = open(path, level, frame_index)?;
    let (dtype, dims) = (dtype(path, array.data_type())?, axes.dims);
    let chunk = array.chunk_shape(&vec![0; array.dimensionality()]);
    let chunk = chunk.map_err(|error| damaged(path, &error))?;
    let [z, y, x] = axes.sizes(&chunk).map(|size| size as usize);
    check_chunk(path, &chunk, dims)?;
    check_stored(path, dims)?;
    let parts = ZarrBoxes { path: path.into(), array, axes };
    Ok(Source::new(dims, frame, dtype, [x, y, z], Box::new(parts)))
}

/// An array of a store, and where the volume in it is.
struct PlacedArray {
    array: Array<FilesystemStore>,
    axes: Axes,
    frame: Frame,
}

fn open(
    path: &Path,
    level: Option<u32>,
    frame_index: Option<u64>,
) -> Result<PlacedArray, VolumeError> {
    let fail = |reason: Reason| format_error(path, reason);
    let unreadable = |error: &dyn std::fmt::Display| {
        fail(Reason::header(format!("is a Zarr store whose metadata cannot be read ({error})")))
    };
    let store = Arc::new(FilesystemStore::new(path).map_err(|error| unreadable(&error))?);
    if is_array(path) {
        if let Some(level) = level {
            return Err(fail(Reason::needless(
                Setting::Level,
                format!("is one array and has no level {level}"),
            )));
        }
        let array = open_array(path, store, "/")?;
        let named = named_by_array(&array).or_else(|| named_by_pyramid_of(path));
        let axes = Axes::find(path, array.shape(), named.as_deref(), frame_index)?;
        return Ok(PlacedArray { array, axes, frame: Frame::VOXEL });
    }
    let group = Group::open(Arc::clone(&store), "/").map_err(|error| unreadable(&error))?;
    let attributes = Value::Object(group.attributes().clone());
    let pyramid = ["/ome/multiscales/0", "/multiscales/0"];
    let Some(pyramid) = pyramid.iter().find_map(|at| attributes.pointer(at)) else {
        return Err(fail(Reason::unsupported(
            format!("is a Zarr group without the levels of OME-Zarr, of {}", children(path)),
            "name one of these",
        )));
    };
    let (dataset, name) = dataset(pyramid, level).map_err(fail)?;
    let array = open_array(path, store, &format!("/{}", name.trim_matches('/')))?;
    let named = NamedAxis::of(&pyramid["axes"]).or_else(|| named_by_array(&array));
    let axes = Axes::find(path, array.shape(), named.as_deref(), frame_index)?;
    let transforms = [&dataset["coordinateTransformations"], &pyramid["coordinateTransformations"]];
    let transforms: Vec<&Value> =
        transforms.into_iter().filter_map(Value::as_array).flatten().collect();
    let unit =
        |axis: usize| pyramid["axes"][axis]["unit"].as_str().map(|name| unit_named(path, name));
    let [z, y, x] = axes.space.map(|axis| axis.and_then(unit));
    let (unit, factors) = one_unit(path, [x, y, z])?;
    let (scale, origin) = placed(path, array.shape().len(), &axes, &transforms)?;
    let [scale, origin] = [scale, origin].map(|lengths| [0, 1, 2].map(|k| lengths[k] * factors[k]));
    let coordinates = Coordinates { unit, ..Coordinates::default() };
    let frame = frame(path, origin, diagonal(scale), coordinates)?;
    Ok(PlacedArray { array, axes, frame })
}

/// Opens an array; what it is stored by may not be known here.
fn open_array(
    path: &Path,
    store: Arc<FilesystemStore>,
    at: &str,
) -> Result<Array<FilesystemStore>, VolumeError> {
    let fail = |reason: Reason| format_error(path, reason);
    let folder = path.join(at.trim_start_matches('/'));
    let array = match boolean(&folder) {
        Some(metadata) => Array::new_with_metadata(store, at, metadata),
        None => Array::open(store, at),
    };
    array.map_err(|error| match error {
        ArrayCreateError::MissingMetadata => {
            fail(Reason::header(format!("names the array {at}, which is not there")))
        }
        ArrayCreateError::DataTypeCreateError(_)
        | ArrayCreateError::CodecsCreateError(_)
        | ArrayCreateError::StorageTransformersCreateError(_)
        | ArrayCreateError::ChunkGridCreateError(_)
        | ArrayCreateError::ChunkKeyEncodingCreateError(_)
        | ArrayCreateError::AdditionalFieldUnsupportedError(_)
        | ArrayCreateError::UnsupportedZarrV2Array(_) => fail(Reason::unsupported(
            format!("is a Zarr array of a kind that is not read ({error})"),
            "store it anew, as numbers compressed with blosc, zstd or gzip, and without filters",
        )),
        error => {
            fail(Reason::header(format!("is a Zarr array whose metadata cannot be read ({error})")))
        }
    })
}

/// The metadata of an array of version 2 whose fill value is true or false, with 1 or 0 for it.
fn boolean(folder: &Path) -> Option<ArrayMetadata> {
    let json = |name: &str| -> Option<Value> {
        serde_json::from_slice(&std::fs::read(folder.join(name)).ok()?).ok()
    };
    let mut metadata = json(".zarray")?;
    let fill = metadata["fill_value"].as_bool()?;
    metadata["fill_value"] = Value::from(u8::from(fill));
    let metadata: ArrayMetadataV2 = serde_json::from_value(metadata).ok()?;
    let attributes = json(".zattrs").and_then(|attributes| attributes.as_object().cloned());
    Some(metadata.with_attributes(attributes.unwrap_or_default()).into())
}

/// Names of axes that an array has itself: `dimension_names` of version 3, or those that xarray writes.
fn named_by_array(array: &Array<FilesystemStore>) -> Option<Vec<NamedAxis>> {
    let metadata = serde_json::to_value(array.metadata()).ok()?;
    let of_xarray = array.attributes().get("_ARRAY_DIMENSIONS");
    NamedAxis::of(&metadata["dimension_names"]).or_else(|| NamedAxis::of(of_xarray?))
}

/// Names of axes in the pyramid of which an array is a level.
fn named_by_pyramid_of(level: &Path) -> Option<Vec<NamedAxis>> {
    let group = level.parent()?;
    let json = |name: &str| -> Option<Value> {
        serde_json::from_slice(&std::fs::read(group.join(name)).ok()?).ok()
    };
    let attributes =
        json(".zattrs").or_else(|| Some(json("zarr.json")?["attributes"]["ome"].clone()))?;
    let pyramid = &attributes["multiscales"][0];
    let name = level.file_name()?.to_str()?;
    let is_level = |dataset: &Value| {
        dataset["path"].as_str().is_some_and(|path| path.trim_matches('/') == name)
    };
    pyramid["datasets"].as_array()?.iter().any(is_level).then(|| NamedAxis::of(&pyramid["axes"]))?
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
        return Err(Reason::header(format!("names no array for level {wanted}")));
    };
    // An upward step would lead to files that nobody named.
    if Path::new(name).components().any(|part| part == Component::ParentDir) {
        return Err(Reason::header(format!(
            "names {name:?} for level {wanted}, outside the store"
        )));
    }
    Ok((dataset, name))
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

/// Scale and translation along x, y and z of the transformations of OME-Zarr, the first first.
fn placed(
    path: &Path,
    count: usize,
    axes: &Axes,
    transforms: &[&Value],
) -> Result<([f64; 3], [f64; 3]), VolumeError> {
    let (mut scale, mut origin) = ([1.0; 3], [0.0; 3]);
    for transform in transforms {
        let numbers = |name: &str, default: f64| -> Option<[f64; 3]> {
            let numbers: Vec<f64> =
                transform[name].as_array()?.iter().filter_map(Value::as_f64).collect();
            (numbers.len() == count).then(|| axes.of_space(&numbers, default))
        };
        let kind = transform["type"].as_str().unwrap_or_default();
        match (kind, numbers("scale", 1.0), numbers("translation", 0.0)) {
            ("scale", Some(by), _) => {
                (0..3).for_each(|k| (scale[k], origin[k]) = (scale[k] * by[k], origin[k] * by[k]));
            }
            ("translation", _, Some(by)) => (0..3).for_each(|k| origin[k] += by[k]),
            ("identity", ..) => {}
            _ => {
                let what = format!(
                    "is placed by {transform}, which is not read: only scale and translation of as \
                     many numbers as axes are"
                );
                return Err(format_error(path, Reason::unsupported(what, "convert it first")));
            }
        }
    }
    Ok((scale, origin))
}
