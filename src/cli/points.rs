//! `walpha points`: steps 1 to 7 alone.

use std::path::PathBuf;

use anyhow::bail;
use clap::Args;
use walpha::export::{Target, UnknownFormat};
use walpha::points::{write_csv, write_npy};
use walpha::progress::Stage;

use super::args::PipelineArgs;
use super::output::tell;
use super::progress::Progress;
use super::report::Report;
use super::{Global, pipeline};

/// Select points from a volume and weigh them.
///
/// Examples:
///
/// walpha points ct.nii.gz --gray 0..1000 --gray-min 64 --count 100000 -o bone.csv
///
/// walpha points sample:skull --count 15956 --weights min-max -o skull.csv
#[derive(Args)]
pub struct Points {
    /// File to write, replaced if it is there: .csv (header x,y,z,weight,value) or .npy (the same
    /// columns); or - (standard output, with --format).
    #[arg(short, long, value_name = "FILE")]
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
                let extension = name.extension().unwrap_or_default().to_ascii_lowercase();
                let csv = extension == "csv";
                if !csv && extension != "npy" {
                    bail!(UnknownFormat::new(&name, "points", ["csv", "npy"]));
                }
                Some((Target::open(path)?, csv))
            }
        };
        let mut progress = Progress::new(global);
        let (weighed, volume) = pipeline::weighted_points(&self.pipeline, &mut progress)?;
        if let Some((target, csv)) = target {
            progress.stage(Stage::Write, || {
                target.write(|out| {
                    if csv {
                        write_csv(&weighed.points, out)
                    } else {
                        write_npy(&weighed.points, out)
                    }
                })
            })?;
        }
        let mut report = Report::of_points(&self.pipeline.input.input, &weighed, volume.as_ref());
        let files = self.output.iter().map(|path| path.display().to_string()).collect();
        report.finish(progress.finish(), files);
        tell(global, &report)
    }
}
