use std::collections::HashSet;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use rayon::prelude::*;
use walpha_base::Monitor;
use walpha_base::setters;

use super::fill::corners;
use super::grid::OUTSIDE;
use super::sampled::Sampled;
use super::{Deviation, InterpolateError};
use walpha_points::Units;
use walpha_volume::{Dims, Volume};

/// When adaptive selection is done: as soon as one of these is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Adaptive {
    /// Points at most.
    pub count: u64,
    /// An RMSE over the whole volume, in gray levels, that is good enough; 0 asks for all of
    /// `count`, or for a perfect interpolant.
    pub rmse: f64,
    /// A bound on the largest error of a sample, in gray levels. With one, points are chosen by that
    /// error, and only samples beyond the bound join.
    pub max_error: Option<f64>,
}

impl Adaptive {
    /// Selects `count` points, whatever the error.
    pub fn new(count: u64) -> Self {
        Self { count, rmse: 0.0, max_error: None }
    }

    setters! { rmse: f64, max_error: Option<f64> }
}

/// Points of a batch, over those there are: a batch is large enough for few triangulations, and
/// small enough that its points are chosen for what is there and not for each other.
const BATCH: f64 = 0.2;
/// Samples looked at as one piece of work.
const CHUNK: usize = 1 << 14;
/// While there are few points, batches are of this size.
const FIRST_BATCH: usize = 32;

/// Voxels whose triangulation interpolates a volume well, in the order in which they were chosen:
/// the first so many are what a smaller count would have chosen.
///
/// From the 8 corners on, greedily, after Garland and Heckbert, "Fast polygonal approximation of
/// terrains and height fields" (CMU-CS-95-181, 1995), in space and in batches:
///
/// 1. the unweighted (ω = 0) Delaunay triangulation of the voxels so far is resampled on the grid;
/// 2. cells are put in order of the squared error summed over their voxels, and each names its
///    worst voxel;
/// 3. in that order these join, but none beside one that has just joined (among its 26 neighbours),
///    because it would repair the same error; at most a fifth as many as there are.
///
/// With a bound on the largest error, cells are put in order of their largest error instead, and voxels
/// within the bound do not join.
///
/// Error is measured from `volume` itself, so give the original, not a truncated one. It is looked
/// at between batches: when that ends the selection, the last batch may have overshot the target.
/// Fewer voxels than asked for suffice where their interpolant is perfect. A batch costs its
/// insertions, samples in the cells that these make (in all cells, where doubles do not hold the frame), and one
/// pass over all errors; memory, 16 bytes a sample. The result does not depend on the number of threads.
///
/// # Errors
/// A count below 8 or above the samples, a target or bound that is negative or NaN, missing samples, or
/// a volume whose samples lie in one plane.
pub fn adaptive_voxels(
    volume: &Volume,
    goal: &Adaptive,
    units: Units,
) -> Result<Vec<u32>, InterpolateError> {
    let monitor = &*Monitor::current();
    let available = volume.dims().samples() as u64;
    let mut voxels = corners(volume);
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

/// The worst voxel of each simplex, in order of the squared error of its whole simplex, the
/// largest first, of those that may join. Voxels without error may not. `max` is the largest error.
/// With a bound: those beyond it, in order of their own errors.
pub(super) fn worst(
    volume: &Volume,
    sampled: &Sampled<'_>,
    max: f64,
    bound: Option<f64>,
    may_join: impl Fn(u32) -> bool + Sync,
) -> Vec<u32> {
    // Sums of integers do not depend on their order: squares in units of max²/2³¹, of which 2³²
    // samples make less than 2⁶⁴.
    let units = |error: f64| ((error / max).powi(2) * 2f64.powi(31)) as u64;
    // Floats that are not negative are ordered as their bits are; of equal ones the lowest voxel.
    let key = |error: f32, voxel: u32| u64::from(error.to_bits()) << 32 | u64::from(!voxel);
    let zeros = || (0..sampled.cells()).map(|_| AtomicU64::new(0)).collect::<Vec<_>>();
    let (sums, worst) = (zeros(), zeros());
    let pairs = volume.as_slice().par_chunks(CHUNK).zip(sampled.f().par_chunks(CHUNK));
    let chunks = pairs.zip(sampled.owners().par_chunks(CHUNK)).enumerate();
    chunks.for_each(|(chunk, ((theirs, ours), owners))| {
        // Samples side by side are often in one cell: these are written together.
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

/// The first `most` of some voxels, without those adjacent to an earlier one.
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
