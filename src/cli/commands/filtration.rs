//! `walpha filtration`: lists every simplex with the α at which it enters the shape.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use walpha_base::shown::counted;

use crate::Coordinates;
use crate::cli::process::errors::Result;
use crate::export::{Content, FiltrationFormat, Target, UnknownFormat, write_all, write_cycles};
use crate::ladder::Ordered;
use crate::pipeline::{Parameter, Weighed};
use crate::progress::Stage;
use crate::shape::ShapeError;

use crate::cli::commands::pipeline;
use crate::cli::options::formats::filtration_output;
use crate::cli::options::global::Global;
use crate::cli::options::{Declared, FrozenPipelineArgs, OutputArgs, Periodic};
use crate::cli::process::output::{name, print_summary};
use crate::cli::process::progress::Progress;
use crate::cli::report::{MovedIntoBox, SCHEMA_VERSION, WeightsReport, ending};

/// List every simplex of the regular triangulation with the α at which it enters the shape.
///
/// For each simplex: its value, the α from which it is in the shape, as the double nearest to the exact
/// number; whether its own smallest sphere is empty (Gabriel; otherwise it enters with a simplex that
/// it is a face of); and the α from which it is regular and interior. Simplices are ordered by exact
/// value, then by dimension and vertices, so that faces come before the simplices that they bound.
/// Persistence pairs of components, loops and voids are in .npz, .json and the output of --json; .csv has
/// them alone, as a table, and .svg and .png draw the persistence diagram. Weights are frozen.
///
/// Examples:
///
/// walpha filtration scan.xyz -o scan.npz   # simplices and pairs
///
/// walpha filtration scan.xyz -o pairs.csv diagram.svg   # the persistence diagram
///
/// walpha filtration sample:skull --weights min-max -o skull.json skull.txt   # to exchange
///
/// walpha filtration foam.xyz --periodic 20,20,20 --cycles cycles.vtp   # a periodic box
///
/// walpha check skull.json   # verify
#[derive(Args)]
pub(crate) struct Filtration {
    #[arg(short, long, value_name = "FILE", num_args = 1.., help = filtration_output())]
    output: Vec<PathBuf>,
    /// Cycles that represent persistence pairs, as VTP: for each loop a short closed line through the edge that creates it, for each void the
    /// triangles around it, with `dimension`, `birth` and `death`. By default the 100 most persistent of each dimension.
    #[arg(long, value_name = "FILE.vtp")]
    cycles: Option<PathBuf>,
    /// Write all cycles whose persistence (death − birth) exceeds this squared length, instead of the first 100.
    #[arg(long, value_name = "α", requires = "cycles", value_parser = crate::cli::options::not_negative)]
    cycles_above: Option<f64>,
    #[command(flatten)]
    pipeline: FrozenPipelineArgs,
    #[command(flatten)]
    periodic: Declared<Periodic>,
    #[command(flatten)]
    format: OutputArgs,
}

#[derive(Serialize)]
struct FiltrationSummary {
    schema_version: u32,
    input: String,
    points: usize,
    hidden: usize,
    duplicates: usize,
    /// The number of points outside the periodic box that were moved into it; absent without a box.
    #[serde(skip_serializing_if = "Option::is_none")]
    folded: Option<usize>,
    /// The unit of points and all lengths; values are in its square.
    coordinates: Coordinates,
    /// The α to which weights are proportional; null if they do not depend on α.
    alpha_ref: Option<Parameter>,
    weights: WeightsReport,
    cells: Count,
    facets: Count,
    edges: Count,
    vertices: Count,
    /// The number of distinct values.
    values: usize,
    persistence: Option<Persistence>,
    files: Vec<String>,
    seconds: BTreeMap<&'static str, f64>,
}

/// The numbers of simplices of a dimension.
#[derive(Clone, Copy, Serialize)]
struct Count {
    gabriel: usize,
    attached: usize,
}

/// The persistence intervals of components, loops and voids, without empty ones.
#[derive(Serialize)]
struct Persistence {
    components: Vec<[f64; 2]>,
    /// The values at which the components begin that never end.
    lasting_components: Vec<f64>,
    loops: Vec<[f64; 2]>,
    /// The values at which the loops begin that never end: three in a periodic box, otherwise none.
    lasting_loops: Vec<f64>,
    voids: Vec<[f64; 2]>,
    /// The values at which the voids begin that never end: three in a periodic box, otherwise none.
    lasting_voids: Vec<f64>,
    /// The value at which the last cell fills a periodic box that repeats along three vectors: its class of dimension 3.
    #[serde(skip_serializing_if = "Option::is_none")]
    last: Option<f64>,
}

impl Filtration {
    pub(crate) fn run(self, global: Global) -> Result<()> {
        let input = &self.pipeline.input;
        self.format.check(self.output.iter())?;
        let mut targets = Vec::new();
        for path in &self.output {
            let format = FiltrationFormat::of(&self.format.named(path)?)?;
            targets.push((Target::open(path)?, format));
        }
        let cycles = self.cycles.as_ref().map(cycles_target).transpose()?;
        let mut progress = Progress::new(global);
        input.typed.refuse(&["refit"], "a filtration has no values")?;
        let recipe = self.pipeline.recipe()?;
        let (weighed, _) = pipeline::weighted_points(input, &recipe, &mut progress)?;
        let filtration = progress.watch(|| pipeline::filtration(&weighed))?;
        let ordered = progress.stage(Stage::Order, || filtration.simplices())?;
        if global.json || cycles.is_some() || targets.iter().any(|(_, format)| format.pairs) {
            progress.stage(Stage::Pairs, || ordered.loops())?;
        }
        progress.stage(Stage::Write, || {
            write_all(targets.into_iter().map(|(target, format)| {
                let ordered = &ordered;
                let content = move |out: &mut dyn Write| format.write(ordered, out);
                (target, Box::new(content) as Content<'_>)
            }))?;
            let write = |out: &mut dyn Write| {
                write_cycles(
                    &ordered,
                    self.cycles_above,
                    weighed.origin.coordinates,
                    &input.input,
                    out,
                )
            };
            cycles.map_or(Ok(()), |target| target.write(write))
        })?;
        let mut facts = FiltrationSummary::new(&input.input, &weighed, &ordered);
        if global.json {
            facts.persistence = Some(Persistence::of(&ordered)?);
        }
        let files = self.output.iter().chain(&self.cycles);
        facts.files = files.map(|path| path.display().to_string()).collect();
        facts.seconds = progress.finish().into_iter().collect();
        print_summary(global, &facts)
    }
}

/// The file of cycles.
fn cycles_target(path: &PathBuf) -> Result<Target> {
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("vtp")) {
        return Err(UnknownFormat::new(path, "cycles", ["vtp"]).into());
    }
    Ok(Target::open(path)?)
}

impl FiltrationSummary {
    fn new(input: &str, weighed: &Weighed, ordered: &Ordered<'_>) -> Self {
        let whole = ordered.filtration().whole();
        let [vertices, edges, facets, cells] = [0, 1, 2, 3].map(|dimension| {
            let gabriel = ordered.gabriel(dimension);
            Count { gabriel, attached: ordered.count(dimension) - gabriel }
        });
        Self {
            schema_version: SCHEMA_VERSION,
            input: input.to_owned(),
            points: whole.own_points(),
            hidden: whole.hidden().map_or(0, <[u32]>::len),
            duplicates: whole.duplicates().len(),
            folded: weighed.origin.folded,
            coordinates: weighed.origin.coordinates,
            alpha_ref: weighed.parameter,
            weights: WeightsReport::of(weighed),
            cells,
            facets,
            edges,
            vertices,
            values: ordered.values().len(),
            persistence: None,
            files: Vec::new(),
            seconds: BTreeMap::new(),
        }
    }
}

impl Persistence {
    fn of(ordered: &Ordered<'_>) -> Result<Self, ShapeError> {
        let split = |dimension| -> Result<(Vec<[f64; 2]>, Vec<f64>), ShapeError> {
            let intervals = ordered.persistence(dimension)?;
            let (ended, lasting): (Vec<_>, Vec<_>) =
                intervals.into_iter().partition(|interval| interval.ends.is_some());
            let ended = ended.into_iter().map(|interval| [interval.birth, interval.death]);
            Ok((ended.collect(), lasting.into_iter().map(|interval| interval.birth).collect()))
        };
        let (components, lasting_components) = split(0)?;
        let (loops, lasting_loops) = split(1)?;
        let (voids, lasting_voids) = split(2)?;
        let (_, last) = split(3)?;
        Ok(Self {
            components,
            lasting_components,
            loops,
            lasting_loops,
            voids,
            lasting_voids,
            last: last.first().copied(),
        })
    }
}

impl Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:>9} Gabriel {:>9} attached", self.gabriel, self.attached)
    }
}

impl Display for FiltrationSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "input     {}", name(&self.input))?;
        let Self { points, duplicates, hidden, .. } = self;
        let duplicates = counted(*duplicates as u64, "duplicate");
        write!(f, "points    {points}, {duplicates}, {hidden} hidden")?;
        writeln!(f, "{}", MovedIntoBox(self.folded))?;
        writeln!(f, "lengths   in {}", self.coordinates)?;
        writeln!(f, "weights   {} (squared lengths), frozen", self.weights)?;
        if let Some(alpha_ref) = &self.alpha_ref {
            writeln!(f, "          for {alpha_ref}")?;
        }
        writeln!(f, "cells     {}", self.cells)?;
        writeln!(f, "facets    {}", self.facets)?;
        writeln!(f, "edges     {}", self.edges)?;
        writeln!(f, "vertices  {}", self.vertices)?;
        writeln!(f, "values    {}", counted(self.values as u64, "different number"))?;
        let stages = ["read", "haar", "points", "filtration", "order", "pairs", "write", "total"];
        ending(f, &self.files, &stages, &self.seconds)
    }
}
