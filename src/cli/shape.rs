//! `walpha shape`: the whole pipeline.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use walpha::alpha_shape;
use walpha::export::{Content, Exporter, Format, Target, UnknownFormat, write_all};
use walpha::shown::shown;

use super::args::{PipelineArgs, ShapeArgs};
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
    pipeline: PipelineArgs,
    /// Files to write: .ply, .off, .obj, .stl, .glb, .vtp (boundary), .vtu, .npz or .json (all
    /// simplices), .png (a picture); or - (standard output, with --format). Files that are there are replaced.
    #[arg(short, long, value_name = "FILE", num_args = 1..)]
    output: Vec<PathBuf>,
    /// Write text where a format has a binary form too (PLY).
    #[arg(long)]
    ascii: bool,
    #[command(flatten)]
    shape: ShapeArgs,
    #[command(flatten)]
    picture: PictureArgs,
}

impl Shape {
    pub fn run(self, global: Global) -> anyhow::Result<()> {
        // Before the long work: a bad option, extension or place costs nothing yet.
        self.shape.check(self.pipeline.weights.alpha(1.0))?;
        let mut targets = Vec::new();
        for path in &self.output {
            let name = self.pipeline.input.output(path)?;
            let exporter: Box<dyn Exporter> = if PictureArgs::wanted(&name) {
                Box::new(self.picture)
            } else {
                let known = Format::ALL.into_iter().map(|(_, extension)| extension);
                let unknown = |_| UnknownFormat::new(path, "a shape", known.chain(["png"]));
                Format::of(&name).map_err(unknown)?.exporter(self.ascii)
            };
            targets.push((Target::open(path)?, exporter));
        }

        let mut progress = Progress::new(global);
        let weighed = pipeline::weighted_points(&self.pipeline, &mut progress)?;
        let mut report = Report::of_points(&self.pipeline.input.input, &weighed);
        let options = self.shape.options(weighed.alpha);
        let shape = progress.stage("shape", || alpha_shape(weighed.points, &options))?;
        let shape = shape.meaning(weighed.coordinates);
        report.add_shape(&shape);
        let remark = |(target, exporter): &(Target, Box<dyn Exporter>)| {
            Some(format!("{}: {}", shown(target.path()), exporter.remark(&shape)?))
        };
        let remarks: Vec<String> = targets.iter().filter_map(remark).collect();
        progress.stage("write", || {
            write_all(targets.into_iter().map(|(target, exporter)| {
                let shape = &shape;
                let content = move |out: &mut dyn Write| exporter.write(shape, out);
                (target, Box::new(content) as Content<'_>)
            }))
        })?;
        let files = self.output.iter().map(|path| path.display().to_string()).collect();
        report.finish(progress.finish(), files);
        if !global.quiet {
            remarks.iter().for_each(|remark| eprintln!("walpha: {remark}"));
        }
        tell(global, &report)
    }
}
