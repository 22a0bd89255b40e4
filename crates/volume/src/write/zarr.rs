use std::path::Path;
use std::sync::Arc;

use serde_json::json;
use walpha_base::Monitor;
use walpha_base::parallel::prelude::*;
use walpha_base::shown::shown;
use walpha_files::make_folder;
use zarrs::array::codec::ZstdCodec;
use zarrs::array::{Array, ArrayBuilder, DataType, Element, FillValue};
use zarrs::array_subset::ArraySubset;
use zarrs::filesystem::FilesystemStore;
use zarrs::group::GroupBuilder;

use crate::{Dtype, Frame, LengthUnit, Source, VolumeError};

/// The number of samples along an edge of a chunk.
const CHUNK: usize = 64;

/// Writes a volume as OME-Zarr (version 0.5, of Zarr 3) with one level, in chunks of 64³ samples compressed by zstd. If nothing
/// is known about the grid, it writes an array without a group.
///
/// It reads and writes one row of chunks per thread at a time. Bytes and 16-bit integers keep their
/// type, other samples become `f32`. Spacing, origin and unit are kept; directions are not, as
/// OME-Zarr has no place for them.
///
/// # Errors
/// `folder` exists already or cannot be created, or the volume cannot be read. Nothing is left behind then.
pub(crate) fn zarr(source: &Source, folder: &Path, monitor: &Monitor) -> Result<(), VolumeError> {
    let failed = |source| VolumeError::Written { path: folder.into(), source };
    if source.frame().direction != Frame::VOXEL.direction {
        let lost = if source.frame().is_mirrored() {
            "so that the volume becomes its mirror image"
        } else {
            "so that the volume is turned"
        };
        tracing::warn!(
            "{}: OME-Zarr holds no directions of axes, and those of the volume are lost, {lost}",
            shown(folder)
        );
    }
    make_folder(folder, failed, |part| fill(source, part, monitor))
}

fn fill(source: &Source, folder: &Path, monitor: &Monitor) -> Result<(), VolumeError> {
    let failed = |error: &dyn std::fmt::Display| VolumeError::Written {
        path: folder.into(),
        source: std::io::Error::other(error.to_string()),
    };
    let store = Arc::new(FilesystemStore::new(folder).map_err(|error| failed(&error))?);
    let is_alone = source.frame().coordinates.unit == LengthUnit::Voxel;
    if !is_alone {
        let attributes = ome(source.frame()).as_object().cloned().unwrap_or_default();
        let group = GroupBuilder::new().attributes(attributes).build(Arc::clone(&store), "/");
        group.map_err(|error| failed(&error))?.store_metadata().map_err(|error| failed(&error))?;
    }
    let (data_type, fill) = match source.dtype() {
        Dtype::U8 => (DataType::UInt8, FillValue::from(0u8)),
        Dtype::I8 => (DataType::Int8, FillValue::from(0i8)),
        Dtype::U16 => (DataType::UInt16, FillValue::from(0u16)),
        Dtype::I16 => (DataType::Int16, FillValue::from(0i16)),
        _ => (DataType::Float32, FillValue::from(0f32)),
    };
    let sizes = source.dims().xyz();
    let shape = [2, 1, 0].map(|k| sizes[k] as u64).to_vec();
    let chunks = [2, 1, 0].map(|k| sizes[k].min(CHUNK) as u64).to_vec();
    let array = ArrayBuilder::new(shape, chunks, data_type, fill)
        .bytes_to_bytes_codecs(vec![Arc::new(ZstdCodec::new(1, false))])
        .build(store, if is_alone { "/" } else { "/0" })
        .map_err(|error| failed(&error))?;
    array.store_metadata().map_err(|error| failed(&error))?;
    let [nx, ny, nz] = sizes;
    let starts = |n: usize| (0..n).step_by(CHUNK);
    let rows: Vec<[usize; 2]> = starts(nz).flat_map(|z| starts(ny).map(move |y| [y, z])).collect();
    let mut done = 0;
    for batch in rows.chunks(rayon::current_num_threads()) {
        batch.par_iter().try_for_each(|&[y, z]| {
            let size = [nx, CHUNK.min(ny - y), CHUNK.min(nz - z)];
            let samples = source.read([0, y, z], size)?;
            let first = [z as u64, y as u64, 0];
            let shape = [2, 1, 0].map(|k| size[k] as u64);
            let at = ArraySubset::new_with_start_shape(first.to_vec(), shape.to_vec())
                .map_err(|error| failed(&error))?;
            store_part(&array, &at, source.dtype(), &samples).map_err(|error| failed(&error))
        })?;
        done += batch.len();
        monitor.report(done as u64, rows.len() as u64)?;
    }
    Ok(())
}

/// Stores samples in the type of the array, which holds them exactly.
fn store_part(
    array: &Array<FilesystemStore>,
    at: &ArraySubset,
    dtype: Dtype,
    samples: &[f32],
) -> Result<(), zarrs::array::ArrayError> {
    fn store<T: Element>(
        array: &Array<FilesystemStore>,
        at: &ArraySubset,
        samples: impl Iterator<Item = T>,
    ) -> Result<(), zarrs::array::ArrayError> {
        array.store_array_subset_elements(at, &samples.collect::<Vec<T>>())
    }
    let samples = samples.iter().copied();
    match dtype {
        Dtype::U8 => store(array, at, samples.map(|v| v as u8)),
        Dtype::I8 => store(array, at, samples.map(|v| v as i8)),
        Dtype::U16 => store(array, at, samples.map(|v| v as u16)),
        Dtype::I16 => store(array, at, samples.map(|v| v as i16)),
        _ => store(array, at, samples),
    }
}

/// The metadata of a pyramid with one level.
fn ome(frame: &Frame) -> serde_json::Value {
    let Frame { spacing: [sx, sy, sz], origin: [ox, oy, oz], coordinates, .. } = frame;
    let unit = match coordinates.unit {
        LengthUnit::Voxel | LengthUnit::Unstated => None,
        LengthUnit::Metre => Some("meter"),
        LengthUnit::Centimetre => Some("centimeter"),
        LengthUnit::Millimetre => Some("millimeter"),
        LengthUnit::Micrometre => Some("micrometer"),
        LengthUnit::Nanometre => Some("nanometer"),
        LengthUnit::Angstrom => Some("angstrom"),
        LengthUnit::Foot | LengthUnit::SurveyFoot => Some("foot"),
    };
    let axis = |name: &str| match unit {
        Some(unit) => json!({"name": name, "type": "space", "unit": unit}),
        None => json!({"name": name, "type": "space"}),
    };
    json!({"ome": {"version": "0.5", "multiscales": [{
        "axes": [axis("z"), axis("y"), axis("x")],
        "datasets": [{"path": "0", "coordinateTransformations": [
            {"type": "scale", "scale": [sz, sy, sx]},
            {"type": "translation", "translation": [oz, oy, ox]}
        ]}]
    }]}})
}
