//! `walpha interpolate`: samples F on a grid and measures its error; or, with `--curve`, measures the error against the number of
//! points.

use std::fmt::{self, Display};
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use walpha_base::number_or_null_or_name;
use walpha_base::shown::rounded;

use crate::cli::commands::folder;
use crate::cli::commands::pipeline::{self, VolumeSummary, read};
use crate::cli::options::formats::volume_output;
use crate::cli::options::global::Global;
use crate::cli::options::preset;
use crate::cli::options::{Declared, OfShape, OutputArgs, PipelineArgs, one_alpha};
use crate::cli::process::errors::{CommandError, Result, fail, fail_usage};
use crate::cli::process::output::{name, print_summary};
use crate::cli::process::progress::Progress;
use crate::cli::report::{Report, SCHEMA_VERSION};
use crate::export::{Content, NewFolder, Target, TargetError, write_all};
use crate::haar::smooth;
#[cfg(feature = "render")]
use crate::interpolate::error_figure;
use crate::interpolate::{
    CurveOptions, CurvePoint, Deviation, Grid, Interpolant, Resampled, error_curve, fill,
    write_curve_csv,
};
use crate::pipeline::{Input, PipelineError, PlacedVolume, Values, Weighed};
use crate::progress::Stage;
use crate::volume::{Labels, VolumeWriter};
use crate::{AlphaShape, Dims, GrayRange, LengthUnit, SelectionRule, Units, Volume, Weighting};

/// Interpolate the values of points on their shape, and measure the error.
///
/// F is linear on each cell of the shape, and on facets, edges and vertices that are not faces of one. It
/// is sampled on the grid of the volume or, with --dims, on another grid over the same extent; samples
/// outside the shape have the lowest value: gray 0 of a volume, or the least of the points. The error
/// is measured on the samples of INPUT that the shape covers; PSNR is relative to gray 255. Hidden points
/// carry no value. Points without a volume need --dims, a grid over their box; a .wvm file states the grid
/// of which its points are samples.
///
/// With --curve, instead: error and coverage against the number of points, from a sixteenth to twice those
/// selected, for each selection method and the weights common=0, min-max and barycentric, as
#[cfg_attr(feature = "render", doc = " CSV, PNG and SVG.")]
#[cfg_attr(not(feature = "render"), doc = " CSV.")]
///
/// Examples:
///
/// walpha interpolate ct.nii.gz --select adaptive --count 100000 --fill -o c.nii.gz
///
/// walpha interpolate scattered.csv --dims 64,64,64 -o grid.nrrd   # points to a grid
///
/// walpha interpolate sample:skull --curve -o curves/   # error by size
#[derive(Args)]
#[command(mut_arg("dims", |arg| {
    arg.requires(clap::builder::Resettable::<clap::Id>::Reset)
        .help("Sample F at this many places along x, y and z; with --dtype: the sizes of a raw file")
        .help_heading("Grid")
}))]
pub(crate) struct Interpolate {
    #[arg(short, long, value_name = "FILE", help = output_help())]
    output: Option<PathBuf>,
    /// Mask to write: 1 where a sample is on the shape, otherwise 0; formats as for the output.
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,
    /// Interpolate everywhere: on the whole triangulation (α = inf) of the points and the 8 corners of the
    /// volume, which get their own values and the least weight of the points.
    #[arg(long, conflicts_with = "memory")]
    fill: bool,
    /// Measure error against the number of points.
    #[arg(long, requires = "output", conflicts_with_all = [
        "mask", "fill", "select", "target_rmse", "max_error", "exchange", "threshold", "gray_min", "value_min", "refit", "weights", "balls",
        "engine", "blocks", "memory", "exterior", "hidden", "gray_out", "output_format",
    ])]
    curve: bool,
    #[command(flatten)]
    pipeline: PipelineArgs,
    #[command(flatten)]
    shape: Declared<OfShape>,
    #[command(flatten)]
    format: OutputArgs,
}

#[derive(Serialize)]
struct InterpolateSummary {
    #[serde(flatten)]
    report: Report,
    interpolation: Interpolation,
}

/// The samples, and their error if there is a volume to compare with.
#[derive(Serialize)]
struct Interpolation {
    /// The number of samples written along x, y and z.
    grid: [usize; 3],
    /// The number of samples on the shape.
    on_shape: usize,
    /// The error on the samples of INPUT that the shape covers; null for points.
    inside: Option<Error>,
    /// The error on all samples of INPUT; null without `--fill`, and for points.
    filled: Option<Error>,
}

#[derive(Serialize)]
struct Error {
    #[serde(flatten)]
    deviation: Deviation,
    /// The error in values of INPUT; null if these are gray levels.
    rmse_in_values: Option<f64>,
    max_in_values: Option<f64>,
    /// The share of samples on the shape.
    covered_share: f64,
    /// The PSNR in decibels; "inf" if nothing differs.
    #[serde(serialize_with = "number_or_null_or_name")]
    psnr: Option<f64>,
}

impl Error {
    fn new(deviation: Deviation, range: &GrayRange) -> Self {
        let in_values = (!range.is_identity()).then(|| deviation.scaled(range.step()));
        Self {
            deviation,
            rmse_in_values: in_values.and_then(|d| d.rmse),
            max_in_values: in_values.and_then(|d| d.max),
            covered_share: deviation.covered_share(),
            psnr: deviation.psnr(),
        }
    }
}

fn output_help() -> String {
    let files = volume_output("Volume to write F to");
    format!("{files}. With --curve: a folder, or the prefix of file names")
}

impl Interpolate {
    pub(crate) fn run(self, global: Global) -> Result<()> {
        if self.curve {
            if self.pipeline.input.grid().is_some() {
                fail_usage!("--curve measures on the samples of INPUT" => "omit --dims");
            }
            let base = self.output.as_deref().expect("clap requires it");
            return run_curve(global, &self.pipeline, base);
        }
        self.format.check(self.output.iter())?;
        let recipe = self.pipeline.recipe()?;
        let output = match &self.output {
            None => None,
            Some(path) => Some((VolumeWriter::of(&self.format.named(path)?)?, Target::open(path)?)),
        };
        let mask = self.mask.as_deref().map(open).transpose()?;
        let mut progress = Progress::new(global);
        let input = &self.pipeline.input;
        let (weighed, source) =
            pipeline::points_and_volume(input, &recipe, Values::Gray, &mut progress)?;
        let original = source.as_ref();
        let facts = original.map(VolumeSummary::of);
        let mut report = Report::of_points(&input.input, &weighed, facts.as_ref());
        report.example = "values.nrrd (or .nii.gz, .npy)";
        let grid = self.grid(original, &weighed)?;
        let written = original.map(|original| original.written).or(weighed.origin.range);
        // Without gray levels, 0 is as good a value of a point as any.
        let lowest = weighed.points.values().filter(|_| written.is_none());
        let lowest = lowest.and_then(|values| values.iter().copied().reduce(f64::min));
        let model = pipeline::shape(weighed, &recipe, &mut progress)?;
        report.add_model(&model)?;
        let shape = model.shape;
        let sampled = progress.stage(Stage::Interpolate, || sample(&shape, &grid, original))?;
        let on_shape = sampled.resampled.covered();
        if on_shape == 0 && !self.fill {
            tracing::warn!(
                "no sample of the grid lies on the shape: give a larger --alpha, or --fill"
            );
        }
        let mask = mask
            .map(|open| Ok::<_, CommandError>((open, sampled.resampled.mask()?)))
            .transpose()?;
        let (inside, filled, resampled) = if self.fill {
            let units = original.map_or(Units::Voxel, |original| original.units);
            let whole = progress.stage(Stage::Fill, || {
                fill(&shape, original.map(|original| &original.volume), units)
            })?;
            let filled = progress.stage(Stage::Interpolate, || sample(&whole, &grid, original))?;
            let left = grid.dims().samples() - filled.resampled.covered();
            if left > 0 {
                tracing::warn!(
                    "{left} samples of the grid lie outside the convex hull of the points, and get the lowest value: only points that \
                     `--select adaptive` chooses have the corners of their volume"
                );
            }
            (sampled.error, filled.error, filled.resampled)
        } else {
            (sampled.error, None, sampled.resampled)
        };
        progress.stage(Stage::Write, || {
            let (mask, inside) = mask.unzip();
            let written = written.unwrap_or(GrayRange::IDENTITY);
            let resampled = match lowest {
                Some(lowest) => resampled.with_outside(lowest as f32),
                None => resampled,
            };
            let values = resampled.into_volume().into_values(&written);
            write([(output, Some(&values)), (mask, inside.as_ref())])
        })?;
        let files = self.output.iter().chain(&self.mask).map(|path| path.display().to_string());
        report.finish(progress.finish(), files.collect());
        let grid = grid.dims().xyz();
        print_summary(
            global,
            &InterpolateSummary {
                report,
                interpolation: Interpolation { grid, on_shape, inside, filled },
            },
        )
    }

    /// The requested grid.
    fn grid(&self, original: Option<&PlacedVolume>, weighed: &Weighed) -> Result<Grid> {
        let asked = self.pipeline.input.grid();
        asked.map(Dims::bounded).transpose()?;
        match (original, weighed.origin.grid, asked) {
            (Some(&PlacedVolume { ref volume, units, .. }), _, None) => Ok(Grid::of(volume, units)),
            (Some(&PlacedVolume { ref volume, units, .. }), _, Some(dims)) => {
                Ok(Grid::over(volume, dims, units)?)
            }
            (None, Some(samples), asked) => {
                Ok(Grid::over_samples(&samples, asked.unwrap_or(samples.dims))?)
            }
            (None, None, Some(dims)) => {
                let positions = weighed.points.positions();
                let end = |f: fn(f64, f64) -> f64| {
                    let join = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| f(a[k], b[k]));
                    positions.iter().copied().reduce(join).unwrap_or_default()
                };
                Ok(Grid::spanning(end(f64::min), end(f64::max), dims)?)
            }
            (None, None, None) => {
                fail!("{} holds points, which have no grid of their own", self.pipeline.input.input => "give --dims X,Y,Z")
            }
        }
    }
}

/// The values of F on the requested grid, and their error on the grid of INPUT.
struct Sampled {
    resampled: Resampled,
    error: Option<Error>,
}

fn sample(shape: &AlphaShape, grid: &Grid, original: Option<&PlacedVolume>) -> Result<Sampled> {
    let interpolant = Interpolant::new(shape)?;
    let resampled = interpolant.resample(grid)?;
    let error = match original {
        None => None,
        Some(&PlacedVolume { ref volume, units, range, .. }) => {
            let deviation = if volume.dims() == grid.dims() {
                Deviation::of(volume, &resampled)
            } else {
                Deviation::of(volume, &interpolant.resample(&Grid::of(volume, units))?)
            };
            Some(Error::new(deviation, &range))
        }
    };
    Ok(Sampled { resampled, error })
}

/// The destination of a volume.
type Output = (&'static VolumeWriter, Target);

fn open(path: &Path) -> Result<Output> {
    Ok((VolumeWriter::of(path)?, Target::open(path)?))
}

/// Writes each volume that has a destination.
fn write(volumes: [(Option<Output>, Option<&Volume>); 2]) -> Result<(), TargetError> {
    write_all(volumes.into_iter().filter_map(|(output, volume)| {
        let ((format, target), volume) = (output?, volume?);
        let content = move |out: &mut dyn Write| format.write(volume, out);
        Some((target, Box::new(content) as Content<'_>))
    }))
}

impl Display for InterpolateSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Interpolation { grid: [x, y, z], on_shape, inside, filled } = &self.interpolation;
        if f.alternate() {
            write!(f, "{:#}", self.report)?;
        } else {
            write!(f, "{}", self.report)?;
        }
        writeln!(f, "grid      {x}×{y}×{z} samples, {on_shape} on the shape")?;
        for (what, error) in [("inside", inside), ("filled", filled)] {
            if let Some(error) = error {
                writeln!(f, "{what:<10}{error}")?;
            }
        }
        Ok(())
    }
}

impl Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Deviation { samples, rmse, max, .. } = self.deviation;
        write!(f, "{:.2} % of {samples} samples", 100.0 * self.covered_share)?;
        if let (Some(rmse), Some(max), Some(psnr)) = (rmse, max, self.psnr) {
            let (rmse, max) = (rounded(rmse), rounded(max));
            write!(f, ", RMSE {rmse}, largest error {max} gray levels")?;
            if let (Some(rmse), Some(max)) = (self.rmse_in_values, self.max_in_values) {
                write!(f, " ({} and {} in values)", rounded(rmse), rounded(max))?;
            }
            write!(f, ", PSNR {psnr:.2} dB")?;
        }
        Ok(())
    }
}

#[derive(Serialize)]
struct CurveSummary {
    schema_version: u32,
    input: String,
    /// α as a squared length, in the square of `unit`.
    alpha: f64,
    unit: LengthUnit,
    curve: Vec<CurvePoint>,
    files: Vec<String>,
    seconds: f64,
}

/// Measures the curve and writes it as CSV, PNG and SVG.
pub(crate) fn run_curve(global: Global, pipeline: &PipelineArgs, base: &Path) -> Result<()> {
    let PipelineArgs { input, .. } = pipeline;
    let recipe = pipeline.recipe()?;
    let (new, paths) = paths(base)?;
    let targets = paths.iter().map(Target::open).collect::<Result<Vec<_>, _>>()?;
    let mut progress = Progress::new(global);
    let Input::Volume(volume) = read(input, &recipe, &mut progress)? else {
        fail!("{} holds points, and --curve needs a volume", input.input);
    };
    if !preset::looks_for_gray_levels(input) && Labels::of_volume(&volume).is_some() {
        return Err(PipelineError::OfLabels.into());
    }
    let source = recipe.source(volume)?;
    let PlacedVolume { ref volume, units, range, .. } = source;
    let (smoothed, _) = progress.stage(Stage::Haar, || smooth(volume, &recipe.haar))?;
    let options = CurveOptions {
        counts: counts(volume, input.settings().rule())?,
        weightings: vec![Weighting::Common(0.0), Weighting::MinMax, Weighting::Barycentric],
        alpha: one_alpha(recipe.alpha, &source)?.alpha,
        units,
    };
    let curve = progress.stage(Stage::Curve, || error_curve(volume, &smoothed, &options))?;
    let mut csv = Vec::new();
    write_curve_csv(&curve, range.step(), &mut csv)?;
    let alpha = options.alpha.squared();
    #[cfg(feature = "render")]
    let figure = error_figure(&format!("Error against points: {}", input.input), alpha, &curve);
    let files = [
        csv,
        #[cfg(feature = "render")]
        figure.to_png()?,
        #[cfg(feature = "render")]
        figure.to_svg()?.into_bytes(),
    ];
    write_all(targets.into_iter().zip(&files).map(|(target, bytes)| {
        let content = |out: &mut dyn Write| out.write_all(bytes);
        (target, Box::new(content) as Content<'_>)
    }))?;
    if let Some(new) = new {
        new.keep();
    }
    let seconds = progress.total();
    let facts = CurveSummary {
        schema_version: SCHEMA_VERSION,
        input: input.input.to_string(),
        alpha,
        unit: units.coordinates(volume).unit,
        curve,
        files: paths.iter().map(|path| path.display().to_string()).collect(),
        seconds,
    };
    print_summary(global, &facts)
}

/// The numbers of points: from a sixteenth to twice those that would be selected.
fn counts(volume: &Volume, rule: SelectionRule) -> Result<Vec<u64>> {
    let whole = match rule {
        SelectionRule::Count(count) => count as f64,
        SelectionRule::Ratio(ratio) | SelectionRule::AtMost(ratio) => {
            ratio * volume.dims().samples() as f64
        }
        SelectionRule::Threshold(_) => {
            fail_usage!("--curve needs a number of points" => "give --count or --ratio")
        }
    };
    Ok([0.0625, 0.125, 0.25, 0.5, 1.0, 2.0].map(|f| (f * whole).round() as u64).into())
}

/// The formats of the curve.
const EXTENSIONS: &[&str] = &[
    "csv",
    #[cfg(feature = "render")]
    "png",
    #[cfg(feature = "render")]
    "svg",
];

/// The paths of `curve.csv`, `.png` and `.svg` in a folder, which is created if its name ends with a slash; or of files with the
/// given prefix.
fn paths(base: &Path) -> Result<(Option<NewFolder>, Vec<PathBuf>)> {
    let asked = base.to_string_lossy().ends_with(['/', std::path::MAIN_SEPARATOR]);
    let new = if asked { folder::make(base, "with --curve")? } else { None };
    let stem = if base.is_dir() {
        base.join("curve")
    } else if EXTENSIONS.iter().any(|known| base.extension().is_some_and(|e| e == *known)) {
        base.with_extension("")
    } else {
        base.to_owned()
    };
    let named = |extension: &&str| {
        let mut path = stem.clone().into_os_string();
        path.push(".");
        path.push(extension);
        path.into()
    };
    Ok((new, EXTENSIONS.iter().map(named).collect()))
}

impl Display for CurveSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = self.unit.symbol();
        let input = name(&self.input);
        let alpha = rounded(self.alpha);
        writeln!(f, "input     {input}, α = {alpha} {unit}² (squared length)")?;
        writeln!(
            f,
            "{:<20}{:<12}{:>8}{:>8}{:>11}{:>13}{:>13}",
            "method", "weights", "count", "hidden", "covered", "RMSE inside", "RMSE filled"
        )?;
        let number =
            |rmse: Option<f64>| rmse.map_or_else(|| "–".into(), |rmse| format!("{rmse:.3}"));
        for point in &self.curve {
            writeln!(
                f,
                "{:<20}{:<12}{:>8}{:>8}{:>9.2} %{:>13}{:>13}",
                point.method.to_string(),
                point.weighting.map_or_else(|| "–".into(), |w| w.to_string()),
                point.count,
                point.hidden,
                100.0 * point.inside.covered_share(),
                number(point.inside.rmse),
                number(point.filled.rmse)
            )?;
        }
        for file in &self.files {
            writeln!(f, "wrote     {}", name(file))?;
        }
        writeln!(f, "time      total {:.2} s", self.seconds)
    }
}
