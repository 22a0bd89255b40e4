use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use rayon::prelude::*;

use super::fill::corners;
use super::raster::NOTHING;
use super::{Deviation, Grid, InterpolateError, Interpolant, Resampled};
use crate::points::{Units, WeightedPoints};
use crate::shape::{Alpha, ShapeOptions, alpha_shape};
use crate::volume::Volume;

/// When adaptive selection is done: as soon as either is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    /// Points at most.
    pub count: u64,
    /// An RMSE over the whole volume, in gray levels, that is good enough; 0 asks for all of
    /// `count`, or for a perfect interpolant.
    pub rmse: f64,
}

/// Points of a batch, over those there are: a batch is large enough for few triangulations, and
/// small enough that its points are chosen for what is there and not for each other.
const BATCH: f64 = 0.2;

/// Voxels whose triangulation interpolates a volume well, in the order in which they were chosen:
/// the first so many are what a smaller count would have chosen.
///
/// From the 8 corners on, greedily: the unweighted (ω = 0) Delaunay triangulation of the voxels so
/// far is resampled on the volume's grid; in each cell the voxel of the largest difference from the
/// volume is a candidate; of these the largest, ties by index, join, at most a fifth as many as
/// there are. Greedy insertion after Garland and Heckbert, "Fast polygonal approximation of terrains
/// and height fields" (CMU-CS-95-181, 1995), in batches and in space.
///
/// The difference is measured from `volume` itself, so give the original, not a truncated one. The
/// error is looked at between batches; the last may overshoot the target. Each batch costs one
/// triangulation and one pass over the volume: in all a few times the cost of the last. The same on
/// any number of threads.
///
/// # Errors
/// A count below 8 or above the samples, a target that is negative or NaN, or a volume whose
/// samples lie in one plane.
pub fn adaptive_voxels(
    volume: &Volume,
    goal: &Adaptive,
    units: Units,
) -> Result<Vec<u32>, InterpolateError> {
    let available = volume.dims().samples() as u64;
    let mut voxels = corners(volume);
    if goal.count < voxels.len().max(8) as u64 || goal.count > available {
        return Err(InterpolateError::Count { asked: goal.count, available });
    }
    if goal.rmse.is_nan() || goal.rmse < 0.0 {
        return Err(InterpolateError::Target(goal.rmse));
    }
    let grid = Grid::of(volume, units);
    loop {
        let points = points(volume, &voxels, units);
        let shape = alpha_shape(points, &ShapeOptions::new(Alpha::INFINITE))?;
        let interpolant = Interpolant::new(&shape)?;
        let resampled = interpolant.resample(&grid)?;
        let rmse = Deviation::of(volume, &resampled).rmse.unwrap_or(0.0);
        tracing::debug!(points = voxels.len(), rmse, "adaptive");
        let room = goal.count as usize - voxels.len();
        let mut worst = worst(volume, &resampled, interpolant.len());
        if rmse <= goal.rmse || worst.is_empty() || room == 0 {
            return Ok(voxels);
        }
        let batch = ((voxels.len() as f64 * BATCH).ceil() as usize).min(room);
        worst.truncate(batch);
        voxels.extend(worst);
        if voxels.len() as u64 == goal.count {
            return Ok(voxels);
        }
    }
}

fn points(volume: &Volume, voxels: &[u32], units: Units) -> WeightedPoints {
    let value = |&voxel: &u32| f64::from(volume.as_slice()[voxel as usize]);
    WeightedPoints {
        positions: voxels.iter().map(|&voxel| units.position(volume, voxel)).collect(),
        weights: vec![0.0; voxels.len()],
        values: Some(voxels.iter().map(value).collect()),
    }
}

/// The voxel of the largest difference in each simplex that has one with any, the largest first.
fn worst(volume: &Volume, resampled: &Resampled, parts: usize) -> Vec<u32> {
    // Doubles that are not negative are ordered as their bits are; single precision leaves room
    // for the voxel, and of equal ones the lowest is to win.
    let key = |difference: f32, voxel: u32| u64::from(difference.to_bits()) << 32 | u64::from(!voxel);
    let best: Vec<AtomicU64> = (0..parts).map(|_| AtomicU64::new(0)).collect();
    let pairs = volume.as_slice().par_iter().zip(resampled.volume().as_slice());
    pairs.zip(&resampled.owners).enumerate().for_each(|(voxel, ((f, g), &part))| {
        let difference = (f - g).abs();
        if part != NOTHING && difference > 0.0 {
            best[part as usize].fetch_max(key(difference, voxel as u32), Relaxed);
        }
    });
    let mut keys: Vec<u64> =
        best.into_iter().map(AtomicU64::into_inner).filter(|&key| key != 0).collect();
    keys.par_sort_unstable_by(|a, b| b.cmp(a));
    keys.into_iter().map(|key| !(key as u32)).collect()
}
