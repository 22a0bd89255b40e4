use walpha_base::parallel::prelude::*;

use super::InterpolateError;
use walpha_points::{Units, WeightedPoints};
use walpha_shape::{Alpha, AlphaShape, ShapeOptions, alpha_shape};
use walpha_volume::Volume;

/// Computes the whole regular triangulation of a shape's points (α = ∞) and, given their volume, of its corner samples, too, so
/// that it covers every sample of the grid.
///
/// Corners that are not points yet are added with their gray level and the least weight of the points; a missing one takes the gray
/// level of the nearest sample, in steps of the grid, that is not. As corners they are never hidden, and as they are light they hide
/// little. Weights determine the vertices of the triangulation: a point hidden by heavier neighbours is not a vertex, and its value is
/// not used. With [`Balls::Radius`](walpha_shape::Balls::Radius) the weights are (α
/// + ω)² for the α of the shape.
///
/// # Errors
/// The points have no values; and the errors of [`alpha_shape`].
pub fn fill(
    shape: &AlphaShape,
    volume: Option<&Volume>,
    units: Units,
) -> Result<AlphaShape, InterpolateError> {
    let (mut positions, _, mut values) = shape.points().clone().into_parts();
    let mut weights = shape.power_weights().to_vec();
    if let Some(volume) = volume {
        let values = values.as_mut().ok_or(InterpolateError::NoValues)?;
        let missing = missing_corners(volume, units, &positions);
        let lightest = weights.iter().copied().reduce(f64::min).unwrap_or(0.0);
        weights.resize(weights.len() + missing.len(), lightest);
        for (position, value) in missing {
            positions.push(position);
            values.push(value);
        }
    }
    let columns = WeightedPoints::new(positions, weights);
    let columns = columns.and_then(|points| points.with_values(values));
    let Ok(points) = columns else { unreachable!("columns that grow together") };
    let ShapeOptions { engine, classifier, .. } = *shape.options();
    let options =
        ShapeOptions::new(Alpha::INFINITE).engine(engine).classifier(classifier).hidden(true);
    Ok(alpha_shape(points, &options)?)
}

/// The corner samples of a volume that are not among these positions, and their values.
fn missing_corners(volume: &Volume, units: Units, positions: &[[f64; 3]]) -> Vec<([f64; 3], f64)> {
    let corners = corners(volume).into_iter();
    let corners = corners.map(|voxel| (units.position(volume, voxel), known_value(volume, voxel)));
    corners.filter(|(corner, _)| !positions.contains(corner)).collect()
}

/// The value of a sample or, if it is missing, of the nearest that is not; of equally near ones, of the first.
fn known_value(volume: &Volume, voxel: u32) -> f64 {
    let samples = volume.as_slice();
    let voxel = voxel as usize;
    let [nx, ny, _] = volume.dims().xyz();
    if !volume.is_missing(voxel) {
        return samples[voxel].into();
    }
    let place = |i: usize| [i % nx, i / nx % ny, i / (nx * ny)];
    let from = place(voxel);
    let steps = |i: usize| -> u64 {
        place(i).iter().zip(from).map(|(a, b)| (a.abs_diff(b) as u64).pow(2)).sum()
    };
    let there = (0..samples.len()).into_par_iter().filter(|&i| !volume.is_missing(i));
    let nearest = there.min_by_key(|&i| (steps(i), i));
    samples[nearest.expect("not all samples are missing")].into()
}

/// The corner samples of a volume, ascending: 8, or fewer if an axis has one sample.
pub(super) fn corners(volume: &Volume) -> Vec<u32> {
    let [nx, ny, nz] = volume.dims().xyz();
    let mut corners = Vec::with_capacity(8);
    for z in [0, nz - 1] {
        for y in [0, ny - 1] {
            for x in [0, nx - 1] {
                corners.push((x + nx * (y + ny * z)) as u32);
            }
        }
    }
    corners.sort_unstable();
    corners.dedup();
    corners
}
