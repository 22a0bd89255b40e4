//! Finds the axes x, y and z of an array.

use std::path::Path;

use ndarray::{ArrayView1, ArrayView3};
use serde_json::Value;
use walpha_base::shown::shown;
use walpha_base::sort::sort_handful_by;
use zarrs::array_subset::ArraySubset;

use crate::error::format_error;
use crate::read::frames::FrameChoice;
use crate::{Dims, Reason, VolumeError};

/// An axis as the metadata describe it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct NamedAxis {
    name: String,
    /// The type, such as `space`; empty if it is not stated.
    kind: String,
}

impl NamedAxis {
    /// The axes in the metadata of OME-Zarr (names with types, or names alone), in `dimension_names` or `_ARRAY_DIMENSIONS`.
    pub(super) fn of(value: &Value) -> Option<Vec<Self>> {
        let text = |value: &Value| value.as_str().unwrap_or_default().to_lowercase();
        let axis = |value: &Value| match value {
            Value::Object(axis) => {
                let [name, kind] =
                    ["name", "type"].map(|key| axis.get(key).map(text).unwrap_or_default());
                Self { name, kind }
            }
            name => Self { name: text(name), kind: String::new() },
        };
        let axes: Vec<Self> = value.as_array()?.iter().map(axis).collect();
        axes.iter().any(|axis| !axis.name.is_empty()).then_some(axes)
    }

    /// Whether the axis counts volumes, as for times or channels.
    fn counts_volumes(&self) -> bool {
        matches!(self.kind.as_str(), "time" | "channel")
            || matches!(self.name.as_str(), "t" | "c" | "time" | "channel")
    }
}

/// The places of z, y and x among the axes of an array, and the volume that is read.
pub(super) struct Axes {
    /// The axis of each of z, y and x; `None` for one that does not exist and has one sample.
    pub space: [Option<usize>; 3],
    /// The index along each axis; meaningless for spatial axes.
    fixed: Vec<u64>,
    pub dims: Dims,
}

/// The names of the spatial axes of volumes.
const NAMES: [&str; 3] = ["z", "y", "x"];

impl Axes {
    /// Finds the axes by their names, if there are any; otherwise the last three are z, y and x.
    pub(super) fn find(
        path: &Path,
        shape: &[u64],
        named: Option<&[NamedAxis]>,
        frame: Option<u64>,
    ) -> Result<Self, VolumeError> {
        let fail = |reason: Reason| format_error(path, reason);
        let space = match named {
            Some(axes) if axes.len() != shape.len() => {
                let (count, axes) = (shape.len(), axes.len());
                return Err(fail(Reason::header(format!(
                    "names {axes} axes of an array of {count}"
                ))));
            }
            Some(axes) => by_name(path, axes)?,
            // A last axis of one sample behind three others is a channel.
            None if matches!(shape, [_, _, _, 1]) => [0, 1, 2].map(Some),
            None => match shape.len() {
                count @ 3.. => [count - 3, count - 2, count - 1].map(Some),
                _ => {
                    return Err(fail(Reason::unsupported(
                        format!("has the shape {shape:?}: a volume has three axes, z, y and x"),
                        "name the array of a volume",
                    )));
                }
            },
        };
        let is_of_space = |axis: &usize| space.contains(&Some(*axis));
        let beyond: Vec<usize> = (0..shape.len()).filter(|axis| !is_of_space(axis)).collect();
        let sizes: Vec<u64> = beyond.iter().map(|&axis| shape[axis]).collect();
        let mut left = FrameChoice::choose(path, &sizes, frame)?.index;
        let mut fixed = vec![0; shape.len()];
        for &axis in beyond.iter().rev() {
            (fixed[axis], left) = (left % shape[axis], left / shape[axis]);
        }
        let [z, y, x] = space.map(|axis| axis.map_or(1, |axis| shape[axis]));
        Ok(Self { space, fixed, dims: Dims::unbounded(x, y, z)? })
    }

    /// The part of the array with these ranges of z, y and x.
    pub(super) fn subset(&self, ranges: [std::ops::Range<u64>; 3]) -> ArraySubset {
        let mut all: Vec<_> = self.fixed.iter().map(|&index| index..index + 1).collect();
        for (axis, range) in self.space.iter().zip(ranges) {
            if let Some(axis) = *axis {
                all[axis] = range;
            }
        }
        ArraySubset::new_with_ranges(&all)
    }

    /// Passes on the elements of such a part, with these sizes along z, y and x: row by row along x, and slice after slice.
    pub(super) fn rows<T: Copy>(
        &self,
        part: &[T],
        sizes: [usize; 3],
        mut give: impl FnMut(usize, ArrayView1<T>),
    ) {
        let order = self.order();
        let mut back = [0; 3];
        order.iter().enumerate().for_each(|(place, &k)| back[k] = place);
        let view =
            ArrayView3::from_shape(order.map(|k| sizes[k]), part).expect("a part has its size");
        let rows = view.permuted_axes(back);
        for (i, row) in rows.rows().into_iter().enumerate() {
            give(i, row);
        }
    }

    /// z, y and x in the order of the array; missing axes come first. Not within `rows`, which is compiled for each type of elements.
    fn order(&self) -> [usize; 3] {
        let mut order = [0, 1, 2];
        sort_handful_by(&mut order, |&k, &l| self.space[k].cmp(&self.space[l]));
        order
    }

    /// The sizes along z, y and x of chunks of an array.
    pub(super) fn sizes(&self, chunk: &[std::num::NonZeroU64]) -> [u64; 3] {
        self.space.map(|axis| axis.map_or(1, |axis| chunk[axis].get()))
    }

    /// The numbers for x, y and z, from numbers for all axes.
    pub(super) fn of_space(&self, numbers: &[f64], default: f64) -> [f64; 3] {
        [2, 1, 0].map(|k| self.space[k].map_or(default, |axis| numbers[axis]))
    }
}

/// Finds the axes by name, in any order. An axis with another name takes a free place, the last axis first, with a warning.
fn by_name(path: &Path, axes: &[NamedAxis]) -> Result<[Option<usize>; 3], VolumeError> {
    let mut space = [None; 3];
    for (k, name) in NAMES.into_iter().enumerate() {
        let mut found = (0..axes.len()).filter(|&axis| axes[axis].name == name);
        space[k] = found.next();
        if found.next().is_some() {
            let what = format!("names two of its axes {name}");
            return Err(format_error(path, Reason::header(what)));
        }
    }
    let others: Vec<usize> = (0..axes.len())
        .filter(|axis| !space.contains(&Some(*axis)) && !axes[*axis].counts_volumes())
        .collect();
    let mut others = others.into_iter().rev();
    for (k, name) in NAMES.into_iter().enumerate().rev() {
        if space[k].is_none()
            && let Some(axis) = others.next()
        {
            space[k] = Some(axis);
            tracing::warn!(
                "{}: its axis {axis}, {:?}, is taken for {name}: axes that are not named come in the order z, y, x",
                shown(path),
                axes[axis].name
            );
        }
    }
    Ok(space)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn found(axes: Value, shape: &[u64]) -> Option<[Option<usize>; 3]> {
        let named = NamedAxis::of(&axes);
        Axes::find(Path::new("a"), shape, named.as_deref(), Some(0)).ok().map(|axes| axes.space)
    }

    #[test]
    fn axes_are_found_by_name_in_any_order() {
        let all = |z, y, x| Some([Some(z), Some(y), Some(x)]);
        assert_eq!(found(json!(["x", "y", "z"]), &[4, 3, 2]), all(2, 1, 0));
        assert_eq!(found(json!(["t", "c", "Z", "Y", "X"]), &[1, 1, 2, 3, 4]), all(2, 3, 4));
        assert_eq!(
            found(json!([{"name": "y"}, {"name": "x"}, {"name": "c"}]), &[3, 4, 2]),
            Some([None, Some(0), Some(1)])
        );
        assert_eq!(found(json!(["depth", "row", "column"]), &[2, 3, 4]), all(0, 1, 2));
        assert_eq!(found(json!(["x", "slice", "y"]), &[4, 2, 3]), all(1, 2, 0));
        assert_eq!(found(json!([null, null, null]), &[2, 3, 4]), all(0, 1, 2));
        assert_eq!(found(json!([]), &[2, 3, 4, 1]), all(0, 1, 2));
        assert_eq!(found(json!(["x", "y"]), &[2, 3, 4]), None);
        assert_eq!(found(json!(["x", "x", "y"]), &[2, 3, 4]), None);
        assert_eq!(found(json!([]), &[3, 4]), None);
    }

    #[test]
    fn elements_come_in_the_order_of_z_y_x() {
        let axes = Axes::find(
            Path::new("a"),
            &[2, 3, 4],
            NamedAxis::of(&json!(["x", "z", "y"])).as_deref(),
            None,
        )
        .unwrap();
        assert_eq!(axes.dims.xyz(), [2, 4, 3]);
        let part: Vec<u32> = (0..24).collect();
        let mut given = Vec::new();
        axes.rows(&part, axes.dims.shape(), |i, row| {
            given.extend(row.iter().map(|&element| (i, element)));
        });
        // Element (x, z, y) of the array is at 12 x + 4 z + y.
        let expected = (0..24).map(|i| (i as usize / 2, 12 * (i % 2) + 4 * (i / 8) + i / 2 % 4));
        assert_eq!(given, expected.collect::<Vec<(usize, u32)>>());
    }
}
