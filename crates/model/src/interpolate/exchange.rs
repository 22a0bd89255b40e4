//! The effects of adding or removing one point, with everything else unchanged.

use std::collections::HashSet;

use walpha_base::Monitor;
use walpha_base::memory::NoMemory;
use walpha_base::parallel::prelude::*;
use walpha_regular::internals::number::{cross, dot};
use walpha_regular::internals::{Growing, Screen, Workspace};

use super::InterpolateError;
use super::adaptive::worst;
use super::fill::corners;
use super::least_squares::{Lists, samples_of};
use super::sampled::Sampled;
use walpha_points::Units;
use walpha_shape::ShapeError;
use walpha_volume::Volume;

/// The largest share of points exchanged in one round. It is halved after a round without gain.
const MOST: f64 = 0.1;
/// The number of samples tried as new points in one round, as a share of the points.
const TRIED: f64 = 0.5;
/// The largest number of rounds. Each lowers the RMSE by less than the one before.
const ROUNDS: u64 = 16;
/// A round that lowers the RMSE by less than this share is the last.
const LEAST: f64 = 2e-3;

/// Selects the same number of samples whose triangulation represents the volume better: the points of least loss are exchanged
/// for the samples of greatest gain, until a round gains next to nothing.
///
/// The error is that of fitted values ([`refit`](super::refit())) on the unweighted triangulation, over all samples. Each round
/// does the following:
///
/// 1. the *loss* of each point is computed, the increase of the squared error when it is removed and all
///    other values stay; and the *gain* of the worst sample of each cell, worst cells first, the decrease
///    when it is inserted with its optimal value: both by local retriangulation;
/// 2. the greatest gain is paired with the least loss, the next with the next, as long as the gain is greater; points near others
///    of the round have to wait;
/// 3. values are fitted. If the error is not smaller, the round is undone and the next one is half as large.
///
/// The corners of the volume stay. `voxels` are samples of the volume including its corners, in any order; those that were never
/// exchanged come first in the result, in that order. The result does not depend on the number of threads. For n points a round
/// takes about n removals and n/2 insertions, each of a few dozen cells.
///
/// # Errors
/// Samples are missing, the given samples span no volume, or there is not enough memory.
pub fn exchange(
    volume: &Volume,
    voxels: &[u32],
    units: Units,
) -> Result<Vec<u32>, InterpolateError> {
    let monitor = &*Monitor::current();
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

/// The points exchanged in one round, by number.
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

/// Pairs the greatest gain with the least loss, the next ones, and so on. No cell is removed for two new points, and no point is
/// removed beside a new point or another that is removed.
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

/// The cost of removing a point.
pub(super) struct Loss {
    /// The number of the point.
    pub point: u32,
    /// The increase of the squared error.
    pub loss: f64,
    /// The neighbours of the point.
    pub around: Vec<u32>,
}

/// The gain of inserting a point.
pub(super) struct Gain {
    /// The number of the point.
    pub point: u32,
    /// The decrease of the squared error.
    pub gain: f64,
    /// The cells in conflict with the point.
    pub removed: Vec<u32>,
    /// The neighbours that the point would have.
    pub around: Vec<u32>,
}

/// A triangulation on which points are tried.
pub(super) struct Trial<'a> {
    volume: &'a Volume,
    sampled: &'a Sampled<'a>,
    screen: &'a Screen<'a>,
    samples: Lists,
}

impl<'a> Trial<'a> {
    /// Finds the samples of each cell. O(samples).
    pub(super) fn new(
        volume: &'a Volume,
        sampled: &'a Sampled<'a>,
        screen: &'a Screen<'a>,
    ) -> Result<Self, NoMemory> {
        let samples = samples_of(sampled.cells(), sampled.owners(), volume)?;
        Ok(Self { volume, sampled, screen, samples })
    }

    /// Scratch memory for [`Self::loss`].
    pub(super) fn workspace(&self) -> Result<Workspace, ShapeError> {
        Ok(Workspace::new(self.sampled.voxels().len())?)
    }

    /// The cost of removing a vertex; `None` if it cannot be removed.
    pub(super) fn loss(
        &self,
        point: u32,
        workspace: &mut Result<Workspace, ShapeError>,
    ) -> Result<Option<Loss>, ShapeError> {
        let workspace = workspace.as_mut().map_err(|error| error.clone())?;
        let Some(hole) = self.growing().hole(self.screen, point, workspace)? else {
            return Ok(None);
        };
        let rows = hole.filling.iter().map(|cell| cell.corners);
        let cells =
            LinearCells::of(rows.filter(|row| row.iter().all(|&v| v >= Growing::FIRST)), self);
        let mut loss = 0.0;
        for &sample in hole.star.iter().flat_map(|&cell| self.samples.of(cell)) {
            let Some((row, shares)) = cells.at(self.sampled.place(sample)) else {
                return Ok(None);
            };
            let f: f64 = (0..4).map(|k| shares[k] * self.value(row[k])).sum();
            loss += (self.gray(sample) - f).powi(2) - self.error(sample).powi(2);
        }
        Ok(Some(Loss { point, loss, around: cells.vertices(point) }))
    }

    /// The gain of inserting a sample that is not a vertex, with the value that gains most.
    pub(super) fn gain(&self, point: u32) -> Option<Gain> {
        let cell = self.sampled.owners()[self.sampled.voxels()[point as usize] as usize];
        let insertion = self.growing().insertion(self.screen, point, cell);
        let cells = LinearCells::of(insertion.cells.iter().copied(), self);
        // For the errors e without the new value, and its shares φ: Σe², Σφe, Σφ².
        let (mut before, mut errors, mut products, mut squares) = (0.0, 0.0, 0.0, 0.0);
        for &sample in insertion.removed.iter().flat_map(|&cell| self.samples.of(cell)) {
            let (row, shares) = cells.at(self.sampled.place(sample))?;
            let mut error = self.gray(sample);
            for (v, share) in row.into_iter().zip(shares) {
                if v == point {
                    squares += share * share;
                } else {
                    error -= share * self.value(v);
                }
            }
            let share = row.iter().position(|&v| v == point).map_or(0.0, |k| shares[k]);
            before += self.error(sample).powi(2);
            errors += error * error;
            products += share * error;
        }
        (squares > 0.0).then(|| Gain {
            point,
            gain: before - (errors - products * products / squares),
            around: cells.vertices(point),
            removed: insertion.removed,
        })
    }

    fn growing(&self) -> &Growing {
        self.sampled.growing()
    }

    fn value(&self, v: u32) -> f64 {
        self.sampled.values()[v as usize]
    }

    fn gray(&self, sample: u32) -> f64 {
        self.volume.as_slice()[sample as usize].into()
    }

    fn error(&self, sample: u32) -> f64 {
        self.gray(sample) - f64::from(self.sampled.f()[sample as usize])
    }
}

/// A few cells, each with the map from a position to its coordinates in the cell.
struct LinearCells(Vec<LinearCell>);

struct LinearCell {
    row: [u32; 4],
    origin: [f64; 3],
    /// The gradients of the last three coordinates.
    gradients: [[f64; 3]; 3],
}

impl LinearCells {
    fn of(rows: impl Iterator<Item = [u32; 4]>, trial: &Trial<'_>) -> Self {
        Self(rows.filter_map(|row| LinearCell::of(row, trial.growing().positions())).collect())
    }

    /// The cell that contains a position, or nearly does, and its coordinates in the cell. Rounding decides between cells at a
    /// face, where all of them have the same values.
    fn at(&self, place: [f64; 3]) -> Option<([u32; 4], [f64; 4])> {
        let mut best = None;
        let mut depth = f64::NEG_INFINITY;
        for cell in &self.0 {
            let shares = cell.shares(place);
            let least = shares.iter().copied().fold(f64::INFINITY, f64::min);
            if least > depth {
                depth = least;
                best = Some((cell.row, shares));
                if least >= 0.0 {
                    break;
                }
            }
        }
        best
    }

    /// The vertices of the cells, except one.
    fn vertices(&self, without: u32) -> Vec<u32> {
        let all = self.0.iter().flat_map(|cell| cell.row);
        let mut vertices: Vec<u32> = all.filter(|&v| v != without).collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }
}

impl LinearCell {
    /// The map of a cell; `None` for a cell without volume, which occurs among points on one sphere.
    fn of(row: [u32; 4], positions: &[[f64; 3]]) -> Option<Self> {
        let [a, b, c, d] = row.map(|v| positions[v as usize]);
        let from = |p: [f64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
        let [b, c, d] = [b, c, d].map(from);
        let normals = [cross(&c, &d), cross(&d, &b), cross(&b, &c)];
        let whole = dot(&b, &normals[0]);
        let gradients = normals.map(|normal| normal.map(|x| x / whole));
        let is_solid = whole != 0.0 && gradients.as_flattened().iter().all(|x| x.is_finite());
        is_solid.then_some(Self { row, origin: a, gradients })
    }

    fn shares(&self, place: [f64; 3]) -> [f64; 4] {
        let from = [0, 1, 2].map(|k| place[k] - self.origin[k]);
        let [b, c, d] = self.gradients.map(|gradient| dot(&gradient, &from));
        [1.0 - b - c - d, b, c, d]
    }
}
