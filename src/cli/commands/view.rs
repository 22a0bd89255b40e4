//! `walpha view`: writes an interactive page.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Display};
use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use serde::Serialize;
use walpha_base::shown::{number, rounded};

use crate::cli::commands::pipeline::{self, VolumeSummary, filled_in};
use crate::cli::options::global::Global;
use crate::cli::options::{self, Alphas, Declared, FrozenPipelineArgs, Periodic};
use crate::cli::process::errors::{CommandError, Result, fail, fail_usage};
use crate::cli::process::output::{OF_OUTPUTS, name, print_summary};
use crate::cli::process::progress::Progress;
use crate::cli::process::usage;
use crate::cli::report::{SCHEMA_VERSION, WeightsReport};
use crate::export::Target;
use crate::interpolate::{Deviation, Grid, Interpolant};
use crate::ladder::Filtration;
use crate::pictures;
use crate::pipeline::{AlphaRule, Input, Parameter, PlacedVolume, Values, Weighed};
use crate::points::colours::{
    CLASS_COLUMN, COLOUR_COLUMNS, has_classes, scan_classes, scan_colours,
};
use crate::points::{Attributes, Cell, Column, Element, Molecule, ScanSummary};
use crate::progress::Stage;
use crate::render::{self, Differences, Kinds, Original, Page, Subject};
use crate::shape::Kept;
use crate::volume::UnknownFormat;
use crate::{Alpha, Frame, GrayRange, Recipe, Units};

/// Write an interactive page for the browser: self-contained, no network needed.
///
/// A slider moves through α with the weights frozen. Colours show classes, F, weights, or the
/// local difference between interpolant and volume (absent if only one tissue was selected). Singular
/// facets and edges, points sized by weight, their balls and an isosurface of the volume can be shown
/// or hidden, and a plane cuts the shape open.
///
/// Examples:
///
/// walpha view ct.nii.gz -o bone.html   # bone, if its values are Hounsfield units
///
/// walpha view sample:skull --weights min-max --counts 1000,4000 -o skull.html   # with detail
///
/// walpha view scan.xyz -o scan.html   # points
#[derive(Args)]
pub(crate) struct View {
    /// Page to write (.html); an existing file is replaced.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// The α, a squared length, that the page opens at; as for `walpha shape` [default: --alpha-ref].
    #[arg(long, value_name = "A")]
    alpha: Option<AlphaRule>,
    /// The radius of the ball that the page opens at, √α.
    #[arg(long, visible_alias = "radius", value_name = "R", conflicts_with = "alpha", value_parser = options::radius)]
    alpha_radius: Option<Alpha>,
    /// Stops of the slider: squared lengths, as in 1,2,5,inf; or auto, critical values that each change
    /// the picture.
    #[arg(long, value_name = "A,A,…", default_value = "auto", allow_hyphen_values = true)]
    alphas: Alphas,
    /// Further levels of detail to switch between: numbers of points, as in `walpha ladder --counts`.
    #[arg(long, value_name = "N,N,…", value_delimiter = ',', value_parser = clap::value_parser!(u64).range(1..))]
    counts: Vec<u64>,
    /// Level of the isosurface, for volumes: a gray level, as in 50, or a value of INPUT, as in 300v
    /// [default: 50].
    #[arg(long, value_name = "G")]
    isovalue: Option<Isovalue>,
    #[command(flatten)]
    pipeline: FrozenPipelineArgs,
    #[command(flatten)]
    periodic: Declared<Periodic>,
    /// The page shows their points alone.
    #[command(flatten)]
    kept: Declared<options::Kept>,
}

/// What points come from.
struct Source {
    volume: Option<PlacedVolume>,
    /// Whether points were selected among the samples of a tissue alone. F then says nothing of the rest of the volume.
    is_of_tissue: bool,
    /// Without a volume, what the values of the points are.
    column: String,
    /// The elements of points that are atoms.
    atoms: Option<Kinds>,
    /// The classes and colours of points of a laser scan.
    classes: Option<Kinds>,
    colours: Option<Vec<[u8; 3]>>,
}

fn elements_of(molecule: &Molecule) -> Kinds {
    let elements = || molecule.atoms.iter().map(|atom| atom.element);
    let known: BTreeSet<Element> = elements().flatten().collect();
    Kinds {
        numbers: elements().map(|element| element.map_or(0, Element::number)).collect(),
        known: known.iter().map(|e| (e.number(), e.symbol(), e.colour())).collect(),
    }
}

fn classes_of(columns: &[Column]) -> Option<Kinds> {
    let numbers = scan_classes(columns).filter(|classes| has_classes(classes))?;
    let known: BTreeSet<u8> = numbers.iter().copied().collect();
    let kind = |class| (class, ScanSummary::class_name(class), ScanSummary::class_colour(class));
    Some(Kinds { numbers, known: known.into_iter().map(kind).collect() })
}

impl View {
    /// The α that the page opens at, if one is given.
    fn opening_alpha(&self) -> Option<AlphaRule> {
        self.alpha_radius.map(AlphaRule::Given).or(self.alpha)
    }

    pub(crate) fn run(self, global: Global) -> Result<()> {
        let html = self.output.extension().is_some_and(|e| e.eq_ignore_ascii_case("html"));
        if !html {
            let error = UnknownFormat::new(&self.output, "a page", ["html"]);
            let [input, output] =
                [&*self.pipeline.input.input, &self.output.to_string_lossy()].map(usage::quoted);
            let mut next = "-o page.html".to_owned();
            let extension = self.output.extension().unwrap_or_default();
            if super::shape::extensions().any(|known| extension.eq_ignore_ascii_case(known)) {
                next +=
                    &format!("; a mesh or picture is written by walpha shape {input} -o {output}");
            }
            return Err(CommandError { next: Some(next), ..error.into() });
        }
        let recipe = self.pipeline.recipe()?;
        if recipe.periodic.is_some() && !self.counts.is_empty() {
            fail_usage!("levels of detail are of volumes, and points repeat in a periodic box" => "omit --counts");
        }
        let target = Target::open(&self.output)?;
        let mut progress = Progress::new(global);
        let (weighed, source) = self.weighed(&mut progress)?;
        let details = weighed.into_iter().map(|weighed| {
            let compared = source.volume.as_ref().filter(|_| !source.is_of_tissue);
            let detail = Detail::new(weighed, compared, &mut progress)?;
            if recipe.keep.is_all() {
                Ok(detail)
            } else {
                detail.part(&recipe, self.opening_alpha(), &mut progress)
            }
        });
        let details = details.collect::<Result<Vec<_>>>()?;
        let (page, facts) = self.page(&details, &source, &mut progress)?;
        if let Some(simplified) = &page.simplified {
            tracing::info!(target: OF_OUTPUTS, "{simplified}");
        }
        progress.stage(Stage::Write, || target.write(|out| out.write_all(page.html.as_bytes())))?;
        let facts = ViewSummary {
            schema_version: SCHEMA_VERSION,
            input: self.pipeline.input.input.to_string(),
            details: facts,
            bytes: page.html.len(),
            simplified: page.simplified,
            file: self.output.display().to_string(),
            seconds: progress.finish().into_iter().collect(),
        };
        print_summary(global, &facts)
    }

    /// The weighted points of each level of detail, the fewest first and those of the shape last, and what they come from.
    fn weighed(&self, progress: &mut Progress) -> Result<(Vec<Weighed>, Source)> {
        let input = &self.pipeline.input;
        let mut recipe = self.pipeline.recipe()?;
        let shown = [CLASS_COLUMN].into_iter().chain(COLOUR_COLUMNS).map(str::to_owned);
        recipe = recipe.attributes(Attributes::IfThere(shown.collect()));
        let read = pipeline::read_suited(input, &mut recipe, progress)?;
        pipeline::accept(&read, input)?;
        let volume = match read {
            Input::Points(mut points, facts) => {
                if self.isovalue.is_some() {
                    fail_usage!("--isovalue has no effect: points have no isosurface" => "omit it");
                }
                if !self.counts.is_empty() {
                    fail_usage!("--counts chooses samples of a volume, and {} holds points", input.input => "omit it");
                }
                // Scans are seen by height, unless values have a purpose.
                let by_height = facts.scan.is_some() && recipe.weighting.is_none();
                if by_height && recipe.value.is_none() {
                    points.values = points.column("height").map(Cow::into_owned);
                    recipe.value = Some("height".into());
                }
                let column = recipe.value.clone().unwrap_or_else(|| "value".into());
                let atoms = points.molecule.as_ref().map(elements_of);
                let columns = std::mem::take(&mut points.columns);
                let of_scan = || facts.scan.is_some().then_some(&columns[..]);
                let classes = of_scan().and_then(classes_of);
                let colours = of_scan().and_then(scan_colours);
                let read = Input::Points(points, facts);
                let weigh = || recipe.weigh(read, Values::Written);
                let (weighed, _) = progress.watch(weigh)?;
                let column = format!("the column {column} of the input");
                let (volume, is_of_tissue) = (None, false);
                let source = Source { volume, is_of_tissue, column, atoms, classes, colours };
                return Ok((vec![weighed], source));
            }
            Input::Volume(volume) => volume,
        };
        let source = recipe.source(volume)?;
        let mut counts = self.counts.clone();
        counts.sort_unstable();
        counts.dedup();
        let whole = progress.watch(|| recipe.weighed(&source, Values::Written))?;
        let level = |count| progress.watch(|| recipe.level(&source, &whole, count));
        let mut details = counts.into_iter().map(level).collect::<Result<Vec<_>, _>>()?;
        details.push(whole);
        let selection = recipe.selection(&source.range);
        let of_points = Source {
            is_of_tissue: selection.is_some_and(|selection| selection.gray_min.is_some()),
            volume: Some(source),
            column: String::new(),
            atoms: None,
            classes: None,
            colours: None,
        };
        Ok((details, of_points))
    }

    /// Makes the page of the shapes, and a summary of each level of detail.
    fn page(
        &self,
        details: &[Detail],
        source: &Source,
        progress: &mut Progress,
    ) -> Result<(Page, Vec<DetailSummary>)> {
        let Source { volume: source, column, atoms, classes, colours, .. } = source;
        let source = source.as_ref();
        let last = details.last().expect("the level of the shape");
        let facts = source.map(VolumeSummary::of);
        let facts = facts.as_ref();
        let facts_shown = self.page_facts(last, facts);
        let isovalue = self.isovalue.unwrap_or_default();
        let original = source.map(|PlacedVolume { volume, units, range, .. }| Original {
            volume,
            isovalue: isovalue.gray(range),
            frame: match units {
                Units::Voxel => &Frame::VOXEL,
                Units::World => volume.frame(),
            },
        });
        if let Some(source) = source {
            isovalue.check(source);
        }
        let mut shown = Vec::new();
        for detail in details {
            let opening = detail.opening(self.opening_alpha()).alpha;
            let mut alphas = match &self.alphas {
                Alphas::Given(alphas) => alphas.clone(),
                Alphas::Auto => {
                    progress.stage(Stage::Curve, || pictures::stops(&detail.filtration, opening))
                }
            };
            // What is asked for is a stop, whatever it shows.
            alphas.extend(self.opening_alpha().map(|_| opening));
            let levels = detail.filtration.levels(&alphas);
            let count = levels.len() as u32;
            if levels.vertices().iter().all(|(_, span)| span.first >= count) {
                fail!("no shape has a simplex up to {}", levels.alphas()[levels.len() - 1] => "give larger values of α to --alphas, or omit it");
            }
            if levels.len() > Page::MOST_LEVELS {
                let (levels, most) = (levels.len(), Page::MOST_LEVELS);
                fail_usage!("{levels} levels are too many for a page" => "give at most {most} values in --alphas");
            }
            let domain = pipeline::domain(&detail.weighed, facts).volume;
            let ladder = progress.stage(Stage::Ladder, || levels.ladder(domain));
            // The level at this α, or the last below it.
            let first = levels.alphas().partition_point(|alpha| *alpha <= opening);
            shown.push((levels, ladder, first.saturating_sub(1)));
        }
        let looks: Vec<Looks> = details
            .iter()
            .map(|detail| {
                let of_input = detail.indices.as_deref();
                let [atoms, classes] = [atoms, classes]
                    .map(|kinds| kinds.as_ref().map(|kinds| kept_of(kinds, of_input)));
                let colours = colours.as_deref().map(|colours| match of_input {
                    Some(kept) => kept.iter().map(|&v| colours[v as usize]).collect(),
                    None => Cow::Borrowed(colours),
                });
                Looks { atoms, classes, colours }
            })
            .collect();
        let rendered = details.iter().zip(&shown).zip(&looks);
        let rendered = rendered.map(|((detail, (levels, ladder, first)), looks)| render::Detail {
            levels,
            ladder,
            first: *first,
            differences: detail.differences.as_ref(),
            atoms: looks.atoms.as_deref(),
            classes: looks.classes.as_deref(),
            colours: looks.colours.as_deref(),
            indices: detail.indices.as_deref(),
        });
        let rendered: Vec<_> = rendered.collect();
        let title = format!("Alpha shapes of {}", name(&self.pipeline.input.input));
        let grays = facts.is_some_and(|facts| facts.written == GrayRange::IDENTITY);
        let subject = Subject {
            title: &title,
            facts: &facts_shown,
            coordinates: last.weighed.origin.coordinates,
            value: match facts {
                Some(_) if grays => "value of the original volume, in gray levels",
                Some(_) => "value of the original volume",
                None => column,
            },
            difference: if grays { "gray levels" } else { "values of the file" },
            details: &rendered,
            original,
        };
        let page = progress.stage(Stage::Page, || Page::new(&subject))?;
        let facts = rendered.iter().zip(details).map(|(rendered, detail)| DetailSummary {
            kept: detail.kept,
            ..DetailSummary::of(rendered)
        });
        Ok((page, facts.collect()))
    }

    /// The facts that the page lists besides the numbers of levels.
    fn page_facts(&self, detail: &Detail, volume: Option<&VolumeSummary>) -> Vec<(String, String)> {
        let Detail { weighed, kept, .. } = detail;
        let (reference, opening) = (detail.reference(), detail.opening(self.opening_alpha()));
        let mut facts_shown = vec![("input".to_owned(), name(&self.pipeline.input.input))];
        if let Some((volume, t)) = volume.zip(weighed.origin.truncation.as_ref()) {
            let [x, y, z] = volume.dims;
            let (low, high) = (number(volume.range.low), number(volume.range.high));
            facts_shown.push((
                "volume".into(),
                format!("{x}×{y}×{z} samples, values {low} to {high} are gray 0 to 255"),
            ));
            facts_shown.push((
                "detail kept".into(),
                format!(
                    "{} % of the wavelet coefficients, error {} gray levels (root mean square)",
                    rounded(100.0 * t.kept as f64 / t.total as f64),
                    rounded(t.rms)
                ),
            ));
        }
        facts_shown.push(("lengths in".into(), weighed.origin.coordinates.to_string()));
        // Weights that are all 0 say nothing.
        let is_weighted = weighed.points.weights().iter().any(|&weight| weight != 0.0);
        if is_weighted {
            facts_shown.push((
                "weights ω".into(),
                format!("{}, frozen at {reference}", WeightsReport::of(weighed)),
            ));
        }
        if !is_weighted || opening.alpha != reference.alpha {
            facts_shown.push(("opens at".into(), opening.to_string()));
        }
        if let Some(torus) = weighed.origin.torus {
            let cell = Cell { vectors: torus.vectors(), repeats: torus.repeats() };
            facts_shown.push(("periodic box".into(), cell.to_string()));
        }
        if let Some(kept) = kept {
            facts_shown.push(("kept".into(), kept.to_string()));
        }
        facts_shown.push(("made by".into(), format!("walpha {}", env!("CARGO_PKG_VERSION"))));
        facts_shown
    }
}

/// What the points of a level of detail look like, besides their values.
struct Looks<'a> {
    atoms: Option<Cow<'a, Kinds>>,
    classes: Option<Cow<'a, Kinds>>,
    colours: Option<Cow<'a, [[u8; 3]]>>,
}

/// The kinds of those points of the input that are kept.
fn kept_of<'a>(kinds: &'a Kinds, kept: Option<&[u32]>) -> Cow<'a, Kinds> {
    match kept {
        Some(kept) => Cow::Owned(Kinds {
            numbers: kept.iter().map(|&v| kinds.numbers[v as usize]).collect(),
            known: kinds.known.clone(),
        }),
        None => Cow::Borrowed(kinds),
    }
}

pub(crate) struct Detail {
    pub weighed: Weighed,
    pub filtration: Filtration,
    /// The difference of F from the volume, in the values that are written.
    pub differences: Option<Differences>,
    /// How many components it consists of, if not all were to be kept.
    pub kept: Option<Kept>,
    /// Which points of the input these are, if not all were kept.
    indices: Option<Vec<u32>>,
}

impl Detail {
    pub(crate) fn new(
        weighed: Weighed,
        source: Option<&PlacedVolume>,
        progress: &mut Progress,
    ) -> Result<Self> {
        let filtration = progress.watch(|| pipeline::filtration(&weighed))?;
        let differences = match source {
            Some(source) if weighed.origin.torus.is_none() => {
                let measure = || differences(&weighed, source, &filtration);
                progress.stage(Stage::Interpolate, measure)?
            }
            _ => None,
        };
        Ok(Self { weighed, filtration, differences, kept: None, indices: None })
    }

    /// The components that are to be kept at the α that the page opens at: shapes of their points alone.
    fn part(
        self,
        recipe: &Recipe,
        asked: Option<AlphaRule>,
        progress: &mut Progress,
    ) -> Result<Self> {
        let opening = self.opening(asked).alpha;
        let parameter = Some(self.reference());
        let part = || recipe.part(&self.weighed, opening);
        let (mut weighed, kept, is_kept) = progress.watch(part)?;
        weighed.parameter = parameter;
        let filtration = progress.watch(|| pipeline::filtration(&weighed))?;
        let differences = self.differences.map(|Differences { local, rmse }| {
            let rows = local.into_iter().zip(&is_kept).filter(|(_, is_kept)| **is_kept);
            Differences { local: rows.map(|(difference, _)| difference).collect(), rmse }
        });
        let indices = (0..).zip(&is_kept).filter_map(|(v, is_kept)| is_kept.then_some(v)).collect();
        Ok(Self { weighed, filtration, differences, kept, indices: Some(indices) })
    }

    /// The α of the weights, or else the one that is found.
    pub(crate) fn reference(&self) -> Parameter {
        self.weighed.parameter.unwrap_or_else(|| self.by_rule(self.weighed.rule))
    }

    /// Where the page opens.
    pub(crate) fn opening(&self, asked: Option<AlphaRule>) -> Parameter {
        asked.map_or_else(|| self.reference(), |rule| self.by_rule(rule))
    }

    fn by_rule(&self, rule: AlphaRule) -> Parameter {
        rule.on(&self.filtration, self.weighed.origin.coordinates.unit)
    }
}

/// The difference of the filled interpolant from the volume; `None` if the points have no values.
fn differences(
    weighed: &Weighed,
    source: &PlacedVolume,
    filtration: &Filtration,
) -> Result<Option<Differences>> {
    let PlacedVolume { volume, units, written, .. } = source;
    let Some(values) = weighed.points.values() else { return Ok(None) };
    let grays: Vec<f64> = values.iter().map(|&value| written.gray(value)).collect();
    let (whole, grays) = filled_in(filtration.whole(), &grays, volume, *units)?;
    let interpolant = Interpolant::with_values(&whole, &grays)?;
    let grid = Grid::of(volume, *units);
    let resampled = interpolant.resample(&grid)?;
    let mut local = interpolant.local_deviations(volume, &grid, &resampled);
    local.truncate(weighed.points.len());
    let step = written.step();
    local.iter_mut().for_each(|difference| *difference *= step);
    let rmse = Deviation::of(volume, &resampled).rmse.unwrap_or_default() * step;
    Ok(Some(Differences { local, rmse }))
}

/// A gray level, or a value of the file: `50` or `300v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Isovalue {
    /// A gray level.
    Gray(f64),
    /// A value of the file.
    Value(f64),
}

impl Default for Isovalue {
    fn default() -> Self {
        Self::Gray(50.0)
    }
}

impl Isovalue {
    /// Warns if no sample reaches the level, or all do: there is no isosurface then.
    fn check(self, PlacedVolume { volume, range, .. }: &PlacedVolume) {
        let (low, high) = volume.value_range();
        let [low, high] = [low, high].map(f64::from);
        let gray = self.gray(range);
        if low < gray && gray <= high {
            return;
        }
        let ends = match self {
            Self::Gray(_) => format!("gray levels go from {} to {}", number(low), number(high)),
            Self::Value(_) => {
                let [low, high] = [low, high].map(|gray| number(range.value(gray)));
                format!("values go from {low} to {high}")
            }
        };
        tracing::warn!("there is no isosurface at {self}, as {ends}; --isovalue chooses another");
    }

    /// The gray level; the values `range` are gray 0..255.
    pub(crate) fn gray(self, range: &GrayRange) -> f64 {
        match self {
            Self::Gray(gray) => gray,
            Self::Value(value) => range.gray(value),
        }
    }
}

impl Display for Isovalue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gray(gray) => write!(f, "gray {}", number(*gray)),
            Self::Value(value) => write!(f, "{}", number(*value)),
        }
    }
}

impl FromStr for Isovalue {
    type Err = CommandError;

    fn from_str(text: &str) -> Result<Self> {
        let (number, level): (_, fn(f64) -> Self) = match text.strip_suffix('v') {
            Some(value) => (value, Self::Value),
            None => (text, Self::Gray),
        };
        match options::number(number)? {
            number if number.is_finite() => Ok(level(number)),
            _ => fail!(
                "a finite number is needed; give a gray level as in 50, or a value as in 300v"
            ),
        }
    }
}

#[derive(Serialize)]
pub(crate) struct ViewSummary {
    pub schema_version: u32,
    pub input: String,
    /// The levels of detail, the coarsest first; that of the shape is the last.
    pub details: Vec<DetailSummary>,
    pub bytes: usize,
    /// A note on what the page leaves out, if anything.
    pub simplified: Option<String>,
    pub file: String,
    pub seconds: BTreeMap<&'static str, f64>,
}

/// A level of detail.
#[derive(Serialize)]
pub(crate) struct DetailSummary {
    points: usize,
    levels: usize,
    /// The RMSE of F, filled in, on all samples, in written values; null without a volume, and where samples of a tissue alone were selected.
    rmse_filled_in_values: Option<f64>,
    /// How many components the points are of, if not all were to be kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    kept: Option<Kept>,
}

impl DetailSummary {
    pub(crate) fn of(detail: &render::Detail<'_>) -> Self {
        Self {
            points: detail.levels.own_points(),
            levels: detail.levels.len(),
            rmse_filled_in_values: detail.differences.map(|differences| differences.rmse),
            kept: None,
        }
    }
}

impl Display for ViewSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "input     {}", name(&self.input))?;
        for DetailSummary { points, levels, rmse_filled_in_values, kept } in &self.details {
            write!(f, "detail    {points} points, {levels} levels")?;
            if let Some(kept) = kept {
                write!(f, ", {kept}")?;
            }
            match rmse_filled_in_values {
                Some(rmse) => writeln!(f, ", RMSE of F {} in values (filled in)", rounded(*rmse))?,
                None => writeln!(f)?,
            }
        }
        if let Some(simplified) = &self.simplified {
            writeln!(f, "page      {simplified}")?;
        }
        writeln!(f, "wrote     {}, {:.1} MB", name(&self.file), self.bytes as f64 / 1e6)?;
        let total = self.seconds.get("total").copied().unwrap_or_default();
        writeln!(f, "time      total {total:.2} s")
    }
}
