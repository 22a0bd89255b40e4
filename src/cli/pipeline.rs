//! From an input to weighted points, with what is reported about it.

use std::fmt::{self, Display};
use std::path::Path;

use clap::Args;
use serde::Serialize;

use crate::export::{Scratch, Target};
use crate::interpolate::Refit;
use crate::ladder::{Curve, Filtration};
use crate::pipeline::{Model, PipelineError, Weighed};
use crate::points::{ModelFacts, is_point_file, read_model};
use crate::progress::Stage;
use crate::shape::ShapeOptions;
use crate::volume::Reason;
use crate::{Alpha, GrayRange, LengthUnit, Pipeline, Points, Units, Volume, VolumeError, volume};

use super::args::{self, InputArgs, PipelineArgs, SelectArgs, WeightArgs};
use super::complaint::{is_usage, reasons};
use super::progress::Progress;
use super::said::{Said, misused, said};

/// What INPUT turned out to be.
pub(super) enum Input {
    /// A grid of gray levels.
    Volume(Grays),
    /// Points, perhaps with weights and values, and what else their file states.
    Points(Points, ModelFacts),
}

/// A volume in gray levels, and what they stand for.
pub(super) struct Grays {
    pub volume: Volume,
    /// The values that became gray 0 and 255.
    pub range: GrayRange,
    /// The same where values are written, or else no change.
    pub written: GrayRange,
}

/// Reads INPUT.
pub(super) fn read(args: &InputArgs, progress: &mut Progress) -> anyhow::Result<Input> {
    progress.stage(Stage::Read, || {
        with_file(args, |input| {
            if is_points(args, input)? {
                let level = args.options().level;
                let (mut points, mut facts) = read_model(Path::new(input), args.columns(), level)?;
                if let Some(range) = &mut facts.range {
                    let written = args.written(*range);
                    if written != *range {
                        to_gray(&mut points, range);
                        *range = written;
                    }
                }
                return Ok(Input::Points(points, facts));
            }
            let volume = volume::open(input, &args.options()).map_err(with_points)?;
            let (volume, range) = volume.into_gray(args.gray())?;
            Ok(Input::Volume(Grays { volume, range, written: args.written(range) }))
        })
    })
}

/// Gives points gray levels for values. As in a volume, they are of single precision.
fn to_gray(points: &mut Points, range: &GrayRange) {
    let gray = |value: &mut f64| *value = f64::from(range.gray(*value) as f32);
    points.values.iter_mut().flatten().for_each(gray);
}

/// Adds the formats of points to the error for a file of no format known.
pub(super) fn with_points(error: VolumeError) -> anyhow::Error {
    if !matches!(error, VolumeError::Format { reason: Reason::Unknown { .. }, .. }) {
        return error.into();
    }
    let names: Vec<&str> = crate::points::FORMATS.iter().map(|format| format.name).collect();
    let said = Said::from(error);
    Said { why: format!("{}, {} as points", said.why, names.join(", ")), ..said }.into()
}

/// Does something with INPUT as a file or the name of a sample. Standard input becomes a file for that
/// time: formats are read in several passes.
pub(super) fn with_file<T>(
    args: &InputArgs,
    work: impl FnOnce(&str) -> anyhow::Result<T>,
) -> anyhow::Result<T> {
    if args.input != Target::STDOUT {
        return work(&args.input);
    }
    let file = Scratch::of(&mut std::io::stdin().lock(), &args.extension())
        .map_err(|error| said!("cannot read standard input: {error}" => "name a file instead"))?;
    let path = file.path().to_string_lossy().into_owned();
    // Nobody knows the name of that file.
    work(&path).map_err(|error| {
        let (why, next) = reasons(&error);
        let named = |text: String| text.replace(&path, "standard input");
        let usage = is_usage(&error);
        Said { why: named(why), next: next.map(named), usage }.into()
    })
}

impl Input {
    /// Refuses options that have no effect on what INPUT is.
    pub(super) fn accepts(&self, args: &InputArgs) -> Result<(), Said> {
        let holds = |what| format!("{} holds {what}", args.input);
        match self {
            Self::Volume(..) => args.given.refuse(&["columns"], holds("a volume")),
            Self::Points(_, facts) => {
                let what = holds("points, and no volume");
                if facts.range.is_none() {
                    args.given.refuse(&["gray_out"], &what)?;
                }
                args.given.refuse(&args::of_volumes(), what)
            }
        }
    }
}

/// Whether an input is a point file.
pub(super) fn is_points(args: &InputArgs, input: &str) -> anyhow::Result<bool> {
    let volume = input.starts_with("sample:") || args.options().raw.is_some();
    Ok(!volume && is_point_file(Path::new(input))?)
}

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
            let weighed = progress.watch(|hear| pipeline.weighed_model(points, &facts, hear))?;
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
    Ok(progress.watch(|hear| pipeline.weighed(volume, hear))?)
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
    }
}

/// The shape of weighted points.
pub(super) fn shape(
    weighed: Weighed,
    options: ShapeOptions,
    progress: &mut Progress,
) -> anyhow::Result<Model> {
    let pipeline = Pipeline::new().shape(options);
    progress.watch(|hear| pipeline.finish(weighed, hear)).map_err(|error| match &error {
        PipelineError::Radii { .. } => Said::usage_of(&error).into(),
        _ => error.into(),
    })
}

/// The volume that coverage is a share of.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Domain {
    pub volume: f64,
    /// Of length; the volume is in its cube.
    pub unit: LengthUnit,
    /// What it is the volume of.
    pub of: &'static str,
}

impl Domain {
    /// The box between the outermost samples of a grid.
    pub(super) fn of_grid(volume: &Volume, units: Units) -> Self {
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
pub(super) fn domain(weighed: &Weighed, volume: Option<&VolumeFacts>) -> Domain {
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
fn box_volume(volume: &Volume, units: Units) -> f64 {
    let steps: f64 = volume.dims().xyz().map(|n| (n - 1) as f64).iter().product();
    steps * units.voxel_volume(volume)
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
