use serde::{Deserialize, Serialize};

use super::PipelineError;
use super::weighed::Importance;
use crate::interpolate::{Adaptive, adaptive_voxels, exchange};
use walpha_points::{
    Points, PointsError, Selection, SelectionRule, Units, difference, points_at, select,
};
use walpha_volume::Volume;

/// The method that chooses which samples of a volume become points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Choice {
    /// The voxels of largest difference, as in the paper.
    Difference(Selection),
    /// Greedily, the voxels where the interpolant of those chosen so far is worst.
    Adaptive(Goal),
    /// Like `Adaptive`; then voxels whose loss costs little are exchanged for others
    /// ([`exchange`](crate::interpolate::exchange())).
    Exchanged(Goal),
}

/// The goals of adaptive selection, which ends when the first of them is reached. Without any goal, it ends at the paper's share
/// of all samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Goal {
    /// This number of points.
    pub count: Option<u64>,
    /// This share of all samples, instead of `count`.
    pub ratio: Option<f64>,
    /// The root mean square error of the interpolant over all samples, in gray levels.
    pub rmse: Option<f64>,
    /// The largest error of the interpolant at a sample, in gray levels; points are then chosen by that error.
    pub max_error: Option<f64>,
}

impl Goal {
    /// The goal of this number of points.
    pub fn of_count(count: u64) -> Self {
        Self { count: Some(count), ..Self::default() }
    }

    /// The goals for a volume of `samples` samples.
    ///
    /// # Errors
    /// The ratio is not a share.
    fn of(&self, samples: u64) -> Result<Adaptive, PointsError> {
        if let Some(ratio) = self.ratio {
            SelectionRule::Ratio(ratio).asked(samples)?;
        }
        let share = |ratio: f64| (ratio * samples as f64).round() as u64;
        let asked = self.count.or(self.ratio.map(share));
        let all = self.rmse.or(self.max_error).map(|_| samples);
        let count = asked.or(all).unwrap_or_else(|| share(SelectionRule::PAPER));
        Ok(Adaptive::new(count).rmse(self.rmse.unwrap_or(0.0)).max_error(self.max_error))
    }
}

impl Default for Choice {
    fn default() -> Self {
        Self::Difference(Selection::default())
    }
}

/// The chosen points.
pub(super) struct Chosen {
    pub(super) points: Points,
    pub(super) importance: Importance,
    /// The goal, if it was reached with fewer points than allowed.
    pub(super) ended: Option<Adaptive>,
}

impl Choice {
    /// Returns the choice without samples below a gray level, if one is given.
    pub(super) fn at_least(self, gray_min: Option<f64>) -> Self {
        match (self, gray_min) {
            (Self::Difference(selection), Some(_)) => {
                Self::Difference(selection.gray_min(selection.gray_min.or(gray_min)))
            }
            _ => self,
        }
    }

    /// Returns the choice with this number of points.
    #[must_use]
    pub fn with_count(self, count: u64) -> Self {
        let goal = |goal: Goal| Goal { count: Some(count), ratio: None, ..goal };
        match self {
            Self::Difference(selection) => {
                Self::Difference(selection.rule(SelectionRule::Count(count)))
            }
            Self::Adaptive(of) => Self::Adaptive(goal(of)),
            Self::Exchanged(of) => Self::Exchanged(goal(of)),
        }
    }

    /// Chooses samples of a volume; `smoothed` is the volume after truncation.
    pub(super) fn points(
        &self,
        volume: &Volume,
        smoothed: &Volume,
        units: Units,
    ) -> Result<Chosen, PipelineError> {
        let differences = difference(smoothed);
        let goal = match self {
            Self::Difference(selection) => {
                let points = select(volume, smoothed, &differences, selection, units)?;
                let by_difference = points.differences.clone().unwrap_or_default();
                let importance = Importance::Differences(by_difference);
                return Ok(Chosen { points, importance, ended: None });
            }
            Self::Adaptive(goal) | Self::Exchanged(goal) => {
                goal.of(volume.dims().samples() as u64)?
            }
        };
        let mut voxels = adaptive_voxels(volume, &goal, units)?;
        if matches!(self, Self::Exchanged(_)) {
            voxels = exchange(volume, &voxels, units)?;
        }
        // Points are in the order of their voxels; the order of importance is stored separately.
        let chosen = voxels.clone();
        voxels.sort_unstable();
        let place = |voxel: &u32| voxels.binary_search(voxel).expect("the same voxels") as u32;
        let importance = Importance::Order(chosen.iter().map(place).collect());
        // A goal of error alone allows as many points as there are samples: no number was requested.
        let asked = goal.count < volume.dims().samples() as u64;
        let fewer = asked && (voxels.len() as u64) < goal.count;
        let points = points_at(volume, &differences, &voxels, units);
        Ok(Chosen { points, importance, ended: fewer.then_some(goal) })
    }
}
