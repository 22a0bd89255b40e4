//! `walpha points`: steps 1 to 7 alone.

use std::path::PathBuf;

use clap::Args;

use crate::export::Target;
use crate::points::PointWriter;
use crate::progress::Stage;

use super::args::PipelineArgs;
use super::formats::points_output;
use super::output::tell;
use super::progress::Progress;
use super::report::Report;
use super::{Global, pipeline};

/// Select points from a volume and weight them.
///
/// Examples:
///
/// walpha points ct.nii.gz --gray 0..1000 --gray-min 64 --count 100000 -o bone.csv
///
/// walpha points sample:skull --count 15956 --weights min-max -o skull.csv
#[derive(Args)]
pub struct Points {
    #[arg(short, long, value_name = "FILE", help = points_output())]
    output: Option<PathBuf>,
    #[command(flatten)]
    pipeline: PipelineArgs,
}

impl Points {
    pub fn run(self, global: Global) -> anyhow::Result<()> {
        self.pipeline.input.check_format(self.output.iter())?;
        let target = match &self.output {
            None => None,
            Some(path) => {
                let name = self.pipeline.input.output(path)?;
                Some((Target::open(path)?, PointWriter::of(&name)?))
            }
        };
        let mut progress = Progress::new(global);
        let stages = pipeline::stages(&self.pipeline);
        let (weighed, volume) = pipeline::weighted_points(&self.pipeline, stages, &mut progress)?;
        if let Some((target, writer)) = target {
            progress
                .stage(Stage::Write, || target.write(|out| writer.write(&weighed.points, out)))?;
        }
        let mut report = Report::of_points(&self.pipeline.input.input, &weighed, volume.as_ref());
        let files = self.output.iter().map(|path| path.display().to_string()).collect();
        report.finish(progress.finish(), files);
        tell(global, &report)
    }
}
