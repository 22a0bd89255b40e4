//! From an input to weighted points, with what is reported about it.

mod domain;
mod input;

use walpha_base::Monitor;

use crate::ladder::{Curve, Filtration};
use crate::pipeline::{Model, PipelineError, Source, Values, Weighed};
use crate::points::ModelFacts;
use crate::progress::Stage;
use crate::shape::{ShapeError, Torus};
use crate::{Alpha, GrayRange, Recipe};

use super::args::InputArgs;
use super::progress::Progress;
use super::said::Said;
use domain::box_volume;
pub(super) use domain::{Domain, domain};
pub(super) use input::{accept, read, with_file, with_points};

/// What is reported about a volume.
#[derive(Clone, Copy)]
pub(super) struct VolumeSummary {
    pub dims: [usize; 3],
    /// The volume of the samples' box.
    pub extent: f64,
    pub range: GrayRange,
    pub written: GrayRange,
}

impl VolumeSummary {
    pub(super) fn of(source: &Source) -> Self {
        let Source { volume, units, range, written, .. } = source;
        let extent = box_volume(volume, *units);
        Self { dims: volume.dims().xyz(), extent, range: *range, written: *written }
    }
}

/// Steps 1 to 7: reads INPUT and makes weighted points of it, with the values that are written.
pub(super) fn weighted_points(
    args: &InputArgs,
    recipe: &Recipe,
    progress: &mut Progress,
) -> anyhow::Result<(Weighed, Option<VolumeSummary>)> {
    let (weighed, source) = points_and_volume(args, recipe, Values::Written, progress)?;
    Ok((weighed, source.as_ref().map(VolumeSummary::of)))
}

/// The same, and the volume they come from.
pub(super) fn points_and_volume(
    args: &InputArgs,
    recipe: &Recipe,
    values: Values,
    progress: &mut Progress,
) -> anyhow::Result<(Weighed, Option<Source>)> {
    let read = read(args, recipe, progress)?;
    accept(&read, args)?;
    Ok(progress.watch(|monitor| recipe.weigh(read, values, monitor))?)
}

/// What a file of a model keeps besides its points, but for their order.
pub(super) fn model_facts(weighed: &Weighed, volume: Option<&VolumeSummary>) -> ModelFacts {
    let origin = weighed.origin;
    ModelFacts {
        grid: origin.grid,
        coordinates: origin.coordinates,
        alpha: weighed.parameter.map(|parameter| parameter.alpha),
        range: volume.map(|volume| volume.written).or(origin.range),
        recipe: weighed.recipe.clone(),
        order: None,
        cell: None,
    }
}

/// The shape of weighted points.
pub(super) fn shape(
    weighed: Weighed,
    recipe: &Recipe,
    progress: &mut Progress,
) -> anyhow::Result<Model> {
    progress.watch(|monitor| recipe.finish(weighed, monitor)).map_err(|error| match &error {
        PipelineError::Radii { .. } => Said::usage_of(&error).into(),
        _ => error.into(),
    })
}

/// All shapes of weighted points with the weights that they have; of a torus, if there is one.
pub(super) fn filtration(
    torus: Option<Torus>,
    weighed: &Weighed,
    monitor: &Monitor,
) -> Result<Filtration, ShapeError> {
    Stage::Filtration.begin(monitor)?;
    Filtration::monitored(torus, weighed.points.clone(), monitor)
}

/// Readable critical values, those suggested, and the α that the weights are meant for.
pub(super) fn readable(
    filtration: &Filtration,
    curve: &Curve,
    count: usize,
    reference: Alpha,
) -> Vec<Alpha> {
    let mut alphas = filtration.readable(curve, count);
    alphas.push(reference);
    alphas.extend(suggested(filtration, curve));
    alphas
}

/// The suggested values of α that are finite.
pub(super) fn suggested(filtration: &Filtration, curve: &Curve) -> Vec<Alpha> {
    let suggested = filtration.suggest(curve);
    let [low, high] = suggested.plateau;
    let also = [suggested.all_points, suggested.one_region, suggested.no_void, low, high];
    also.into_iter().filter(|alpha| alpha.squared().is_finite()).collect()
}
