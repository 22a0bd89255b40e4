use walpha_base::Monitor;

use super::PipelineError;
use super::weighed::Importance;
use crate::interpolate::{Adaptive, adaptive_voxels_monitored, exchange_monitored};
use crate::points::{Points, Selection, Units, difference, points_at, select};
use crate::volume::Volume;

/// Which samples of a volume become points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Choice {
    /// Those of the largest differences, as in the paper.
    Difference(Selection),
    /// Those where the interpolant of the ones before is worst.
    Adaptive(Adaptive),
    /// The same, and then those whose loss costs little exchanged for others
    /// ([`exchange`](crate::interpolate::exchange())).
    Exchanged(Adaptive),
}

impl Default for Choice {
    fn default() -> Self {
        Self::Difference(Selection::default())
    }
}

/// The points that were chosen.
pub(super) struct Chosen {
    pub(super) points: Points,
    pub(super) importance: Importance,
    /// What they were asked for, where fewer do.
    pub(super) ended: Option<Adaptive>,
}

impl Choice {
    /// Chooses samples of a volume, of which `smoothed` is what truncation left.
    pub(super) fn points(
        &self,
        volume: &Volume,
        smoothed: &Volume,
        units: Units,
        monitor: &Monitor,
    ) -> Result<Chosen, PipelineError> {
        let differences = difference(smoothed);
        let goal = match self {
            Self::Difference(selection) => {
                let points = select(volume, smoothed, &differences, selection, units)?;
                let by_difference = points.differences.clone().unwrap_or_default();
                let importance = Importance::Differences(by_difference);
                return Ok(Chosen { points, importance, ended: None });
            }
            Self::Adaptive(goal) | Self::Exchanged(goal) => goal,
        };
        let mut voxels = adaptive_voxels_monitored(volume, goal, units, monitor)?;
        if matches!(self, Self::Exchanged(_)) {
            voxels = exchange_monitored(volume, &voxels, units, monitor)?;
        }
        // Points are in the order of their voxels; the order of importance is kept beside them.
        let chosen = voxels.clone();
        voxels.sort_unstable();
        let place = |voxel: &u32| voxels.binary_search(voxel).expect("the same voxels") as u32;
        let importance = Importance::Order(chosen.iter().map(place).collect());
        // With a target alone as many as there are samples may be needed, and none is asked for.
        let asked = goal.count < volume.dims().samples() as u64;
        let fewer = asked && (voxels.len() as u64) < goal.count;
        let points = points_at(volume, &differences, &voxels, units);
        Ok(Chosen { points, importance, ended: fewer.then_some(*goal) })
    }
}
