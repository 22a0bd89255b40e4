//! The description of a shape in the comments of files.

use walpha_shape::AlphaShape;
use walpha_volume::annotation;

/// Describes a shape by its α, or by the number of voxels that the solid of labels fills.
pub(super) fn about(shape: &AlphaShape) -> String {
    match shape.voxels() {
        Some(voxels) => of_labels(voxels.count()),
        None => annotation::alpha(shape.power_alpha()),
    }
}

/// Describes the solid of labels by the number of voxels that it fills.
pub(super) fn of_labels(voxels: u64) -> String {
    format!("the solid of labels, which fills {voxels} voxels")
}
