//! `walpha blocks`: one shape in pieces that other processes or machines compute.

use std::path::{Path, PathBuf};

use crate::blocks::{Cutting, Job, Merged, Pieces, Plan, merge, price, run, run_all, whole};
use crate::export::{Content, ExportOptions, Exporter, Format, Target, write_all};
use crate::progress::Stage;
use crate::shown::shown;
use clap::{Args, Subcommand};

use super::args::{PipelineArgs, ShapeArgs};
use super::block_facts::{PlanFacts, PriceFacts, RunFacts};
use super::output::tell;
use super::progress::Progress;
use super::report::Report;
use super::said::misused;
use super::{Global, folder, pipeline};

/// Compute a shape in blocks, on as many machines as see one folder: plan, run each block, merge.
///
/// Examples:
///
/// walpha blocks plan scan.zarr --weights min-max --alpha 10 --blocks 64 -o work
///
/// walpha blocks run work 0 1 2
///
/// walpha blocks merge work -o bone.pvtp bone.ply
#[derive(Args)]
pub(super) struct Blocks {
    #[command(subcommand)]
    step: Step,
}

#[derive(Subcommand)]
enum Step {
    Plan(Box<PlanStep>),
    Run(RunStep),
    Merge(MergeStep),
}

/// Survey the volume, cut it into blocks, and write the plan.
#[derive(Args)]
struct PlanStep {
    /// Folder for the plan and its blocks, made if it is not there.
    #[arg(short, long, value_name = "DIR", required_unless_present = "dry_run")]
    output: Option<PathBuf>,
    /// Print what the work will cost, by a model, without reading the volume.
    #[arg(long, conflicts_with = "output")]
    dry_run: bool,
    #[command(flatten)]
    pipeline: PipelineArgs,
    #[command(flatten)]
    shape: ShapeArgs,
}

/// Compute blocks; those that are there already are left alone.
#[derive(Args)]
struct RunStep {
    /// Folder of the plan.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Numbers of blocks, from 0 [default: all that are missing].
    #[arg(value_name = "I")]
    blocks: Vec<usize>,
}

/// Merge all blocks, and write what comes out.
#[derive(Args)]
struct MergeStep {
    /// Folder of the plan.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Files to write: .pvtu (all simplices) or .pvtp (boundary) with a file for each block, .zarr (arrays, with
    /// the feature zarr), or any format of `walpha shape` in one file, for which the shape must fit the
    /// memory.
    #[arg(short, long, value_name = "FILE", num_args = 1..)]
    output: Vec<PathBuf>,
}

impl Blocks {
    pub(super) fn run(self, global: Global) -> anyhow::Result<()> {
        match self.step {
            Step::Plan(step) => step.run(global),
            Step::Run(step) => step.run(global),
            Step::Merge(step) => step.run(global),
        }
    }
}

impl PlanStep {
    fn run(self, global: Global) -> anyhow::Result<()> {
        let mut progress = Progress::new(global);
        let job = job(&self.pipeline, &self.shape)?;
        let Some(folder) = self.output else {
            progress.finish();
            return tell(global, &PriceFacts(price(&job, cutting(&self.shape))?));
        };
        let new = folder::make(&folder, "with --output")?;
        let plan =
            progress.stage(Stage::Points, || Plan::make(job, cutting(&self.shape), &folder))?;
        if let Some(new) = new {
            new.keep();
        }
        let seconds = progress.total();
        tell(global, &PlanFacts::of(&plan, seconds))
    }
}

impl RunStep {
    fn run(self, global: Global) -> anyhow::Result<()> {
        let mut progress = Progress::new(global);
        let plan = Plan::open(&self.folder)?;
        let blocks = if self.blocks.is_empty() { plan.missing()? } else { self.blocks };
        progress.stage(Stage::Shape, || match blocks[..] {
            [one] => run(&plan, one),
            _ => run_all(&plan, &blocks),
        })?;
        let seconds = progress.total();
        let folder = self.folder.display().to_string();
        tell(global, &RunFacts { folder, blocks, seconds })
    }
}

impl MergeStep {
    fn run(self, global: Global) -> anyhow::Result<()> {
        let mut progress = Progress::new(global);
        let plan = Plan::open(&self.folder)?;
        let input = Some(plan.job.input.clone());
        let export = ExportOptions { input, ..ExportOptions::default() };
        let mut outputs = Outputs::default();
        for path in &self.output {
            if let Some(pieces) = Pieces::of(path) {
                pieces.check(path)?;
                outputs.pieces.push((pieces, path.clone()));
            } else {
                let exporter = Format::of(path)?.exporter(&export);
                outputs.whole.push((Target::open(path)?, exporter));
            }
        }
        let merged = progress.stage(Stage::Shape, || merge(&plan))?;
        let mut report = Report::of_blocks(&plan, &merged);
        progress.stage(Stage::Write, || outputs.write(&plan, &merged))?;
        let files = self.output.iter().map(|path| path.display().to_string()).collect();
        report.finish(progress.finish(), files);
        tell(global, &report)
    }
}

/// Where merged blocks go.
#[derive(Default)]
pub(super) struct Outputs {
    /// With a file for each block.
    pub pieces: Vec<(Pieces, PathBuf)>,
    /// In one file.
    pub whole: Vec<(Target, Box<dyn Exporter>)>,
}

impl Outputs {
    fn write(self, plan: &Plan, merged: &Merged) -> anyhow::Result<()> {
        for (pieces, path) in &self.pieces {
            pieces.write(plan, merged, path)?;
        }
        self.write_whole(plan, merged)
    }

    /// Writes what goes into one file.
    pub(super) fn write_whole(self, plan: &Plan, merged: &Merged) -> anyhow::Result<()> {
        if self.whole.is_empty() {
            return Ok(());
        }
        let shape = whole(plan, merged)?;
        write_all(self.whole.into_iter().map(|(target, exporter)| {
            let shape = &shape;
            let content = move |out: &mut dyn std::io::Write| exporter.write(shape, out);
            (target, Box::new(content) as Content<'_>)
        }))?;
        Ok(())
    }
}

/// What the options ask for.
pub(super) fn job(args: &PipelineArgs, shape: &ShapeArgs) -> anyhow::Result<Job> {
    let PipelineArgs { input, haar, select, weights, .. } = args;
    if input.input == Target::STDOUT {
        misused!("standard input cannot be read in parts, as blocks are" => "name a file");
    }
    if pipeline::is_points(input, &input.input)? {
        let name = shown(Path::new(&input.input));
        misused!("{name} holds points, and blocks are cut from volumes" => "write another format than .pvtu and .pvtp");
    }
    input.given.refuse(&["columns"], format!("{} holds a volume", input.input))?;
    let alone = ["refit", "exchange", "max_error"];
    input.given.refuse(&alone, "blocks look at a part of the volume each")?;
    let options = shape.options();
    if options.exterior {
        misused!("--exterior needs the whole triangulation, which blocks do not have" => "omit it");
    }
    let mut job = Job::new(&input.input, input.options()).map_err(|error| match error {
        crate::blocks::BlocksError::Volume(error) => pipeline::with_points(error),
        other => other.into(),
    })?;
    (job.frame, job.units) = select.place_frame(job.frame)?;
    (job.selection, job.value_min) = select.in_blocks()?;
    job.gray = input.gray_range();
    job.gray_out = input.gray_out();
    job.haar = haar.options();
    (job.balls, job.engine) = (options.balls, options.engine);
    job.set_alpha(weights.alpha())?;
    if let Some(weighting) = weights.weights {
        job.weighting = weighting;
    }
    job.check()?;
    Ok(job)
}

/// How the options cut it.
pub(super) fn cutting(shape: &ShapeArgs) -> Cutting {
    let options = shape.options();
    Cutting { blocks: options.blocks.map(usize::from), memory: options.memory }
}
