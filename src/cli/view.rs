//! `walpha view`: a page to look at.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::path::PathBuf;
use std::str::FromStr;

use anyhow::bail;
use clap::Args;
use serde::Serialize;

use crate::export::Target;
use crate::interpolate::{Grid, Interpolant, InterpolateError};
use crate::ladder::Filtration;
use crate::pipeline::{AlphaRule, Parameter, Weighed};
use crate::progress::Stage;
use crate::render::{Original, Page, Subject};
use crate::shown::{number, shown};
use crate::volume::UnknownFormat;
use crate::{Alpha, GrayRange};

use super::Global;
use super::args::{self, Alphas, FrozenPipelineArgs};
use super::filled::filled_in;
use super::output::{name, tell};
use super::pipeline::{self, Input, Source, Values, VolumeFacts};
use super::progress::Progress;
use super::report::{SCHEMA_VERSION, WeightsReport};
use super::said::misused;

/// Write an interactive page for the browser: self-contained, no network needed.
///
/// A slider moves through α with the weights frozen. The boundary is coloured by F, by class, or by how
/// far the interpolant is from the volume there. Singular facets and edges, points sized by weight and
/// an isosurface of the volume can be shown or hidden.
///
/// Examples:
///
/// walpha view ct.nii.gz --gray 0..1000 --gray-min 64 --threshold 30 -o bone.html
///
/// walpha view sample:skull --weights min-max -o skull.html
///
/// walpha view scan.xyz -o scan.html
#[derive(Args)]
pub(super) struct View {
    /// Page to write (.html); an existing file is replaced.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// The α, a squared length, that the page opens at: a number, `inf`, or `auto`, the smallest at
    /// which all points are in one solid component [default: --alpha-ref].
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    alpha: Option<AlphaRule>,
    /// Stops of the slider: squared lengths, as in 1,2,5,inf; or auto, critical values that each change
    /// the picture.
    #[arg(long, value_name = "A,A,…", default_value = "auto", allow_hyphen_values = true)]
    alphas: Alphas,
    /// Level of the isosurface, for volumes: a gray level, as in 50, or a value of INPUT, as in 300v
    /// [default: 50].
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    isovalue: Option<Level>,
    #[command(flatten)]
    pipeline: FrozenPipelineArgs,
}

/// A gray level, or a value of the file: `50` or `300v`.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Level {
    /// As the wavelet stage has it.
    Gray(f64),
    /// As the file has it.
    Value(f64),
}

impl Default for Level {
    fn default() -> Self {
        Self::Gray(50.0)
    }
}

impl Level {
    /// The gray level, where values `range` are gray 0..255.
    fn gray(self, range: &GrayRange) -> f64 {
        match self {
            Self::Gray(gray) => gray,
            Self::Value(value) => range.gray(value),
        }
    }
}

impl FromStr for Level {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> anyhow::Result<Self> {
        let (number, level): (_, fn(f64) -> Self) = match text.strip_suffix('v') {
            Some(value) => (value, Self::Value),
            None => (text, Self::Gray),
        };
        match args::number(number)? {
            number if number.is_finite() => Ok(level(number)),
            _ => bail!(
                "a finite number is needed; give a gray level as in 50, or a value as in 300v"
            ),
        }
    }
}

/// Levels that `--alphas auto` chooses, suggested ones not counted.
const STOPS: usize = 28;

#[derive(Serialize)]
struct Facts {
    schema_version: u32,
    input: String,
    points: usize,
    levels: usize,
    bytes: usize,
    /// What was left out for display, if anything.
    simplified: Option<String>,
    file: String,
    seconds: BTreeMap<&'static str, f64>,
}

impl View {
    pub(super) fn run(self, global: Global) -> anyhow::Result<()> {
        let html = self.output.extension().is_some_and(|e| e.eq_ignore_ascii_case("html"));
        if !html {
            bail!(UnknownFormat::new(&self.output, "a page", ["html"]));
        }
        let target = Target::open(&self.output)?;
        let mut progress = Progress::new(global);
        let input = &self.pipeline.input;
        let read = pipeline::read(input, &mut progress)?;
        read.accepts(input)?;
        if self.isovalue.is_some() && matches!(read, Input::Points(..)) {
            misused!("--isovalue has no effect: points have no isosurface" => "omit it");
        }
        let stages = pipeline::stages(&self.pipeline);
        let select = &self.pipeline.select;
        let (weighed, source) =
            pipeline::weigh_input(read, stages, select, Values::Written, &mut progress)?;
        let filtration =
            progress.stage(Stage::Filtration, || Filtration::new(weighed.points.clone()))?;
        let page = self.page(&weighed, source.as_ref(), &filtration, &mut progress)?;
        if !global.quiet {
            let size = page.html.len() as f64 / 1e6;
            eprintln!("walpha: {} takes {size:.1} MB", shown(&self.output));
            if let Some(told) = &page.simplified {
                eprintln!("walpha: {told}");
            }
        }
        progress.stage(Stage::Write, || target.write(|out| out.write_all(page.html.as_bytes())))?;
        let facts = Facts {
            schema_version: SCHEMA_VERSION,
            input: self.pipeline.input.input,
            points: filtration.points().len(),
            levels: page.levels,
            bytes: page.html.len(),
            simplified: page.simplified,
            file: self.output.display().to_string(),
            seconds: progress.finish().into_iter().collect(),
        };
        tell(global, &facts)
    }

    /// The page of the shapes in a filtration.
    fn page(
        &self,
        weighed: &Weighed,
        source: Option<&Source>,
        filtration: &Filtration,
        progress: &mut Progress,
    ) -> anyhow::Result<Page> {
        let unit = weighed.origin.coordinates.unit;
        let facts = source.map(|source| &source.facts);
        let domain = pipeline::domain(weighed, facts);
        let found = || Parameter::of_filtration(filtration, unit);
        let reference = weighed.parameter.unwrap_or_else(found);
        let told = self.told(weighed, facts, reference);
        let opening = match self.alpha {
            None => reference.alpha,
            Some(asked) => asked.given(unit).unwrap_or_else(found).alpha,
        };
        let original = source.map(|Source { volume, facts }| Original {
            volume,
            isovalue: self.isovalue.unwrap_or_default().gray(&facts.range),
            units: facts.units,
        });
        let alphas = match &self.alphas {
            Alphas::Given(alphas) => [&alphas[..], self.alpha.map(|_| opening).as_slice()].concat(),
            Alphas::Auto => progress.stage(Stage::Curve, || stops(filtration, opening)),
        };
        let levels = filtration.levels(&alphas);
        if levels.len() > Page::MOST_LEVELS {
            let (levels, most) = (levels.len(), Page::MOST_LEVELS);
            misused!("{levels} levels are too many for a page" => "give --alphas at most {most}");
        }
        let ladder = progress.stage(Stage::Ladder, || levels.ladder(domain.volume));
        // That level, or the last below it.
        let first = levels.alphas().partition_point(|alpha| *alpha <= opening);
        let title = format!("Alpha shapes of {}", self.pipeline.input.input);
        let differences = match source {
            Some(source) => differences(weighed, source, filtration)?,
            None => None,
        };
        let subject = Subject {
            title: &title,
            differences: differences.as_ref().map(|(differences, unit)| (&differences[..], *unit)),
            facts: &told,
            unit: unit.symbol(),
            value: match facts {
                Some(facts) if facts.written == GrayRange::IDENTITY => {
                    "value of the original volume, in gray levels"
                }
                Some(_) => "value of the original volume",
                None => "the column value of the input",
            },
            levels: &levels,
            ladder: &ladder,
            first: first.saturating_sub(1),
            original,
        };
        Ok(progress.stage(Stage::Page, || Page::new(&subject))?)
    }

    /// What the page shows besides the levels' numbers.
    fn told(
        &self,
        weighed: &Weighed,
        volume: Option<&VolumeFacts>,
        reference: Parameter,
    ) -> Vec<(String, String)> {
        let mut told = vec![("input".to_owned(), self.pipeline.input.input.clone())];
        if let Some((volume, t)) = volume.zip(weighed.origin.truncation.as_ref()) {
            let [x, y, z] = volume.dims;
            let (low, high) = (number(volume.range.low), number(volume.range.high));
            told.push((
                "volume".into(),
                format!("{x}×{y}×{z} samples, values {low} to {high} are gray 0 to 255"),
            ));
            told.push((
                "Haar".into(),
                format!(
                    "{} of {} coefficients kept, rms {:.4} gray levels",
                    t.kept, t.total, t.rms
                ),
            ));
        }
        told.push(("points".into(), weighed.points.len().to_string()));
        told.push(("lengths in".into(), weighed.origin.coordinates.to_string()));
        told.push((
            "weights ω".into(),
            format!("{}, frozen at {reference}", WeightsReport::of(weighed)),
        ));
        told.push(("made by".into(), format!("walpha {}", env!("CARGO_PKG_VERSION"))));
        told
    }
}

/// How far the interpolant, filled in, is from the volume around each point, and in what; `None` where the
/// points span no volume.
fn differences(
    weighed: &Weighed,
    source: &Source,
    filtration: &Filtration,
) -> anyhow::Result<Option<(Vec<f64>, &'static str)>> {
    let Source { volume, facts: VolumeFacts { units, written, .. } } = source;
    let Some(values) = &weighed.points.values else { return Ok(None) };
    let grays: Vec<f64> = values.iter().map(|&value| written.gray(value)).collect();
    let hull = filtration.levels(&[Alpha::INFINITE]);
    let hull = hull.shape(0, false, hull.betti()[0]);
    let (whole, grays) = match filled_in(&hull, &grays, volume, *units) {
        Err(InterpolateError::Shape(error)) if error.is_flat() => return Ok(None),
        filled => filled?,
    };
    let interpolant = Interpolant::with_values(&whole, &grays)?;
    let mut differences = interpolant.local_deviations(volume, &Grid::of(volume, *units))?;
    differences.truncate(weighed.points.len());
    differences.iter_mut().for_each(|difference| *difference *= written.step());
    let unit = if *written == GrayRange::IDENTITY { "gray levels" } else { "values of the file" };
    Ok(Some((differences, unit)))
}

/// Levels that each show something, and something else than the one before: the one to open at,
/// suggested ones, and others between.
fn stops(filtration: &Filtration, opening: Alpha) -> Vec<Alpha> {
    let curve = filtration.curve();
    let mut alphas = filtration.stops(&curve, STOPS);
    alphas.push(opening);
    alphas.extend(pipeline::suggested(filtration, &curve));
    let distinct = filtration.levels(&alphas).distinct(opening);
    if distinct.is_empty() { vec![opening] } else { distinct }
}

impl Display for Facts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "input     {}", name(&self.input))?;
        writeln!(f, "points    {}", self.points)?;
        writeln!(f, "levels    {}", self.levels)?;
        if let Some(told) = &self.simplified {
            writeln!(f, "page      {told}")?;
        }
        writeln!(f, "wrote     {}, {:.1} MB", name(&self.file), self.bytes as f64 / 1e6)?;
        let total = self.seconds.get("total").copied().unwrap_or_default();
        writeln!(f, "time      total {total:.2} s")
    }
}
