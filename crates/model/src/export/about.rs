//! The description of a shape in the comments of files.

use walpha_base::shown::number;
use walpha_shape::AlphaShape;
use walpha_volume::annotation;

/// Describes a shape by its α, or a solid of labels or inside an isosurface by what it fills.
pub(super) fn about(shape: &AlphaShape) -> String {
    solid(shape).unwrap_or_else(|| annotation::alpha(shape.power_alpha()))
}

/// Describes a shape that is not an α-shape: the voxels that a solid of labels fills, or the value of its isosurface.
pub(super) fn solid(shape: &AlphaShape) -> Option<String> {
    let of_labels = shape.voxels().map(|voxels| of_labels(voxels.count()));
    let inside = |value| format!("the solid inside the isosurface at {}", number(value));
    of_labels.or_else(|| shape.isovalue().map(inside))
}

/// Describes the solid of labels by the number of voxels that it fills.
fn of_labels(voxels: u64) -> String {
    format!("the solid of labels, which fills {voxels} voxels")
}
