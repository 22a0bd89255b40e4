//! The steps from INPUT to weighted points and shapes, which several commands share.

use std::fmt::{self, Display};
use std::path::Path;

use serde::Serialize;
use walpha_base::shown::{rounded, shown};

use crate::cli::options::preset;
use crate::cli::options::{self, InputArgs};
use crate::cli::process::errors::{CommandError, Result, command_error, option};
use crate::cli::process::progress::Progress;
use crate::export::Scratch;
use crate::interpolate::{InterpolateError, fill};
use crate::ladder::{Curve, Filtration};
use crate::pipeline::{Input, Model, Opened, PipelineError, PlacedVolume, Values, Weighed};
use crate::points::bounding_box;
use crate::progress::Stage;
use crate::shape::{ShapeError, suggested};
use crate::volume::Reason;
use crate::{
    Alpha, AlphaShape, GrayRange, LengthUnit, PointsError, Recipe, Units, Volume, VolumeError,
};

/// Numbers of a volume that are reported.
#[derive(Clone, Copy)]
pub(crate) struct VolumeSummary {
    pub dims: [usize; 3],
    /// The volume of the box between the outermost samples.
    pub extent: f64,
    pub range: GrayRange,
    pub written: GrayRange,
}

impl VolumeSummary {
    pub(crate) fn of(source: &PlacedVolume) -> Self {
        let PlacedVolume { volume, units, range, written, .. } = source;
        let extent = units.box_volume(volume);
        Self { dims: volume.dims().xyz(), extent, range: *range, written: *written }
    }
}

/// Steps 1 to 7: reads INPUT and computes weighted points, with the values that are written.
pub(crate) fn weighted_points(
    args: &InputArgs,
    recipe: &Recipe,
    progress: &mut Progress,
) -> Result<(Weighed, Option<VolumeSummary>)> {
    let (weighed, source) = points_and_volume(args, recipe, Values::Written, progress)?;
    Ok((weighed, source.as_ref().map(VolumeSummary::of)))
}

/// Computes weighted points, and returns the volume that they were selected from.
pub(crate) fn points_and_volume(
    args: &InputArgs,
    recipe: &Recipe,
    values: Values,
    progress: &mut Progress,
) -> Result<(Weighed, Option<PlacedVolume>)> {
    let mut recipe = recipe.clone();
    let read = read_suited(args, &mut recipe, progress)?;
    weigh(read, args, &recipe, values, progress)
}

/// Computes weighted points of an input that has been read, and returns the volume that they were selected from.
pub(crate) fn weigh(
    read: Input,
    args: &InputArgs,
    recipe: &Recipe,
    values: Values,
    progress: &mut Progress,
) -> Result<(Weighed, Option<PlacedVolume>)> {
    accept(&read, args)?;
    Ok(progress.watch(|| recipe.weigh(read, values))?)
}

/// Computes the shape of weighted points.
pub(crate) fn shape(weighed: Weighed, recipe: &Recipe, progress: &mut Progress) -> Result<Model> {
    progress.watch(|| recipe.finish(weighed)).map_err(|error| match error {
        PipelineError::Radii { .. } => CommandError::usage_of(error),
        _ => error.into(),
    })
}

/// Computes the filtration of weighted points with their weights; on a torus, if they lie on one.
pub(crate) fn filtration(weighed: &Weighed) -> Result<Filtration, ShapeError> {
    Stage::Filtration.begin()?;
    Filtration::on(weighed.origin.torus, weighed.points.clone())
}

/// The α of a ladder: at most `count` critical values, the suggested ones, and the α of the weights.
pub(crate) fn readable(
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

/// Reads INPUT.
pub(crate) fn read(args: &InputArgs, recipe: &Recipe, progress: &mut Progress) -> Result<Input> {
    read_with(args, progress, |input| recipe.open(input))
}

/// Reads INPUT to select points from it. If it is a CT, and no option says what to look for, the recipe is replaced by the one
/// for it ([`preset::suited`]).
pub(crate) fn read_suited(
    args: &InputArgs,
    recipe: &mut Recipe,
    progress: &mut Progress,
) -> Result<Input> {
    read_with(args, progress, |input| suited(recipe.opened(input)?, args, recipe))
}

/// Like [`read_suited`], for an INPUT that is already open.
pub(crate) fn read_opened(
    opened: Opened,
    args: &InputArgs,
    recipe: &mut Recipe,
    progress: &mut Progress,
) -> Result<Input> {
    progress.stage(Stage::Read, || suited(opened, args, recipe).map_err(unread))
}

fn suited(opened: Opened, args: &InputArgs, recipe: &mut Recipe) -> Result<Input, PipelineError> {
    let read = opened.read(recipe)?;
    if let Input::Volume(volume) = &read
        && let Some(suited) = preset::suited_to(args, recipe, volume)
    {
        *recipe = suited;
    }
    Ok(read)
}

fn read_with(
    args: &InputArgs,
    progress: &mut Progress,
    open: impl FnOnce(&Path) -> Result<Input, PipelineError>,
) -> Result<Input> {
    progress.stage(Stage::Read, || with_file(args, |input| open(input).map_err(unread)))
}

/// The error for INPUT that cannot be opened or read.
pub(crate) fn unread(error: PipelineError) -> CommandError {
    match error {
        PipelineError::Points(PointsError::File(error)) => with_points(error),
        error => error.into(),
    }
}

/// The error for a volume that cannot be read: that the file holds points, or with the formats of points if its format is unknown.
pub(crate) fn with_points(error: VolumeError) -> CommandError {
    let VolumeError::Format { path, reason: Reason::Unknown { .. } } = &error else {
        return error.into();
    };
    if let Ok(Opened::Points(_)) = Recipe::new().opened(path) {
        return command_error!("{} holds points", shown(path) => "name a volume");
    }
    let names: Vec<&str> = crate::points::FORMATS.iter().map(|format| format.name).collect();
    let said = CommandError::from(error);
    CommandError { why: format!("{}, {} as points", said.why, names.join(", ")), ..said }
}

/// Runs `work` on INPUT, a file or the name of a sample. Standard input is copied to a temporary file, because
/// formats are read in several passes.
pub(crate) fn with_file<T>(args: &InputArgs, work: impl FnOnce(&Path) -> Result<T>) -> Result<T> {
    args.check_format()?;
    if !args.input.is_stdin() {
        return work(args.input.path());
    }
    let file = Scratch::of(&mut std::io::stdin().lock(), &args.extension()).map_err(
        |error| command_error!("cannot read standard input: {error}" => "name a file instead"),
    )?;
    let path = file.path().to_string_lossy().into_owned();
    // The user does not know the name of the temporary file.
    work(file.path()).map_err(|error| {
        let named = |text: String| text.replace(&path, "standard input");
        CommandError { why: named(error.why), next: error.next.map(named), ..error }
    })
}

/// Refuses options that have no effect on this kind of INPUT.
pub(crate) fn accept(input: &Input, args: &InputArgs) -> Result<()> {
    let holds = |what| format!("{} holds {what}", args.input);
    match input {
        Input::Volume(_) => args.typed.refuse(&options::of_points(), holds("a volume")),
        Input::Points(points, facts) => {
            let what = holds("points, not a volume");
            if facts.range.is_none() {
                args.typed.refuse(&["gray_out"], &what)?;
            }
            args.typed.refuse(&options::of_volumes(), what)?;
            // A part of a molecule is read unless options ask for more.
            if let Some(molecule) = points.molecule.as_ref().filter(|molecule| molecule.is_part()) {
                tracing::info!("{}", molecule.summary().with_names(option));
            }
            Ok(())
        }
    }
}

/// The region whose share is called coverage, with its volume.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Domain {
    pub volume: f64,
    /// The unit of length; the volume is in its cube.
    pub unit: LengthUnit,
    /// The name of the region.
    pub of: &'static str,
}

impl Domain {
    /// The box between the outermost samples of a grid.
    pub(crate) fn of_grid(volume: &Volume, units: Units) -> Self {
        let unit = units.coordinates(volume).unit;
        Self { volume: units.box_volume(volume), unit, of: "the box of the samples" }
    }
}

impl Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, volume {} {}³", self.of, rounded(self.volume), self.unit.symbol())
    }
}

/// The domain of weighted points: that of their grid, the periodic box, or their own box.
pub(crate) fn domain(weighed: &Weighed, volume: Option<&VolumeSummary>) -> Domain {
    let unit = weighed.origin.coordinates.unit;
    if let Some(volume) = volume {
        return Domain { volume: volume.extent, unit, of: "the box of the samples" };
    }
    if let Some(volume) = weighed.origin.torus.and_then(|torus| torus.volume()) {
        return Domain { volume, unit, of: "the periodic box" };
    }
    let [low, high] = bounding_box(weighed.points.positions());
    let volume = [0, 1, 2].map(|k| high[k] - low[k]).iter().product();
    Domain { volume, unit, of: "the box of the points" }
}

/// Computes the filled shape of a volume's points, and the gray levels of all its points. The gray levels of the first points are
/// given, because the shape may have other values.
pub(crate) fn filled_in(
    shape: &AlphaShape,
    grays: &[f64],
    volume: &Volume,
    units: Units,
) -> Result<(AlphaShape, Vec<f64>), InterpolateError> {
    let whole = fill(shape, Some(volume), units)?;
    // The corners come after the points, and have gray levels already.
    let corners = whole.points().values().into_iter().flatten().skip(grays.len());
    let all = grays.iter().chain(corners).copied().collect();
    Ok((whole, all))
}
