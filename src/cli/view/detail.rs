//! A level of detail: the shapes of one set of points.

use crate::Alpha;
use crate::cli::filled::filled_in;
use crate::cli::pipeline;
use crate::cli::progress::Progress;
use crate::interpolate::{Deviation, Grid, Interpolant};
use crate::ladder::Filtration;
use crate::pipeline::{AlphaRule, Parameter, Source, Weighed};
use crate::progress::Stage;
use crate::render::Differences;
use walpha_base::Monitor;

/// Levels that `--alphas auto` chooses, suggested ones not counted.
const STOPS: usize = 28;

pub(super) struct Detail {
    pub weighed: Weighed,
    pub filtration: Filtration,
    /// How far F is from the volume, in the values that are written.
    pub differences: Option<Differences>,
}

impl Detail {
    pub(super) fn new(
        weighed: Weighed,
        source: Option<&Source>,
        progress: &mut Progress,
    ) -> anyhow::Result<Self> {
        let filtration = progress.watch(|monitor| pipeline::filtration(None, &weighed, monitor))?;
        let differences = match source {
            Some(source) => {
                let monitor = progress.monitor();
                let found = || differences(&weighed, source, &filtration, &monitor);
                progress.stage(Stage::Interpolate, found)?
            }
            None => None,
        };
        Ok(Self { weighed, filtration, differences })
    }

    /// The α that weights are meant for, or else the one found.
    pub(super) fn reference(&self) -> Parameter {
        self.weighed.parameter.unwrap_or_else(|| self.found())
    }

    /// The α that the page opens at.
    pub(super) fn opening(&self, asked: Option<AlphaRule>) -> Alpha {
        let given = |rule: AlphaRule| {
            rule.given(self.weighed.origin.coordinates.unit).unwrap_or_else(|| self.found())
        };
        asked.map_or_else(|| self.reference(), given).alpha
    }

    fn found(&self) -> Parameter {
        Parameter::of_filtration(&self.filtration, self.weighed.origin.coordinates.unit)
    }

    /// Levels that each show something, and something else than the one before: the one to open at,
    /// suggested ones, and others between.
    pub(super) fn stops(&self, opening: Alpha) -> Vec<Alpha> {
        let curve = self.filtration.curve();
        let mut alphas = self.filtration.stops(&curve, STOPS);
        alphas.push(opening);
        alphas.extend(pipeline::suggested(&self.filtration, &curve));
        let distinct = self.filtration.levels(&alphas).distinct(opening);
        if distinct.is_empty() { vec![opening] } else { distinct }
    }
}

/// How far the interpolant, filled in, is from the volume; `None` where the points have no values.
fn differences(
    weighed: &Weighed,
    source: &Source,
    filtration: &Filtration,
    monitor: &Monitor,
) -> anyhow::Result<Option<Differences>> {
    let Source { volume, units, written, .. } = source;
    let Some(values) = &weighed.points.values else { return Ok(None) };
    let grays: Vec<f64> = values.iter().map(|&value| written.gray(value)).collect();
    let hull = filtration.levels(&[Alpha::INFINITE]);
    let hull = hull.shape(0, false, hull.betti()[0]);
    let (whole, grays) = filled_in(&hull, &grays, volume, *units, monitor)?;
    let interpolant = Interpolant::with_values(&whole, &grays)?;
    let grid = Grid::of(volume, *units);
    let mut local = interpolant.local_deviations(volume, &grid)?;
    local.truncate(weighed.points.len());
    let step = written.step();
    local.iter_mut().for_each(|difference| *difference *= step);
    let rmse = Deviation::of(volume, &interpolant.resample(&grid)?).rmse.unwrap_or_default() * step;
    Ok(Some(Differences { local, rmse }))
}
