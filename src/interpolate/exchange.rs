use std::collections::HashSet;

use rayon::prelude::*;
use walpha_base::Monitor;
use walpha_regular::Growing;

use super::InterpolateError;
use super::adaptive::worst;
use super::fill::corners;
use super::sampled::Sampled;
use super::trial::{Gain, Loss, Trial};
use crate::points::Units;
use crate::shape::ShapeError;
use crate::volume::Volume;

/// Points exchanged in one round, at most, over those there are. Halved where a round gains nothing.
const MOST: f64 = 0.1;
/// Samples tried as new points in one round, over the points there are.
const TRIED: f64 = 0.5;
/// Rounds at most. Each lowers the RMSE by less than the one before it.
const ROUNDS: u64 = 16;
/// A round that lowers the RMSE by less than this share is the last.
const LEAST: f64 = 2e-3;

/// As many samples whose triangulation represents the volume better: points whose loss costs least
/// are exchanged for samples that gain most, until a round gains next to nothing.
///
/// Error is that of fitted values ([`refit`](super::refit())) on the unweighted triangulation, over all
/// samples. In each round
///
/// 1. the loss of each point is the squared error that its removal would add with the other values
///    as they are, and the gain of the worst sample of each cell, of those where error is largest, is
///    what it would take away with the value that is best there: both by local retriangulation;
/// 2. the greatest gain is paired with the least loss, the next with the next, as long as the gain is
///    greater; points near others of the round wait;
/// 3. values are fitted. If the error is not smaller, the round is taken back and the next one is
///    half as large.
///
/// The corners of the volume stay. `voxels` are samples of the volume, its corners among them, in any
/// order; those that were never exchanged come first in the result, in that order. The same on any number
/// of threads. For n points a round takes about n removals and n/2 insertions, each of a few dozen cells.
///
/// # Errors
/// Missing samples; samples that span no volume; no memory.
pub fn exchange(
    volume: &Volume,
    voxels: &[u32],
    units: Units,
) -> Result<Vec<u32>, InterpolateError> {
    exchange_monitored(volume, voxels, units, &Monitor::noop())
}

/// The same, which says how far it is and can be cancelled.
///
/// # Errors
/// Those of [`exchange`], and [`InterpolateError::Cancelled`].
pub fn exchange_monitored(
    volume: &Volume,
    voxels: &[u32],
    units: Units,
    monitor: &Monitor,
) -> Result<Vec<u32>, InterpolateError> {
    if volume.has_missing() {
        return Err(InterpolateError::Missing);
    }
    let fitted = |voxels: &[u32]| -> Result<Sampled<'_>, InterpolateError> {
        let mut sampled = Sampled::new(volume, units, voxels)?;
        sampled.refit(&monitor.unreported())?;
        Ok(sampled)
    };
    let mut sampled = fitted(voxels)?;
    let mut best = voxels.to_vec();
    let mut rmse = sampled.deviation().rmse.unwrap_or(0.0);
    let mut share = MOST;
    for round in 0..ROUNDS {
        monitor.report(round, ROUNDS)?;
        let most = (share * best.len() as f64) as usize;
        let swap = choose(volume, &mut sampled, most)?;
        if swap.leave.is_empty() {
            break;
        }
        sampled.change(&swap.leave, &swap.join)?;
        sampled.refit(&monitor.unreported())?;
        let now = sampled.deviation().rmse.unwrap_or(0.0);
        tracing::debug!(round, exchanged = swap.leave.len(), rmse = now, "exchange");
        if now < rmse {
            best = sampled.vertices().iter().map(|&v| sampled.voxels()[v as usize]).collect();
            let gained = 1.0 - now / rmse;
            rmse = now;
            if gained < LEAST {
                break;
            }
        } else {
            share /= 2.0;
            sampled = fitted(&best)?;
        }
    }
    Ok(best)
}

/// What one round exchanges, by numbers of points.
struct Swap {
    leave: Vec<u32>,
    join: Vec<u32>,
}

/// Pairs the greatest gains with the least losses.
fn choose(
    volume: &Volume,
    sampled: &mut Sampled<'_>,
    most: usize,
) -> Result<Swap, InterpolateError> {
    let vertices = sampled.vertices();
    let taken: HashSet<u32> = vertices.iter().map(|&v| sampled.voxels()[v as usize]).collect();
    let max = sampled.deviation().max.unwrap_or(0.0);
    let mut tried = worst(volume, sampled, max, None, |sample| !taken.contains(&sample));
    tried.truncate((TRIED * vertices.len() as f64) as usize);
    let named: Vec<u32> = sampled.name(&tried).collect();
    let corners = corners(volume);
    let may_leave = |&&v: &&u32| corners.binary_search(&sampled.voxels()[v as usize]).is_err();
    let may_leave: Vec<u32> = vertices.iter().filter(may_leave).copied().collect();

    let predicates = sampled.growing().predicates();
    let screen = Growing::screen(&predicates).map_err(ShapeError::from)?;
    let trial = Trial::new(volume, sampled, &screen)?;
    let mut gains: Vec<Gain> = named.par_iter().filter_map(|&v| trial.gain(v)).collect();
    let losses: Result<Vec<Option<Loss>>, ShapeError> = (may_leave.par_iter())
        .map_init(|| trial.workspace(), |workspace, &v| trial.loss(v, workspace))
        .collect();
    let mut losses: Vec<Loss> = losses?.into_iter().flatten().collect();
    gains.par_sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.point.cmp(&b.point)));
    losses.par_sort_unstable_by(|a, b| a.loss.total_cmp(&b.loss).then(a.point.cmp(&b.point)));
    Ok(pair(&gains, &losses, most))
}

/// The greatest gain and the least loss, the next ones, and so on. No cell goes for two new points, and
/// no point leaves beside a new point or another that leaves.
fn pair(gains: &[Gain], losses: &[Loss], most: usize) -> Swap {
    let mut swap = Swap { leave: Vec::new(), join: Vec::new() };
    let (mut cells, mut stay) = (HashSet::<u32>::new(), HashSet::<u32>::new());
    let mut leave = HashSet::<u32>::new();
    let mut losses = losses.iter();
    for gain in gains {
        if swap.join.len() == most {
            break;
        }
        let apart = gain.removed.iter().all(|cell| !cells.contains(cell));
        if !apart || gain.around.iter().any(|v| leave.contains(v)) {
            continue;
        }
        let here: HashSet<u32> = gain.around.iter().copied().collect();
        let free = |loss: &&Loss| !stay.contains(&loss.point) && !here.contains(&loss.point);
        let Some(loss) = losses.find(free).filter(|loss| loss.loss < gain.gain) else { break };
        cells.extend(&gain.removed);
        stay.extend(&gain.around);
        stay.extend(&loss.around);
        leave.insert(loss.point);
        swap.join.push(gain.point);
        swap.leave.push(loss.point);
    }
    swap
}
