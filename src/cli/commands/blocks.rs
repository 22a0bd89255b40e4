//! `walpha blocks`: computes a shape in blocks, on other processes or machines, and prints a summary of each step.

use std::fmt::{self, Display};
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use serde::Serialize;
use walpha_base::memory::readable;
use walpha_base::shown::shown;
use walpha_files::{Working, fill_all, keep_input};

use crate::Recipe;
use crate::cli::commands::folder;
use crate::cli::commands::outline;
use crate::cli::commands::pipeline;
use crate::cli::options::global::{DIFFERENT, Global, SUCCESS};
use crate::cli::options::{self, Declared, InputArgs, OfShape, PipelineArgs, preset};
use crate::cli::process::errors::{CommandError, Result, fail, fail_usage};
use crate::cli::process::output::{name, print_summary};
use crate::cli::process::progress::Progress;
use crate::cli::report::Report;
use crate::cli::report::offsets::{FileOffset, offsets};
use crate::export::{Content, ExportOptions, Exporter, Format, NewFolder, Target};
use crate::outofcore::{
    Alone, BlocksError, BlockwiseFormat, Checked, CostEstimate, Cutting, Finding, Job, Merged,
    Plan, Team, estimate_cost, merge, run, run_all, whole,
};
use crate::pipeline::Opened;
use crate::progress::Stage;
use crate::volume::{Hounsfield, Labels, files_of};

/// Compute a shape in blocks, on any number of machines that share a folder: plan, run each block, merge.
///
/// Examples:
///
/// walpha blocks plan scan.zarr --weights min-max --alpha 10 --blocks 64 -o work   # divide
///
/// walpha blocks run work 0 1 2   # compute three of them
///
/// walpha blocks run work   # compute all that are left
///
/// walpha blocks merge work -o bone.pvtp bone.ply   # join them
///
/// walpha blocks check work   # verify them
#[derive(Args)]
pub(crate) struct Blocks {
    #[command(subcommand)]
    step: Step,
}

#[derive(Subcommand)]
enum Step {
    Plan(Box<PlanStep>),
    Run(RunStep),
    Merge(MergeStep),
    Check(CheckStep),
}

/// Survey the volume, cut it into blocks, and write the plan.
#[derive(Args)]
struct PlanStep {
    /// Folder for the plan and its blocks, created if needed.
    #[arg(short, long, value_name = "DIR", required_unless_present = "dry_run")]
    output: Option<PathBuf>,
    /// Print an estimate of the cost, from a model, without reading the volume.
    #[arg(long, conflicts_with = "output")]
    dry_run: bool,
    #[command(flatten)]
    pipeline: PipelineArgs,
    #[command(flatten)]
    shape: Declared<OfShape>,
}

/// Compute blocks; finished ones are kept, damaged ones are computed again.
#[derive(Args)]
struct RunStep {
    /// Folder of the plan.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Numbers of blocks, from 0 [default: all that are missing or damaged].
    #[arg(value_name = "I")]
    blocks: Vec<usize>,
}

/// Verify and merge all blocks, and write the shape: all outputs, or none.
#[derive(Args)]
struct MergeStep {
    /// Folder of the plan.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Files to write: .pvtu (all simplices) or .pvtp (boundary) with a file for each block, .zarr (arrays, with
    /// the feature zarr), or any format of `walpha shape` in one file, for which the shape must fit
    /// into memory.
    #[arg(short, long, value_name = "FILE", num_args = 1..)]
    output: Vec<PathBuf>,
}

/// Read all files of a plan, and name those that differ from what was written.
///
/// The exit code is 0 if all blocks are present and intact, and 3 if one is missing, damaged or belongs to
/// another plan.
#[derive(Args)]
struct CheckStep {
    /// Folder of the plan.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

impl Blocks {
    pub(crate) fn run(self, global: Global) -> Result<u8> {
        match self.step {
            Step::Plan(step) => step.run(global)?,
            Step::Run(step) => step.run(global)?,
            Step::Merge(step) => step.run(global)?,
            Step::Check(step) => return step.run(global),
        }
        Ok(SUCCESS)
    }
}

impl CheckStep {
    fn run(self, global: Global) -> Result<u8> {
        let mut progress = Progress::new(global);
        let folder = &self.folder;
        let facts = match Plan::open(folder) {
            Ok(plan) => {
                let checked = progress.stage(Stage::Shape, || plan.check())?;
                CheckSummary::of(folder, Some(&plan), checked)
            }
            Err(BlocksError::NoPlan { path, what }) => {
                let mut checked = Checked::default();
                checked.findings.push(Finding { path, what });
                CheckSummary::of(folder, None, checked)
            }
            Err(error) => return Err(error.into()),
        };
        progress.finish();
        print_summary(global, &facts)?;
        Ok(if facts.whole { SUCCESS } else { DIFFERENT })
    }
}

impl PlanStep {
    fn run(self, global: Global) -> Result<()> {
        let mut progress = Progress::new(global);
        let recipe = self.pipeline.recipe()?;
        let cutting = Cutting::of(&recipe);
        let job = job(&self.pipeline.input, recipe)?;
        let Some(folder) = self.output else {
            progress.finish();
            return print_summary(global, &CostSummary(estimate_cost(&job, cutting)?));
        };
        let new = folder::make(&folder, "with --output")?;
        keep_input_of(&job, global);
        let plan = progress.stage(Stage::Points, || Plan::make(job, cutting, &folder, &Alone))?;
        if let Some(new) = new {
            new.keep();
        }
        let seconds = progress.total();
        print_summary(global, &PlanSummary::of(&plan, seconds))
    }
}

impl RunStep {
    fn run(self, global: Global) -> Result<()> {
        let mut progress = Progress::new(global);
        let plan = Plan::open(&self.folder)?;
        keep_input_of(&plan.job, global);
        let blocks = if self.blocks.is_empty() {
            plan.restore()?;
            plan.missing()?
        } else {
            self.blocks
        };
        progress.stage(Stage::Shape, || match blocks[..] {
            [one] => run(&plan, one),
            _ => run_all(&plan, &blocks),
        })?;
        let seconds = progress.total();
        let folder = self.folder.display().to_string();
        print_summary(global, &RunSummary { folder, blocks, seconds })
    }
}

impl MergeStep {
    fn run(self, global: Global) -> Result<()> {
        let mut progress = Progress::new(global);
        let plan = Plan::open(&self.folder)?;
        let input = Some(plan.job.input.clone());
        let export = ExportOptions::default().input(input);
        // An output in this folder could replace files of the plan.
        let _working = (!global.in_place).then(|| Working::folder(&self.folder));
        keep_input_of(&plan.job, global);
        let mut outputs = Outputs::default();
        for path in &self.output {
            if let Some(pieces) = BlockwiseFormat::of(path) {
                pieces.check(path)?;
                outputs.pieces.push((pieces, path.clone()));
            } else {
                let format = Format::of(path)?;
                outline::refuse([format], "a plan is of points that span a volume")?;
                let exporter = format.exporter(&export);
                outputs.whole.push((Target::open(path)?, exporter));
            }
        }
        let merged = progress.stage(Stage::Shape, || {
            plan.verify_blocks()?;
            merge(&plan)
        })?;
        let mut report = Report::of_blocks(&plan, &merged);
        report.offsets =
            progress.stage(Stage::Write, || outputs.write(&plan, Some(&merged), &Alone))?;
        let files = self.output.iter().map(|path| path.display().to_string()).collect();
        report.finish(progress.finish(), files);
        print_summary(global, &report)
    }
}

/// Protects the input, which may be a file in the folder of a plan with the name of a block.
fn keep_input_of(job: &Job, global: Global) {
    if !global.in_place {
        keep_input(Path::new(&job.input), files_of);
    }
}

/// The destinations of merged blocks.
#[derive(Default)]
pub(crate) struct Outputs {
    /// The outputs with a file for each block.
    pub pieces: Vec<(BlockwiseFormat, PathBuf)>,
    /// The outputs in one file.
    pub whole: Vec<(Target, Box<dyn Exporter>)>,
}

impl Outputs {
    /// Writes all outputs or none, as one process of a team. Only the first process has the merged shape and targets. Returns the
    /// offsets that files in single precision have subtracted.
    pub(crate) fn write(
        self,
        plan: &Plan,
        merged: Option<&Merged>,
        team: &dyn Team,
    ) -> Result<Vec<FileOffset>> {
        // They are dropped in reverse order: a folder can be removed only after it is empty.
        let (mut folders, mut files) = (Vec::new(), Vec::new());
        for (pieces, path) in &self.pieces {
            let written = pieces.fill(plan, merged, path, team)?;
            files.extend(written.files);
            folders.extend(written.new);
        }
        let shape = match merged {
            Some(merged) if !self.whole.is_empty() => Some(whole(plan, merged)?),
            _ => None,
        };
        let mut subtracted = Vec::new();
        if let Some(shape) = &shape {
            subtracted = offsets(&self.whole, shape);
            for (target, exporter) in &self.whole {
                if !exporter.needs().met_by(shape) {
                    tracing::warn!("{}: it holds nothing of the shape", shown(target.path()));
                }
            }
        }
        let whole = self.whole.into_iter().zip(std::iter::repeat(shape.as_ref()));
        let whole = whole.filter_map(|((target, exporter), shape)| {
            let shape = shape?;
            let content = move |out: &mut dyn std::io::Write| exporter.write(shape, out);
            Some((target, Box::new(content) as Content<'_>))
        });
        let whole = fill_all(whole)?;
        team.first_last(|| whole.put(files))?;
        folders.into_iter().for_each(NewFolder::keep);
        Ok(subtracted)
    }
}

/// The job for a shape of INPUT in blocks.
pub(crate) fn job(args: &InputArgs, recipe: Recipe) -> Result<Job> {
    let input = &args.input;
    if input.is_stdin() {
        fail_usage!("standard input cannot be read in parts, as blocks are" => "name a file");
    }
    if input.path().to_str().is_none() {
        fail_usage!("the plan of blocks is stored as text, and the name {input} is not UTF-8" => "give a link to it that has such a name");
    }
    let Opened::Volume(volume) = recipe.opened(input.path()).map_err(pipeline::unread)? else {
        let name = shown(input.path());
        fail_usage!("{name} holds points, and blocks are cut from volumes" => "name a volume, or write another format than .pvtu and .pvtp, by one process");
    };
    args.typed.refuse(&options::of_points(), format!("{input} holds a volume"))?;
    let alone = ["refit", "exchange", "max_error"];
    args.typed.refuse(&alone, "blocks look at a part of the volume each")?;
    let source = volume.source(&recipe.read).map_err(pipeline::with_points)?;
    if recipe.surface.is_some() {
        fail_usage!("blocks are of points that are selected by gray levels, and a surface is a solid without these" => "omit --surface, or write the solid in one file, as .vtu or .ply, by one process");
    }
    if recipe.labels.is_some()
        || !preset::looks_for_gray_levels(args)
            && Labels::of(&source).map_err(pipeline::with_points)?.is_some()
    {
        fail!("{input} holds labels, and blocks are of points that are selected by gray levels" => "make their solid by `walpha shape`, in one process and one file, as .vtu or .ply, or say what to look for in gray levels, as by --threshold");
    }
    let found = || Hounsfield::of(&source).ok()?;
    let recipe = preset::suited(args, &recipe, found).unwrap_or(recipe);
    Job::of_source(input, recipe, &source).map_err(|error| match error {
        error @ BlocksError::NotLocal { .. } => CommandError::usage_of(error),
        other => other.into(),
    })
}

/// The summary printed after planning.
#[derive(Serialize)]
pub(crate) struct PlanSummary {
    folder: String,
    plan: String,
    input: String,
    samples: usize,
    points: u64,
    blocks: usize,
    largest_block: u64,
    /// The points in halos, summed over all blocks, as a share of all points.
    halo_share: f64,
    seconds: f64,
}

impl PlanSummary {
    pub(crate) fn of(plan: &Plan, seconds: f64) -> Self {
        let points = plan.blocks.iter().map(|block| block.points).sum::<u64>();
        let halo = plan.blocks.iter().map(|block| block.halo).sum::<u64>();
        Self {
            folder: plan.folder().display().to_string(),
            plan: plan.digest(),
            input: plan.job.input.clone(),
            samples: plan.job.dims.samples(),
            points,
            blocks: plan.blocks.len(),
            largest_block: plan.blocks.iter().map(|block| block.points).max().unwrap_or(0),
            halo_share: halo as f64 / points.max(1) as f64,
            seconds,
        }
    }
}

impl Display for PlanSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "plan      {} of {}", self.plan, self.input)?;
        writeln!(f, "points    {} of {} samples", self.points, self.samples)?;
        writeln!(
            f,
            "blocks    {} of up to {} points, and at most {:.0} % of all points again around them",
            self.blocks,
            self.largest_block,
            100.0 * self.halo_share
        )?;
        writeln!(f, "wrote     {}", name(&self.folder))
    }
}

/// The estimated cost of the work.
#[derive(Serialize)]
#[serde(transparent)]
pub(crate) struct CostSummary(pub CostEstimate);

impl Display for CostSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let CostEstimate { samples, points, blocks, halo_share, memory_per_block, .. } = self.0;
        let [by_plan, by_blocks] = self.0.bytes_read.map(readable);
        let [by_rows, by_keys] = self.0.bytes_written.map(readable);
        let [plan, run, merge] = self.0.core_seconds;
        writeln!(f, "points    {points} of {samples} samples")?;
        writeln!(
            f,
            "blocks    {blocks}, and {:.1} % of all points again around them",
            100.0 * halo_share
        )?;
        writeln!(f, "memory    {} for each block at work", readable(memory_per_block))?;
        writeln!(f, "reads     {by_plan} to plan, {by_blocks} by all blocks")?;
        let by_plan = readable(self.0.bytes_of_plan);
        writeln!(f, "writes    {by_rows}, of which merging reads {by_keys}; to plan {by_plan}")?;
        let hours = (plan + run + merge) / 3600.0;
        writeln!(
            f,
            "time      {hours:.3} core-hours: plan {plan:.0} s, blocks {run:.0} s, merge {merge:.0} s of one core"
        )
    }
}

/// The summary printed after running blocks.
#[derive(Serialize)]
pub(crate) struct RunSummary {
    pub folder: String,
    pub blocks: Vec<usize>,
    pub seconds: f64,
}

impl Display for RunSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { folder, blocks, seconds } = self;
        let folder = name(folder);
        writeln!(f, "blocks    {} done in {folder}, {seconds:.2} s", blocks.len())
    }
}

/// The summary printed after checking the files of a plan.
#[derive(Serialize)]
pub(crate) struct CheckSummary {
    folder: String,
    /// The digest of the plan; null if the plan cannot be read.
    plan: Option<String>,
    /// The number of blocks of the plan; null if the plan cannot be read.
    blocks: Option<usize>,
    missing: Vec<usize>,
    findings: Vec<FileFinding>,
    /// Whether all files are present and intact.
    pub whole: bool,
}

/// A file that does not verify.
#[derive(Serialize)]
struct FileFinding {
    path: String,
    what: String,
}

impl CheckSummary {
    pub(crate) fn of(folder: &Path, plan: Option<&Plan>, checked: Checked) -> Self {
        let whole = checked.is_whole();
        let found = checked.findings.into_iter();
        Self {
            folder: folder.display().to_string(),
            plan: plan.map(Plan::digest),
            blocks: plan.map(|plan| plan.blocks.len()),
            findings: found
                .map(|found| FileFinding {
                    path: found.path.display().to_string(),
                    what: found.what,
                })
                .collect(),
            missing: checked.missing,
            whole,
        }
    }
}

impl Display for CheckSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for FileFinding { path, what } in &self.findings {
            writeln!(f, "{}: {what}", name(path))?;
        }
        if !self.missing.is_empty() {
            let missing: Vec<String> = self.missing.iter().map(usize::to_string).collect();
            writeln!(f, "missing   {}", missing.join(", "))?;
        }
        let folder = name(&self.folder);
        match (self.whole, self.blocks, self.findings.len()) {
            (true, Some(blocks), _) => writeln!(f, "verified  {blocks} blocks in {folder}"),
            (_, Some(_), 0) => writeln!(f, "verified  what is there in {folder}"),
            (_, Some(_), _) => {
                writeln!(f, "next      walpha blocks run {folder}, which computes these again")
            }
            (_, None, _) => writeln!(f, "next      plan again"),
        }
    }
}
