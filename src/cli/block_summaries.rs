//! What `walpha blocks` prints about its steps.

use std::fmt::{self, Display};

use serde::Serialize;

use std::path::Path;

use walpha_base::memory::readable;

use crate::outofcore::{Checked, Plan, Price};

use super::output::name;

/// What a plan is.
#[derive(Serialize)]
pub(super) struct PlanSummary {
    folder: String,
    plan: String,
    input: String,
    samples: usize,
    points: u64,
    blocks: usize,
    largest_block: u64,
    /// Points that are looked at by more than one block, as a share of all.
    halo_share: f64,
    seconds: f64,
}

impl PlanSummary {
    pub(super) fn of(plan: &Plan, seconds: f64) -> Self {
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

/// What work will cost.
#[derive(Serialize)]
#[serde(transparent)]
pub(super) struct PriceSummary(pub Price);

impl Display for PriceSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Price { samples, points, blocks, halo_share, memory_per_block, .. } = self.0;
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

/// What was run.
#[derive(Serialize)]
pub(super) struct RunSummary {
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

/// What was found of the files of a plan.
#[derive(Serialize)]
pub(super) struct CheckSummary {
    folder: String,
    /// What identifies the plan; nothing where it cannot be read.
    plan: Option<String>,
    /// How many there should be.
    blocks: Option<usize>,
    missing: Vec<usize>,
    findings: Vec<Found>,
    /// Whether all is there, as it was written.
    pub whole: bool,
}

/// A file that does not verify.
#[derive(Serialize)]
struct Found {
    path: String,
    what: String,
}

impl CheckSummary {
    pub(super) fn of(folder: &Path, plan: Option<&Plan>, checked: Checked) -> Self {
        let whole = checked.is_whole();
        let found = checked.findings.into_iter();
        Self {
            folder: folder.display().to_string(),
            plan: plan.map(Plan::digest),
            blocks: plan.map(|plan| plan.blocks.len()),
            findings: found
                .map(|found| Found { path: found.path.display().to_string(), what: found.what })
                .collect(),
            missing: checked.missing,
            whole,
        }
    }
}

impl Display for CheckSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for Found { path, what } in &self.findings {
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
