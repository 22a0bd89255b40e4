//! From an input to weighted points, with what is to be told about the way.

use std::fmt::{self, Display};
use std::path::Path;

use serde::Serialize;
use walpha::export::{Scratch, Target};
use walpha::interpolate::adaptive_voxels;
use walpha::ladder::{Curve, Filtration};
use walpha::points::{is_point_file, read_points, weigh};
use walpha::volume::Reason;
use walpha::{
    Alpha, Coordinates, GrayRange, LengthUnit, Points, Selection, Truncation, Units, Volume,
    VolumeError, WeightedPoints, Weighting, haar, points, volume,
};

use super::args::{HaarArgs, InputArgs, PipelineArgs, SelectArgs, ShapeArgs, WeightArgs};
use super::complaint::{is_usage, reasons};
use super::parameter::Parameter;
use super::progress::Progress;
use super::said::{Said, misused, refused, said};

/// What INPUT turned out to be.
pub enum Input {
    /// A grid of gray levels.
    Volume(Grays),
    /// Points, with weights and values perhaps.
    Points(Points),
}

/// A volume in gray levels, and what they stand for.
pub struct Grays {
    pub volume: Volume,
    /// The values that became gray 0 and 255.
    pub range: GrayRange,
    /// The same where values are written, or else no change.
    pub written: GrayRange,
}

/// Reads INPUT.
pub fn read(args: &InputArgs, progress: &mut Progress) -> anyhow::Result<Input> {
    progress.stage("read", || {
        with_file(args, |input| {
            if is_points(args, input)? {
                return Ok(Input::Points(read_points(Path::new(input), args.columns())?));
            }
            let volume = volume::open(input, &args.options()).map_err(with_points)?;
            let (volume, range) = volume.into_gray(args.gray())?;
            Ok(Input::Volume(Grays { volume, range, written: args.written(range) }))
        })
    })
}

/// Adds the formats of points to the error for a file of no format known.
pub fn with_points(error: VolumeError) -> anyhow::Error {
    if !matches!(error, VolumeError::Format { reason: Reason::Unknown { .. }, .. }) {
        return error.into();
    }
    let names: Vec<&str> = points::FORMATS.iter().map(|format| format.name).collect();
    let said = Said::from(error);
    Said { why: format!("{}, {} as points", said.why, names.join(", ")), ..said }.into()
}

/// Does something with INPUT as a file or the name of a sample. Standard input becomes a file for that
/// time: formats are read in several passes.
pub fn with_file<T>(
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

/// Options that speak of a volume.
const OF_VOLUMES: [&str; 22] = [
    "level",
    "array",
    "frame",
    "series",
    "nan",
    "roi",
    "downsample",
    "gray",
    "gray_out",
    "haar",
    "rms",
    "epsilon",
    "coefficients",
    "select",
    "target_rmse",
    "count",
    "ratio",
    "threshold",
    "gray_min",
    "value_min",
    "units",
    "space",
];

impl Input {
    /// Refuses options that have no effect on what INPUT is.
    pub fn accepts(&self, args: &InputArgs) -> Result<(), Said> {
        let holds = |what| format!("{} holds {what}", args.input);
        match self {
            Self::Volume(..) => args.given.refuse(&["columns"], holds("a volume")),
            Self::Points(_) => args.given.refuse(&OF_VOLUMES, holds("points, and no volume")),
        }
    }
}

/// Whether an input is a point file.
pub fn is_points(args: &InputArgs, input: &str) -> anyhow::Result<bool> {
    let volume = input.starts_with("sample:") || args.options().raw.is_some();
    Ok(!volume && is_point_file(Path::new(input))?)
}

/// Weighted points and what is to be told about them.
pub struct Weighed {
    /// With gray levels as values, where they come from a volume.
    pub points: WeightedPoints,
    pub weighting: Weighting,
    /// What the coordinates of the points mean.
    pub coordinates: Coordinates,
    pub volume: Option<VolumeFacts>,
    /// α; none where it is to be looked for, and the weights do not need it.
    pub parameter: Option<Parameter>,
}

impl Weighed {
    /// α, looked for if it was not needed before.
    pub fn find_parameter(
        &mut self,
        shape: &ShapeArgs,
        progress: &mut Progress,
    ) -> anyhow::Result<Parameter> {
        let parameter = match self.parameter {
            Some(parameter) => parameter,
            None => Parameter::found(self.points.clone(), self.coordinates.unit, progress)?,
        };
        if shape.radii() && parameter.is_found() {
            misused!("with --balls radius, α is a radius, and auto finds squared ones" => "give --alpha A, as in --alpha {}", parameter.alpha.squared().abs().sqrt());
        }
        self.parameter = Some(parameter);
        Ok(parameter)
    }
}

/// What is to be told about a volume.
pub struct VolumeFacts {
    pub dims: [usize; 3],
    /// What coordinates are measured in.
    pub units: Units,
    /// The volume of the samples' box.
    pub extent: f64,
    pub range: GrayRange,
    pub written: GrayRange,
    pub truncation: Truncation,
    /// Adaptive selection ended before it had as many points as asked for.
    pub ended: Option<Ended>,
}

/// Why there are fewer points than asked for.
#[derive(Clone, Copy, Serialize)]
pub struct Ended {
    asked: u64,
    /// The RMSE that was good enough; 0 where only a perfect interpolant is.
    rmse: f64,
}

impl Display for Ended {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { asked, rmse } = self;
        write!(f, "fewer than {asked}: ")?;
        match *rmse {
            0.0 => write!(f, "no sample differs from the interpolant of these any more"),
            rmse => write!(f, "these reach an RMSE of {rmse} gray levels"),
        }
    }
}

impl Weighed {
    /// The points with the values that are written: those of the file, unless gray levels were asked
    /// for.
    pub fn in_values(mut self) -> Self {
        if let (Some(volume), Some(values)) = (&self.volume, &mut self.points.values) {
            values.iter_mut().for_each(|value| *value = volume.written.value(*value));
        }
        self
    }
}

/// Steps 1 to 7: reads INPUT and makes weighted points of it, with the values that are written.
pub fn weighted_points(args: &PipelineArgs, progress: &mut Progress) -> anyhow::Result<Weighed> {
    Ok(points_and_volume(args, progress)?.0.in_values())
}

/// The same with gray levels, and those of the volume they come from.
pub fn points_and_volume(
    args: &PipelineArgs,
    progress: &mut Progress,
) -> anyhow::Result<(Weighed, Option<Volume>)> {
    let PipelineArgs { input, haar, select, weights } = args;
    let read = read(input, progress)?;
    read.accepts(input)?;
    weigh_input(read, haar, select, weights, progress)
}

/// The same from what was read already.
pub fn weigh_input(
    input: Input,
    haar: &HaarArgs,
    select: &SelectArgs,
    weights: &WeightArgs,
    progress: &mut Progress,
) -> anyhow::Result<(Weighed, Option<Volume>)> {
    let mut original = None;
    let mut coordinates = Coordinates::default();
    let mut parameter = Parameter::given(weights.alpha(), coordinates.unit);
    let (mut points, volume) = match input {
        Input::Points(points) => (points, None),
        Input::Volume(Grays { volume, range, written }) => {
            let (volume, units) = select.place(volume)?;
            coordinates = units.coordinates(&volume);
            parameter = match weights.alpha() {
                None => Some(Parameter::of_volume(&volume, units)?),
                asked => Parameter::given(asked, coordinates.unit),
            };
            let options = haar.options();
            let (smoothed, truncation) =
                progress.stage("haar", || haar::smooth(&volume, &options))?;
            let (selected, ended) = progress.stage("points", || {
                selected_points(&volume, &smoothed, &select.selection(&range), select, units)
            })?;
            let (dims, extent) = (volume.dims().xyz(), box_volume(&volume, units));
            let facts = VolumeFacts { dims, units, extent, range, written, truncation, ended };
            original = Some(volume);
            (selected, Some(facts))
        }
    };
    let weighting = weights.weighting(points.weights.is_some());
    let points = progress.stage("points", || {
        let scattered = points.differences.is_none() && points.values.is_some();
        if scattered && weighting.needs_differences() {
            points.differences = Some(points::scattered_difference(&points)?);
        }
        anyhow::Ok(points)
    })?;
    if parameter.is_none() && weighting.needs_differences() {
        // What is wrong with the weights is told before the search.
        weigh(&points, weighting, 0.0)?;
        parameter = Some(Parameter::found_unweighted(&points, coordinates.unit, progress)?);
    }
    let alpha = parameter.map_or(0.0, |parameter| parameter.alpha.squared());
    let points = progress.stage("points", || weigh(&points, weighting, alpha))?;
    Ok((Weighed { points, weighting, coordinates, volume, parameter }, original))
}

/// Points as asked for: by differences, or adaptively, where fewer may do.
fn selected_points(
    volume: &Volume,
    smoothed: &Volume,
    selection: &Selection,
    select: &SelectArgs,
    units: Units,
) -> anyhow::Result<(Points, Option<Ended>)> {
    let differences = points::difference(smoothed);
    let Some(goal) = select.adaptive(volume.dims().samples())? else {
        return Ok((points::select(volume, smoothed, &differences, selection, units)?, None));
    };
    if volume.has_missing() {
        refused!("--select adaptive interpolates between all samples, and some are missing" => "give --nan a value, or omit adaptive");
    }
    let mut voxels = adaptive_voxels(volume, &goal, units)?;
    voxels.sort_unstable();
    // With a target alone as many as there are samples may be needed, and none is asked for.
    let asked = goal.count < volume.dims().samples() as u64;
    let fewer = asked && (voxels.len() as u64) < goal.count;
    let ended = fewer.then_some(Ended { asked: goal.count, rmse: goal.rmse });
    Ok((points::points_at(volume, &differences, &voxels, units), ended))
}

/// The volume that coverage is a share of.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Domain {
    pub volume: f64,
    /// Of length; the volume is in its cube.
    pub unit: LengthUnit,
    /// What it is the volume of.
    pub of: &'static str,
}

impl Domain {
    /// The box between the outermost samples of a grid.
    pub fn of_grid(volume: &Volume, units: Units) -> Self {
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
pub fn domain(weighed: &Weighed) -> Domain {
    let unit = weighed.coordinates.unit;
    if let Some(volume) = &weighed.volume {
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
    steps * cell(volume, units)
}

/// The volume of a voxel.
fn cell(volume: &Volume, units: Units) -> f64 {
    match units {
        Units::Voxel => 1.0,
        Units::World => volume.frame().cell(),
    }
}

/// The side of a cube as large as a voxel.
pub fn side(volume: &Volume, units: Units) -> f64 {
    cell(volume, units).cbrt()
}

/// Readable critical values, those suggested, and the α that the weights are meant for.
pub fn readable(
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
pub fn suggested(filtration: &Filtration, curve: &Curve) -> Vec<Alpha> {
    let suggested = filtration.suggest(curve);
    let [low, high] = suggested.plateau;
    let also = [suggested.all_points, suggested.one_region, suggested.no_void, low, high];
    let finite = also.into_iter().filter(|alpha| alpha.is_finite());
    finite.filter_map(|alpha| Alpha::from_squared(alpha).ok()).collect()
}
