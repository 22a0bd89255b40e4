//! What coverage is a share of.

use std::fmt::{self, Display};

use serde::Serialize;

use crate::pipeline::Weighed;
use crate::{LengthUnit, Units, Volume};

use super::VolumeSummary;

/// The volume that coverage is a share of.
#[derive(Clone, Copy, Debug, Serialize)]
pub(in crate::cli) struct Domain {
    pub volume: f64,
    /// Of length; the volume is in its cube.
    pub unit: LengthUnit,
    /// What it is the volume of.
    pub of: &'static str,
}

impl Domain {
    /// The box between the outermost samples of a grid.
    pub(in crate::cli) fn of_grid(volume: &Volume, units: Units) -> Self {
        let unit = units.coordinates(volume).unit;
        Self { volume: box_volume(volume, units), unit, of: "the box of the samples" }
    }
}

impl Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, volume {} {}³", self.of, self.volume, self.unit.symbol())
    }
}

/// The domain of weighted points: that of the grid they come from, or their own box.
pub(in crate::cli) fn domain(weighed: &Weighed, volume: Option<&VolumeSummary>) -> Domain {
    let unit = weighed.origin.coordinates.unit;
    if let Some(volume) = volume {
        return Domain { volume: volume.extent, unit, of: "the box of the samples" };
    }
    let extent = |k: usize| {
        let ends = (weighed.points.positions.iter())
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], p| [l.min(p[k]), h.max(p[k])]);
        ends[1] - ends[0]
    };
    Domain { volume: extent(0) * extent(1) * extent(2), unit, of: "the box of the points" }
}

/// The box between the outermost samples.
pub(super) fn box_volume(volume: &Volume, units: Units) -> f64 {
    let steps: f64 = volume.dims().xyz().map(|n| (n - 1) as f64).iter().product();
    steps * units.voxel_volume(volume)
}
