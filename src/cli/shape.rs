//! `walpha shape`: the whole pipeline.

use std::path::PathBuf;

use anyhow::anyhow;
use clap::Args;
use walpha::alpha_shape;
use walpha::export::{Exporter, Format, Target};

use super::args::{HaarArgs, InputArgs, SelectArgs, ShapeArgs, WeightArgs};
use super::output::tell;
use super::picture::PictureArgs;
use super::progress::Progress;
use super::report::Report;
use super::{Global, pipeline};

/// Compute the weighted alpha shape of a volume or of points.
///
/// Example: walpha shape sample:skull --weights min-max --alpha 10 -o skull.ply skull.vtu
#[derive(Args)]
pub struct Shape {
    #[command(flatten)]
    input: InputArgs,
    /// Files to write: .ply, .off, .obj, .stl, .glb, .vtp (boundary), .vtu, .npz or .json (all
    /// simplices), .png (a picture).
    #[arg(short, long, value_name = "FILE", num_args = 1..)]
    output: Vec<PathBuf>,
    /// Write text where a format has a binary form too (PLY).
    #[arg(long)]
    ascii: bool,
    #[command(flatten)]
    haar: HaarArgs,
    #[command(flatten)]
    select: SelectArgs,
    #[command(flatten)]
    weights: WeightArgs,
    #[command(flatten)]
    shape: ShapeArgs,
    #[command(flatten)]
    picture: PictureArgs,
}

impl Shape {
    pub fn run(self, global: Global) -> anyhow::Result<()> {
        // Before the long work: a bad extension or place costs nothing yet.
        let mut targets = Vec::new();
        for path in &self.output {
            let exporter: Box<dyn Exporter> = if PictureArgs::wanted(path) {
                Box::new(self.picture)
            } else {
                let format = Format::of(path).map_err(|unknown| anyhow!("{unknown}, or .png"))?;
                format.exporter(self.ascii)
            };
            targets.push((Target::open(path)?, exporter));
        }

        let mut progress = Progress::new(global);
        let weighed = pipeline::weighted_points(
            &self.input,
            &self.haar,
            &self.select,
            &self.weights,
            &mut progress,
        )?;
        let alpha = self.weights.alpha();
        let mut report = Report::of_points(&self.input.input, &weighed, alpha);
        let options = self.shape.options(alpha);
        let shape = progress.stage("shape", || alpha_shape(weighed.points, &options))?;
        report.add_shape(&shape);
        let remark = |(target, exporter): &(Target, Box<dyn Exporter>)| {
            Some(format!("{}: {}", target.path().display(), exporter.remark(&shape)?))
        };
        let remarks: Vec<String> = targets.iter().filter_map(remark).collect();
        progress.stage("write", || {
            targets
                .into_iter()
                .try_for_each(|(target, exporter)| target.write(|out| exporter.write(&shape, out)))
        })?;
        let files = self.output.iter().map(|path| path.display().to_string()).collect();
        report.finish(progress.finish(), files);
        if !global.quiet {
            remarks.iter().for_each(|remark| eprintln!("walpha: {remark}"));
        }
        tell(global, &report)
    }
}
