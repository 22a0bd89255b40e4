//! Zarr arrays, and their pyramids in the layout of OME-Zarr.

mod axes;
mod coordinates;
mod packing;
mod samples;

use std::path::{Component, Path};
use std::sync::Arc;

use serde_json::Value;
use walpha_base::Monitor;
use walpha_base::advice::{Setting, advice};
use walpha_base::shown::{counted, shown};
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
use packing::Packing;
use samples::{ZarrBoxes, check_chunk, check_stored, damaged, samples};

/// Reads a Zarr array of version 2 or 3 in a folder, or a level of an OME-Zarr pyramid (0, the finest, unless `level` says
/// otherwise).
///
/// Axes called x, y and z are the spatial ones, in any order; if no axis has a name, the last three are z, y and x. The others
/// count volumes, of which the one numbered `frame_index` is read. Scale and translation of a pyramid give the frame, or else
/// coordinates beside the array; CF attributes unpack its numbers. Takes memory for the samples and a few rows of chunks.
pub(crate) fn read(
    path: &Path,
    level: Option<u32>,
    frame_index: Option<u64>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let PlacedArray { array, axes, packing, frame } = open(path, level, frame_index)?;
    let (dims, dtype) = (axes.dims.bounded()?, packing.dtype());
    let samples = samples(path, &array, &axes, &packing, monitor)?;
    let (endian, encoding) = (Endian::Little, Encoding::Raw);
    let layout = Layout { dims, dtype, endian, frame, encoding, frames: FrameChoice::ONE };
    let volume = layout.volume(samples)?;
    if packing.states_missing() { mask(path, volume) } else { Ok(volume) }
}

/// Masks the samples that the attributes declare to be missing.
fn mask(path: &Path, volume: Volume) -> Result<Volume, VolumeError> {
    let missing: Vec<bool> = volume.as_slice().iter().map(|sample| sample.is_nan()).collect();
    let count = missing.iter().filter(|&&missing| missing).count();
    if count == 0 {
        return Ok(volume);
    }
    tracing::warn!(
        "{}: {} without a value (_FillValue, missing_value) masked",
        shown(path),
        counted(count as u64, "sample")
    );
    volume.with_padding(missing).ok_or_else(|| {
        let what = "has no samples with a value (_FillValue, missing_value)";
        format_error(path, Reason::content(what, "name another array"))
    })
}

/// Like [`read`], for a volume that is read part by part.
pub(crate) fn source(
    path: &Path,
    level: Option<u32>,
    frame_index: Option<u64>,
) -> Result<Source, VolumeError> {
    let PlacedArray { array, axes, packing, frame } = open(path, level, frame_index)?;
    let (dtype, dims) = (packing.dtype(), axes.dims);
    let chunk = array.chunk_shape(&vec![0; array.dimensionality()]);
    let chunk = chunk.map_err(|error| damaged(path, &error))?;
    let [z, y, x] = axes.sizes(&chunk).map(|size| size as usize);
    check_chunk(path, &chunk, dims)?;
    check_stored(path, dims)?;
    let parts = ZarrBoxes { path: path.into(), array, axes, packing };
    Ok(Source::new(dims, frame, dtype, [x, y, z], Box::new(parts)))
}

/// An array of a store, and the place of the volume in it.
struct PlacedArray {
    array: Array<FilesystemStore>,
    axes: Axes,
    packing: Packing,
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
        let pyramid = pyramid_of(path);
        return place(path, array, pyramid.as_ref().map(|(all, level)| (all, level)), frame_index);
    }
    let group = Group::open(Arc::clone(&store), "/").map_err(|error| unreadable(&error))?;
    let attributes = Value::Object(group.attributes().clone());
    let pyramids = pyramids(&attributes);
    let Some(pyramid) = pyramids.first() else {
        return Err(fail(Reason::unsupported(
            format!("is a Zarr group without the levels of OME-Zarr, of {}", children(path)),
            "name one of these",
        )));
    };
    let (dataset, name) = dataset(pyramid, level).map_err(fail)?;
    let array = open_array(path, store, &format!("/{}", name.trim_matches('/')))?;
    if pyramids.len() > 1 {
        let count = pyramids.len();
        tracing::warn!("{}: of its {count} images (multiscales) the first is read", shown(path));
    }
    place(path, array, Some((pyramid, dataset)), frame_index)
}

/// Finds the volume in an array, which may be a level of a pyramid.
fn place(
    path: &Path,
    array: Array<FilesystemStore>,
    level: Option<(&Value, &Value)>,
    frame_index: Option<u64>,
) -> Result<PlacedArray, VolumeError> {
    let named = level.and_then(|(pyramid, _)| NamedAxis::of(&pyramid["axes"]));
    let named = named.or_else(|| names(&array).and_then(|names| NamedAxis::of(&names)));
    let axes = Axes::find(path, array.shape(), named.as_deref(), frame_index)?;
    let packing = Packing::of(path, &array)?;
    let frame = match level {
        Some((pyramid, dataset)) => frame_of(path, array.shape().len(), &axes, pyramid, dataset)?,
        None => coordinates::frame(path, array.shape(), &axes, &names(&array).unwrap_or_default())?,
    };
    Ok(PlacedArray { array, axes, packing, frame })
}

/// The place of the samples of a pyramid's level, given the array's number of axes.
fn frame_of(
    path: &Path,
    count: usize,
    axes: &Axes,
    pyramid: &Value,
    dataset: &Value,
) -> Result<Frame, VolumeError> {
    let transforms = [&dataset["coordinateTransformations"], &pyramid["coordinateTransformations"]];
    let transforms: Vec<&Value> =
        transforms.into_iter().filter_map(Value::as_array).flatten().collect();
    let unit =
        |axis: usize| pyramid["axes"][axis]["unit"].as_str().map(|name| unit_named(path, name));
    let [z, y, x] = axes.space.map(|axis| axis.and_then(unit));
    let (unit, factors) = one_unit(path, [x, y, z])?;
    let (scale, origin) = placed(path, count, axes, &transforms)?;
    let [scale, origin] = [scale, origin].map(|lengths| [0, 1, 2].map(|k| lengths[k] * factors[k]));
    let coordinates = Coordinates { unit, ..Coordinates::default() };
    frame(path, origin, diagonal(scale), coordinates)
}

/// Opens an array. Its storage may use features that are not supported.
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

/// The metadata of an array of version 2 whose fill value is true or false, replaced by 1 or 0.
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

/// The names of axes in the array's own metadata: `dimension_names` of version 3, or those that xarray writes.
fn names(array: &Array<FilesystemStore>) -> Option<Value> {
    match array.metadata() {
        ArrayMetadata::V3(metadata) if metadata.dimension_names.is_some() => {
            serde_json::to_value(&metadata.dimension_names).ok()
        }
        _ => array.attributes().get("_ARRAY_DIMENSIONS").cloned(),
    }
}

/// The pyramids that the attributes of a group state.
fn pyramids(attributes: &Value) -> &[Value] {
    let places = ["/ome/multiscales", "/multiscales"];
    let found = places.iter().find_map(|at| attributes.pointer(at)?.as_array());
    found.map_or(&[], Vec::as_slice)
}

/// The pyramid of which an array is a level, and its entry for that level.
fn pyramid_of(level: &Path) -> Option<(Value, Value)> {
    let level = level.canonicalize().ok()?;
    level.ancestors().skip(1).find_map(|group| {
        let name = level.strip_prefix(group).ok()?;
        let json = |name: &str| -> Option<Value> {
            serde_json::from_slice(&std::fs::read(group.join(name)).ok()?).ok()
        };
        let attributes =
            json(".zattrs").or_else(|| Some(json("zarr.json")?["attributes"].take()))?;
        pyramids(&attributes).iter().find_map(|pyramid| {
            let is_it = |dataset: &&Value| {
                dataset["path"]
                    .as_str()
                    .is_some_and(|path| Path::new(path.trim_matches('/')) == name)
            };
            let dataset = pyramid["datasets"].as_array()?.iter().find(is_it)?;
            Some((pyramid.clone(), dataset.clone()))
        })
    })
}

/// A level of a pyramid, and the path of its array.
fn dataset(pyramid: &Value, level: Option<u32>) -> Result<(&Value, &str), Reason> {
    let levels = pyramid["datasets"].as_array().map_or(&[][..], Vec::as_slice);
    let wanted = level.unwrap_or(0);
    let Some(dataset) = levels.get(wanted as usize) else {
        let count = levels.len();
        return Err(Reason::choice(
            Setting::Level,
            format!("has no level {wanted}: there are {count}"),
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
    // `..` would lead to files that the user did not name.
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

/// The stores inside a store, for a message.
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

/// The scale and translation along x, y and z of OME-Zarr's transformations, applied in their order.
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
