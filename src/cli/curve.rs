//! `walpha interpolate --curve`: error against the number of points.

use std::fmt::{self, Display};
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::export::{Content, NewFolder, Target, write_all};
use crate::haar::smooth_monitored;
#[cfg(feature = "render")]
use crate::interpolate::error_figure;
use crate::interpolate::{CurveOptions, CurvePoint, error_curve, write_curve_csv};
use crate::pipeline::{Input, Source};
use crate::progress::Stage;
use crate::{LengthUnit, SelectionRule, Volume, Weighting};

use super::args::{PipelineArgs, SelectArgs, one_alpha};
use super::output::{name, tell};
use super::pipeline::read;
use super::progress::Progress;
use super::report::SCHEMA_VERSION;
use super::said::{misused, refused};
use super::{Global, folder};

#[derive(Serialize)]
struct CurveSummary {
    schema_version: u32,
    input: String,
    /// Squared, in the square of the unit.
    alpha: f64,
    unit: LengthUnit,
    curve: Vec<CurvePoint>,
    files: Vec<String>,
    seconds: f64,
}

/// Measures the curve and writes it as CSV, PNG and SVG.
pub(super) fn run(global: Global, pipeline: &PipelineArgs, base: &Path) -> anyhow::Result<()> {
    let PipelineArgs { input, select, .. } = pipeline;
    let recipe = pipeline.recipe()?;
    let (new, paths) = paths(base)?;
    let targets = paths.iter().map(|path| Target::open(path)).collect::<Result<Vec<_>, _>>()?;
    let mut progress = Progress::new(global);
    let Input::Volume(grays) = read(input, &recipe, &mut progress)? else {
        refused!("{} holds points, and --curve needs a volume", input.input);
    };
    let source = recipe.source(grays)?;
    let Source { ref volume, units, range, .. } = source;
    let monitor = progress.monitor();
    let (smoothed, _) =
        progress.stage(Stage::Haar, || smooth_monitored(volume, &recipe.haar, &monitor))?;
    let options = CurveOptions {
        counts: counts(volume, select)?,
        weightings: vec![Weighting::Common(0.0), Weighting::MinMax, Weighting::Barycentric],
        alpha: one_alpha(recipe.alpha, &source)?.alpha,
        units,
    };
    let curve =
        progress.stage(Stage::Curve, || error_curve(volume, &smoothed, &options, &monitor))?;
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
    tell(global, &facts)
}

/// From a sixteenth to twice the points that would be selected.
fn counts(volume: &Volume, select: &SelectArgs) -> anyhow::Result<Vec<u64>> {
    let whole = match select.rule() {
        SelectionRule::Count(count) => count as f64,
        SelectionRule::Ratio(ratio) | SelectionRule::AtMost(ratio) => {
            ratio * volume.dims().samples() as f64
        }
        SelectionRule::Threshold(_) => {
            misused!("--curve needs a number of points" => "give --count or --ratio")
        }
    };
    Ok([0.0625, 0.125, 0.25, 0.5, 1.0, 2.0].map(|f| (f * whole).round() as u64).into())
}

/// What the curve is written as.
const EXTENSIONS: &[&str] = &[
    "csv",
    #[cfg(feature = "render")]
    "png",
    #[cfg(feature = "render")]
    "svg",
];

/// `curve.csv`, `.png` and `.svg` in a folder, made if it is not there, or files whose names begin as
/// given.
fn paths(base: &Path) -> anyhow::Result<(Option<NewFolder>, Vec<PathBuf>)> {
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
        writeln!(f, "input     {input}, α = {} {unit}² (squared length)", self.alpha)?;
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
