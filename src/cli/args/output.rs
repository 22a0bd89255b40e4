//! What format an output is of whose name does not say it.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::cli::said::misused;
use crate::export::Target;

/// The format of outputs without an extension.
#[derive(Args, Clone)]
#[command(next_help_heading = "Output")]
pub(crate) struct OutputArgs {
    /// Format of an output whose name does not say it, as standard output (-): its extension, as in
    /// --output-format nrrd.
    #[arg(long, value_name = "EXTENSION")]
    output_format: Option<String>,
}

impl OutputArgs {
    /// A path for an output whose extension names the format: its own path, if it has one.
    pub(crate) fn named(&self, path: &Path) -> anyhow::Result<PathBuf> {
        match &self.output_format {
            _ if path.extension().is_some() => Ok(path.to_owned()),
            Some(format) => Ok(format!("output.{}", format.trim_start_matches('.')).into()),
            None if path == Path::new(Target::STDOUT) => {
                misused!("standard output has no extension" => "name the format, as in --output-format nrrd")
            }
            None => Ok(path.to_owned()),
        }
    }

    /// Refuses the format where no output needs it.
    pub(crate) fn check<'a>(
        &self,
        mut outputs: impl Iterator<Item = &'a PathBuf>,
    ) -> anyhow::Result<()> {
        if self.output_format.is_some() && !outputs.any(|path| path.extension().is_none()) {
            misused!("--output-format has no effect: each output has an extension, which says its format" => "omit it");
        }
        Ok(())
    }
}
