//! `walpha convert`: converts a volume to Zarr.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use walpha_base::shown::{counted, shown};

use crate::progress::Stage;
use crate::volume::{Nan, OpenVolume, Source, convert};

use crate::cli::commands::pipeline::{with_file, with_points};
use crate::cli::options::InputArgs;
use crate::cli::options::global::Global;
use crate::cli::process::errors::{Result, fail_usage};
use crate::cli::process::output::{name, print_summary};
use crate::cli::process::progress::Progress;

/// Convert a volume to Zarr, which can be read in parts.
///
/// Formats that can be read in parts are converted part by part, at any size; others are read at once. Values are
/// written as they are read: whole numbers beyond 16777216 (2²⁴) and doubles are rounded to single precision.
///
/// Example:
///
/// walpha convert scan.nrrd -o scan.zarr   # to read parts of it later
#[derive(Args)]
pub(crate) struct Convert {
    /// Folder to write (.zarr); it must not exist yet.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    input: InputArgs,
}

#[derive(Serialize)]
struct ConvertSummary {
    input: String,
    dims: [usize; 3],
    file: String,
    seconds: f64,
}

impl std::fmt::Display for ConvertSummary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [x, y, z] = self.dims;
        writeln!(f, "input     {}  {x}×{y}×{z} samples", name(&self.input))?;
        writeln!(f, "wrote     {} in {:.2} s", name(&self.file), self.seconds)
    }
}

impl Convert {
    pub(crate) fn run(self, global: Global) -> Result<()> {
        if self.output.extension().is_none_or(|extension| extension != "zarr") {
            let path = shown(&self.output);
            fail_usage!("{path} does not end with .zarr, the one format written" => "give it a name that does");
        }
        let without_effect = ["gray", "gray_out", "columns", "nan"];
        self.input.typed.refuse(&without_effect, "values are converted as they are")?;
        let mut progress = Progress::new(global);
        let options = self.input.options();
        let dims = with_file(&self.input, |input| {
            let volume = OpenVolume::open(input)?;
            let source = if let Ok(source) = volume.source(&options) {
                source
            } else {
                // Samples that are not finite come out as NaN.
                let options = options.clone().nan(Some(Nan::Mask));
                let read = || volume.read(&options);
                let volume = progress.stage(Stage::Read, read).map_err(with_points)?;
                let missing = (volume.dims().samples() - volume.samples_there()) as u64;
                if missing > 0 {
                    tracing::warn!(
                        "{} of padding, or not finite, written as NaN, for --nan to mask where it is read",
                        counted(missing, "sample")
                    );
                }
                Source::of_volume(volume)
            };
            progress.stage(Stage::Write, || convert(&source, &self.output))?;
            Ok(source.dims().xyz())
        })?;
        let seconds = progress.total();
        let (input, file) = (self.input.input.to_string(), self.output.display().to_string());
        print_summary(global, &ConvertSummary { input, dims, file, seconds })
    }
}
