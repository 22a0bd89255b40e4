//! Places samples by the coordinates that xarray stores beside an array: arrays of one axis, each with the name of the axis.

use std::path::{Component, Path};
use std::sync::Arc;

use serde_json::Value;
use walpha_base::shown::shown;
use zarrs::array::Array;
use zarrs::array_subset::ArraySubset;
use zarrs::filesystem::FilesystemStore;

use super::axes::Axes;
use super::packing::Packing;
use super::samples::{check_chunk, check_stored};
use super::{is_array, open_array};
use crate::read::layout::{diagonal, frame as frame_of, one_unit, unit_named};
use crate::{Coordinates, Dims, Frame, VolumeError};

/// The largest deviation of coordinates from even spacing, as a share of the step. Others are not used.
const APART: f64 = 1e-3;

/// The frame for evenly spaced coordinates along x, y and z. Other coordinates are ignored, with a warning.
pub(super) fn frame(
    path: &Path,
    shape: &[u64],
    axes: &Axes,
    names: &Value,
) -> Result<Frame, VolumeError> {
    let (mut steps, mut origin, mut units) = ([1.0; 3], [0.0; 3], [None; 3]);
    let mut is_placed = false;
    let Ok(folder) = path.canonicalize() else { return Ok(Frame::VOXEL) };
    for k in 0..3 {
        let Some(axis) = axes.space[2 - k] else { continue };
        let Some(name) = names[axis].as_str() else { continue };
        let is_name = matches!(
            Path::new(name).components().collect::<Vec<_>>().as_slice(),
            [Component::Normal(_)]
        );
        let beside = folder.with_file_name(name);
        if !is_name || beside == folder || !is_array(&beside) {
            continue;
        }
        let Some((first, step, unit)) = even(&beside, shape[axis]) else {
            let path = shown(path);
            tracing::warn!(
                "{path}: the coordinates {name} beside it are passed over: they are not an evenly spaced row of numbers"
            );
            continue;
        };
        is_placed = true;
        (origin[k], steps[k]) = (first, step.unwrap_or(1.0));
        units[k] = unit.map(|name| unit_named(path, &name));
    }
    if !is_placed {
        return Ok(Frame::VOXEL);
    }
    let (unit, factors) = one_unit(path, units)?;
    let [steps, origin] = [steps, origin].map(|lengths| [0, 1, 2].map(|k| lengths[k] * factors[k]));
    frame_of(path, origin, diagonal(steps), Coordinates { unit, ..Coordinates::default() })
}

/// The first of evenly spaced coordinates, the step between them (`None` for a single one) and their unit.
fn even(folder: &Path, count: u64) -> Option<(f64, Option<f64>, Option<String>)> {
    let store = Arc::new(FilesystemStore::new(folder).ok()?);
    let array = open_array(folder, store, "/").ok()?;
    if array.shape() != [count] {
        return None;
    }
    let dims = Dims::new(count, 1, 1).ok()?;
    check_chunk(folder, &array.chunk_shape(&[0]).ok()?, dims).ok()?;
    check_stored(folder, dims).ok()?;
    let packing = Packing::of(folder, &array).ok()?;
    let mut all = vec![0.0; dims.samples()];
    numbers(&array, &mut all)?;
    all.iter_mut().for_each(|number| *number = packing.value(*number));
    let (first, last) = (*all.first()?, *all.last()?);
    let unit = array.attributes().get("units").and_then(Value::as_str).map(str::to_owned);
    if all.len() == 1 {
        return first.is_finite().then_some((first, None, unit));
    }
    let step = (last - first) / (count - 1) as f64;
    let is_even =
        |(i, place): (usize, &f64)| (place - first - i as f64 * step).abs() <= APART * step.abs();
    let all_even = step != 0.0 && step.is_finite() && all.iter().enumerate().all(is_even);
    all_even.then_some((first, Some(step), unit))
}

/// All numbers of an array of one axis, of any type.
fn numbers(array: &Array<FilesystemStore>, into: &mut [f64]) -> Option<()> {
    let all = ArraySubset::new_with_shape(array.shape().to_vec());
    macro_rules! of_type {
        ($number:ty, $convert:expr) => {
            if let Ok(numbers) = array.retrieve_array_subset_elements::<$number>(&all) {
                into.iter_mut().zip(numbers).for_each(|(into, number)| *into = $convert(number));
                return Some(());
            }
        };
    }
    of_type!(f64, f64::from);
    of_type!(f32, f64::from);
    of_type!(i64, |number: i64| number as f64);
    of_type!(i32, f64::from);
    of_type!(i16, f64::from);
    of_type!(u16, f64::from);
    of_type!(u8, f64::from);
    None
}
