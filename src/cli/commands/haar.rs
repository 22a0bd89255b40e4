//! `walpha haar`: performs only steps 1 to 5.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use crate::export::Target;
use crate::haar::smooth;
use crate::pipeline::Input;
use crate::progress::Stage;
use crate::volume::VolumeWriter;

use crate::cli::commands::pipeline::{accept, read};
use crate::cli::options::formats::volume_output;
use crate::cli::options::global::Global;
use crate::cli::options::{Declared, InputArgs, OutputArgs, Wavelets};
use crate::cli::process::errors::{Result, fail};
use crate::cli::process::output::print_summary;
use crate::cli::process::progress::Progress;
use crate::cli::report::{HaarReport, SCHEMA_VERSION};

/// Transform a volume, drop small coefficients, and transform it back.
///
/// Examples:
///
/// walpha haar ct.nii.gz --rms 4 -o smooth.nii.gz   # by an error of 4 gray levels
///
/// walpha haar sample:skull --coefficients 20000 -o smooth.npy   # by a number
#[derive(Args)]
pub(crate) struct Haar {
    #[arg(short, long, value_name = "FILE", help = volume_output("File to write the restored values to"))]
    output: Option<PathBuf>,
    #[command(flatten)]
    input: InputArgs,
    #[command(flatten)]
    haar: Declared<Wavelets>,
    #[command(flatten)]
    format: OutputArgs,
}

#[derive(Serialize)]
struct HaarSummary {
    schema_version: u32,
    input: String,
    haar: HaarReport,
}

impl Haar {
    pub(crate) fn run(self, global: Global) -> Result<()> {
        self.format.check(self.output.iter())?;
        let target = match &self.output {
            None => None,
            Some(path) => Some((VolumeWriter::of(&self.format.named(path)?)?, Target::open(path)?)),
        };
        let mut progress = Progress::new(global);
        let recipe = self.input.recipe()?;
        let read = read(&self.input, &recipe, &mut progress)?;
        if matches!(read, Input::Volume(..)) {
            accept(&read, &self.input)?;
        }
        let Input::Volume(volume) = read else {
            fail!("{} holds points", self.input.input => "name a volume");
        };
        let (volume, range) = recipe.grays(volume)?;
        let options = self.input.settings().transform();
        let (smoothed, truncation) = progress.stage(Stage::Haar, || smooth(&volume, &options))?;
        if let Some((format, target)) = target {
            let smoothed = smoothed.into_values(&recipe.written(range));
            progress.stage(Stage::Write, || target.write(|out| format.write(&smoothed, out)))?;
        }
        progress.finish();
        let haar = HaarReport::new(&truncation, &range);
        print_summary(
            global,
            &HaarSummary {
                schema_version: SCHEMA_VERSION,
                input: self.input.input.to_string(),
                haar,
            },
        )
    }
}

impl std::fmt::Display for HaarSummary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "{}", self.haar)
    }
}
