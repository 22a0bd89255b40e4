//! `walpha points`: performs only steps 1 to 7.

use std::path::PathBuf;

use clap::Args;

use crate::export::Target;
use crate::pipeline::{Input, Values};
use crate::points::{Attributes, ModelMetadata, Packing, PointWriter};
use crate::progress::Stage;

use crate::cli::commands::pipeline::{self, VolumeSummary};
use crate::cli::options::formats::points_output;
use crate::cli::options::global::Global;
use crate::cli::options::{OutputArgs, PipelineArgs, not_negative};
use crate::cli::process::errors::{Result, fail_usage};
use crate::cli::process::output::print_summary;
use crate::cli::process::progress::Progress;
use crate::cli::report::Report;

/// Select points from a volume and weight them.
///
/// Examples:
///
/// walpha points ct.nii.gz --gray 0..1000 --gray-min 64 --count 100000 -o bone.csv   # bone
///
/// walpha points sample:skull --count 15956 --weights min-max -o skull.csv   # the skull of the paper
///
/// walpha points hard:voxels -o ties.csv   # an input full of ties
///
/// walpha points sample:tile --roi 691000:691030,:,: --thin 0.5 -o part.csv   # a part, thinned
///
/// walpha points sample:skull --select adaptive --target-rmse 2 -o skull.wvm   # within an error
#[derive(Args)]
pub(crate) struct Points {
    #[arg(short, long, value_name = "FILE", help = points_output())]
    output: Option<PathBuf>,
    #[command(flatten)]
    pipeline: PipelineArgs,
    // These follow the input, whose `TypedOptions` must be parsed first.
    /// Largest error of a value in a .wvm, in gray levels (for points without a volume: in units of their
    /// values). F is off by at most as much everywhere, and the file is smaller; 0 keeps every bit.
    #[arg(long, value_name = "E", value_parser = not_negative, default_value = "0",
          help_heading = "Packing")]
    value_error: f64,
    /// Layers of points in a .wvm, the most important first: --level 1 reads it without the last layer, a
    /// quarter of the points, and so on. One layer makes the smallest file.
    #[arg(long, value_name = "N", default_value = "1", help_heading = "Packing",
          value_parser = clap::value_parser!(u8).range(1..=i64::from(Packing::MOST_LAYERS)))]
    layers: u8,
    #[command(flatten)]
    format: OutputArgs,
}

impl Points {
    pub(crate) fn run(self, global: Global) -> Result<()> {
        self.format.check(self.output.iter())?;
        let target = match &self.output {
            None => None,
            Some(path) => {
                let name = self.format.named(path)?;
                Some((Target::open(path)?, PointWriter::of(&name)?))
            }
        };
        if !target.as_ref().is_some_and(|(_, writer)| writer.packs) {
            let why = "no .wvm is written";
            self.pipeline.input.typed.refuse(&["value_error", "layers"], why)?;
        }
        let mut progress = Progress::new(global);
        let PipelineArgs { input, .. } = &self.pipeline;
        let holds_columns = target.as_ref().is_some_and(|(_, writer)| writer.columns);
        let attributes = if holds_columns { Attributes::All } else { Attributes::None };
        let mut recipe = self.pipeline.recipe()?.attributes(attributes);
        let mut read = pipeline::read_suited(input, &mut recipe, &mut progress)?;
        let (mut columns, mut of_file) = (Vec::new(), ModelMetadata::default());
        if let Input::Points(points, facts) = &mut read {
            columns = std::mem::take(&mut points.columns);
            of_file = facts.clone();
        }
        let (weighed, volume) =
            pipeline::weigh(read, input, &recipe, Values::Written, &mut progress)?;
        let volume = volume.as_ref().map(VolumeSummary::of);
        if self.layers > 1 && weighed.order().is_none() {
            fail_usage!("--layers has no effect: the order of importance is known only of points selected from a volume" => "omit it");
        }
        if let Some((target, writer)) = target {
            let facts =
                weighed.metadata(volume.map(|volume| volume.written)).order(weighed.order());
            let facts = facts.crs(of_file.crs).las(of_file.las).columns(of_file.columns);
            let step = facts.range.filter(|_| volume.is_some()).map_or(1.0, |range| range.step());
            let packing =
                Packing::default().value_error(self.value_error * step).layers(self.layers);
            progress.stage(Stage::Write, || {
                target.write(|out| {
                    writer.write_model(&weighed.points, &columns, &facts, &packing, out)
                })
            })?;
        }
        let mut report = Report::of_points(&self.pipeline.input.input, &weighed, volume.as_ref());
        report.example = "points.csv (or .npy, .wvm)";
        let files = self.output.iter().map(|path| path.display().to_string()).collect();
        report.finish(progress.finish(), files);
        print_summary(global, &report)
    }
}
