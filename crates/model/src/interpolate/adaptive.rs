use std::collections::HashSet;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use walpha_base::Monitor;
use walpha_base::parallel::prelude::*;
use walpha_base::setters;

use super::fill::corners;
use super::grid::OUTSIDE;
use super::sampled::Sampled;
use super::{Deviation, InterpolateError};
use walpha_points::Units;
use walpha_volume::{Dims, Volume};

/// The goals of adaptive selection, which ends as soon as one of them is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Adaptive {
    /// The largest number of points.
    pub count: u64,
    /// A sufficient RMSE over the whole volume, in gray levels; 0 requests all of `count`, or a perfect interpolant.
    pub rmse: f64,
    /// A bound on the largest error of a sample, in gray levels. With a bound, points are chosen by that error, and only samples
    /// beyond the bound are added.
    pub max_error: Option<f64>,
}

impl Adaptive {
    /// Selects `count` points, whatever the error.
    pub fn new(count: u64) -> Self {
        Self { count, rmse: 0.0, max_error: None }
    }

    setters! { rmse: f64, max_error: Option<f64> }
}

/// The size of a batch as a share of the existing points. It is large enough for few triangulations, and small enough that points
/// are chosen for the existing triangulation and not for each other.
const BATCH: f64 = 0.2;
/// The number of samples in one parallel task.
const CHUNK: usize = 1 << 14;
/// The size of batches while there are few points.
const FIRST_BATCH: usize = 32;

/// Selects voxels whose triangulation interpolates a volume well, in the order in which they were chosen: the first k are those
/// that a count of k would have chosen.
///
/// The selection starts from the 8 corners and is greedy, after Garland and Heckbert, "Fast polygonal approximation of terrains
/// and height fields" (CMU-CS-95-181, 1995), in space and in batches:
///
/// 1. the unweighted (ω = 0) Delaunay triangulation of the voxels so far is resampled on the grid;
/// 2. cells are sorted by the squared error summed over their voxels, and each proposes its worst voxel;
/// 3. in that order these voxels are added, except those that are among the 26 neighbours of a voxel just added, which would
///    correct the same error; at most a fifth of the number of existing points.
///
/// With a bound on the largest error, cells are sorted by their largest error instead, and voxels within the bound are not added.
///
/// Error is measured from `volume` itself, so pass the original and not a truncated one. It is measured between batches: the last
/// batch may overshoot the goal. Fewer voxels than requested are selected if their interpolant is perfect. A batch costs its
/// insertions, the samples in the new cells (in all cells, if doubles do not represent the frame exactly), and one pass over all
/// errors; memory is 16 bytes a sample. The result does not depend on the number of threads.
///
/// # Errors
/// An axis has one sample, the count is below 8 or above the number of samples, a goal or bound is negative or NaN, samples are missing,
/// or the samples of the volume lie in one plane.
pub fn adaptive_voxels(
    volume: &Volume,
    goal: &Adaptive,
    units: Units,
) -> Result<Vec<u32>, InterpolateError> {
    let monitor = &*Monitor::current();
    let available = volume.dims().samples() as u64;
    let mut voxels = corners(volume);
    let dims = volume.dims().xyz();
    if dims.contains(&1) {
        return Err(InterpolateError::Thin { dims });
    }
    if goal.count < voxels.len().max(8) as u64 || goal.count > available {
        return Err(InterpolateError::Count { asked: goal.count, available });
    }
    if volume.has_missing() {
        return Err(InterpolateError::Missing);
    }
    for (what, target) in [("an RMSE", Some(goal.rmse)), ("a largest error", goal.max_error)] {
        if let Some(target) = target.filter(|target| target.is_nan() || *target < 0.0) {
            return Err(InterpolateError::Target { what, target });
        }
    }
    let mut sampled = Sampled::new(volume, units, &voxels)?;
    loop {
        let Deviation { rmse: Some(rmse), max: Some(max), .. } = sampled.deviation() else {
            return Ok(voxels);
        };
        tracing::debug!(points = voxels.len(), rmse, "adaptive");
        monitor.report(voxels.len() as u64, goal.count)?;
        let remaining = goal.count as usize - voxels.len();
        let batch = ((voxels.len() as f64 * BATCH).ceil() as usize).max(FIRST_BATCH).min(remaining);
        let within = goal.max_error.is_some_and(|bound| max <= bound);
        if rmse <= goal.rmse || within || batch == 0 {
            return Ok(voxels);
        }
        let candidates = worst(volume, &sampled, max, goal.max_error, |_| true);
        let joining = spaced(volume.dims(), candidates, batch);
        voxels.extend(&joining);
        if joining.is_empty() || voxels.len() as u64 == goal.count {
            return Ok(voxels);
        }
        sampled.add(&joining)?;
    }
}

/// The worst voxel of each simplex, sorted by the squared error of the whole simplex, the largest first. Voxels without error are
/// left out. `max` is the largest error. With a bound, only voxels beyond it are returned, sorted by their own errors.
pub(super) fn worst(
    volume: &Volume,
    sampled: &Sampled<'_>,
    max: f64,
    bound: Option<f64>,
    may_join: impl Fn(u32) -> bool + Sync,
) -> Vec<u32> {
    // Sums of integers do not depend on their order. The unit of squares is max²/2³¹, so that those of 2³² samples sum to less
    // than 2⁶⁴.
    let units = |error: f64| ((error / max).powi(2) * 2f64.powi(31)) as u64;
    // Nonnegative floats are ordered like their bits; of equal ones, the lowest voxel comes first.
    let key = |error: f32, voxel: u32| u64::from(error.to_bits()) << 32 | u64::from(!voxel);
    let zeros = || (0..sampled.cells()).map(|_| AtomicU64::new(0)).collect::<Vec<_>>();
    let (sums, worst) = (zeros(), zeros());
    let pairs = volume.as_slice().par_chunks(CHUNK).zip(sampled.f().par_chunks(CHUNK));
    let chunks = pairs.zip(sampled.owners().par_chunks(CHUNK)).enumerate();
    chunks.for_each(|(chunk, ((theirs, ours), owners))| {
        // Consecutive samples are often in one cell, and are written together.
        let write = |owner: u32, sum: u64, most: u64| {
            if owner != OUTSIDE {
                sums[owner as usize].fetch_add(sum, Relaxed);
                worst[owner as usize].fetch_max(most, Relaxed);
            }
        };
        let (mut last, mut sum, mut most) = (OUTSIDE, 0, 0);
        for (i, ((f, g), &owner)) in theirs.iter().zip(ours).zip(owners).enumerate() {
            let (error, voxel) = ((f - g).abs(), (chunk * CHUNK + i) as u32);
            if owner == OUTSIDE || error == 0.0 {
                continue;
            }
            if owner != last {
                write(last, sum, most);
                (last, sum, most) = (owner, 0, 0);
            }
            if bound.is_none() {
                sum += units(error.into());
            }
            if bound.is_none_or(|bound| f64::from(error) > bound) && may_join(voxel) {
                most = most.max(key(error, voxel));
            }
        }
        write(last, sum, most);
    });
    let pairs = sums.into_iter().zip(worst).map(|(s, w)| (s.into_inner(), w.into_inner()));
    let mut ranked: Vec<(u64, u64)> = pairs.filter(|&(_, worst)| worst != 0).collect();
    ranked.par_sort_unstable_by(|a, b| b.cmp(a));
    ranked.into_iter().map(|(_, key)| !(key as u32)).collect()
}

/// The first `most` voxels, without those adjacent to an earlier one.
fn spaced(dims: Dims, voxels: Vec<u32>, most: usize) -> Vec<u32> {
    let [nx, ny, nz] = dims.xyz();
    let mut near = HashSet::new();
    let mut spaced = Vec::with_capacity(most);
    for voxel in voxels {
        if spaced.len() == most {
            break;
        }
        if near.contains(&voxel) {
            continue;
        }
        spaced.push(voxel);
        let index = voxel as usize;
        let neighbours = |i: usize, n: usize| i.saturating_sub(1)..(i + 2).min(n);
        for z in neighbours(index / (nx * ny), nz) {
            for y in neighbours(index / nx % ny, ny) {
                near.extend(neighbours(index % nx, nx).map(|x| (x + nx * (y + ny * z)) as u32));
            }
        }
    }
    spaced
}
