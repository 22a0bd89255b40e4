//! What a shape is, in the comments of files.

use walpha_shape::AlphaShape;
use walpha_volume::annotation;

/// α, or the voxels that the solid of labels fills.
pub(super) fn about(shape: &AlphaShape) -> String {
    match shape.voxels() {
        Some(voxels) => of_labels(voxels.count()),
        None => annotation::alpha(shape.power_alpha()),
    }
}

/// The solid of labels that fills so many voxels.
pub(super) fn of_labels(voxels: u64) -> String {
    format!("the solid of labels, which fills {voxels} voxels")
}
