//! From an input to weighted points, with what is reported about it.

mod domain;
mod input;

use clap::Args;
use walpha_base::Monitor;

use crate::interpolate::Refit;
use crate::ladder::{Curve, Filtration};
use crate::pipeline::{Model, PipelineError, Weighed};
use crate::points::ModelFacts;
use crate::progress::Stage;
use crate::shape::{ShapeError, ShapeOptions, Torus};
use crate::{Alpha, GrayRange, Pipeline, Units, Volume};

use super::args::{PipelineArgs, SelectArgs, WeightArgs};
use super::progress::Progress;
use super::said::{Said, misused};
use domain::box_volume;
pub(super) use domain::{Domain, domain};
use input::to_gray;
pub(super) use input::{Grays, Input, is_points, read, with_file, with_points};

/// The volume that points come from.
pub(super) struct Source {
    /// Gray levels, in the space that the points are in.
    pub volume: Volume,
    pub facts: VolumeFacts,
}

/// What is reported about a volume.
#[derive(Clone, Copy)]
pub(super) struct VolumeFacts {
    pub dims: [usize; 3],
    /// What coordinates are measured in.
    pub units: Units,
    /// The volume of the samples' box.
    pub extent: f64,
    pub range: GrayRange,
    pub written: GrayRange,
}

/// What the values of points are.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Values {
    /// Gray levels, where they come from a volume.
    Gray,
    /// Those that are written: of the file, unless gray levels were asked for.
    Written,
}

/// Steps 1 to 7: reads INPUT and makes weighted points of it, with the values that are written.
pub(super) fn weighted_points<W: Args>(
    args: &PipelineArgs<W>,
    stages: Pipeline,
    progress: &mut Progress,
) -> anyhow::Result<(Weighed, Option<VolumeFacts>)> {
    let (weighed, source) = points_and_volume(args, stages, Values::Written, progress)?;
    Ok((weighed, source.map(|source| source.facts)))
}

/// The same, and the volume they come from.
pub(super) fn points_and_volume<W: Args>(
    args: &PipelineArgs<W>,
    stages: Pipeline,
    values: Values,
    progress: &mut Progress,
) -> anyhow::Result<(Weighed, Option<Source>)> {
    let read = read(&args.input, progress)?;
    read.accepts(&args.input)?;
    weigh_input(read, stages, &args.select, values, progress)
}

/// The stages that do not depend on what INPUT is.
pub(super) fn stages<W: Args + Copy + Into<WeightArgs>>(args: &PipelineArgs<W>) -> Pipeline {
    let weights: WeightArgs = args.weights.into();
    let mut stages = Pipeline::new().haar(args.haar.options()).alpha(weights.alpha());
    if let Some(kind) = weights.weights {
        stages = stages.weighting(kind);
    }
    match args.refit.refit {
        Some(to) => stages.refit(to),
        None => stages,
    }
}

/// The same up to a shape.
pub(super) fn stages_to(args: &PipelineArgs, shape: ShapeOptions) -> Result<Pipeline, Said> {
    if shape.periodic.is_some() {
        args.input.given.refuse(&["refit"], "a periodic box repeats, and F is fitted in space")?;
    }
    if args.refit.refit == Some(Refit::Whole) && shape.memory.is_some() {
        misused!("--memory has no effect: --refit fits values on the whole triangulation" => "omit it, or give --refit=shape");
    }
    Ok(stages(args).shape(shape))
}

/// The same from what was read already.
pub(super) fn weigh_input(
    input: Input,
    pipeline: Pipeline,
    select: &SelectArgs,
    values: Values,
    progress: &mut Progress,
) -> anyhow::Result<(Weighed, Option<Source>)> {
    let grays = match input {
        Input::Points(mut points, facts) => {
            if let (Values::Gray, Some(range)) = (values, facts.range) {
                to_gray(&mut points, &range);
            }
            let weighed =
                progress.watch(|monitor| pipeline.weighed_model(points, &facts, monitor))?;
            return Ok((weighed, None));
        }
        Input::Volume(grays) => grays,
    };
    let source = place(grays, select)?;
    let weighed = weigh_source(&source, pipeline, select, values, progress)?;
    Ok((weighed, Some(source)))
}

/// A volume in the space that its points are going to be in.
pub(super) fn place(grays: Grays, select: &SelectArgs) -> anyhow::Result<Source> {
    let Grays { volume, range, written } = grays;
    let (volume, units) = select.place(volume)?;
    let (dims, extent) = (volume.dims().xyz(), box_volume(&volume, units));
    Ok(Source { volume, facts: VolumeFacts { dims, units, extent, range, written } })
}

/// Weighted points of a volume.
pub(super) fn weigh_source(
    source: &Source,
    mut pipeline: Pipeline,
    select: &SelectArgs,
    values: Values,
    progress: &mut Progress,
) -> anyhow::Result<Weighed> {
    let Source { volume, facts } = source;
    let choice = select.choice(&facts.range, volume.dims().samples())?;
    pipeline = pipeline.units(facts.units).choice(choice);
    if values == Values::Written {
        pipeline = pipeline.values(facts.written);
    }
    Ok(progress.watch(|monitor| pipeline.weighed(volume, monitor))?)
}

/// What a file of a model keeps besides its points, but for their order.
pub(super) fn model_facts(weighed: &Weighed, volume: Option<&VolumeFacts>) -> ModelFacts {
    let origin = weighed.origin;
    ModelFacts {
        grid: origin.grid,
        coordinates: origin.coordinates,
        alpha: weighed.parameter.map(|parameter| parameter.alpha),
        range: volume.map(|volume| volume.written).or(origin.range),
        order: None,
        cell: None,
    }
}

/// The shape of weighted points.
pub(super) fn shape(
    weighed: Weighed,
    options: ShapeOptions,
    progress: &mut Progress,
) -> anyhow::Result<Model> {
    let pipeline = Pipeline::new().shape(options);
    progress.watch(|monitor| pipeline.finish(weighed, monitor)).map_err(|error| match &error {
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
