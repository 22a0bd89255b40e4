//! The format of outputs.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::cli::process::errors::{Result, fail_usage};
use crate::export::Target;

/// The format of outputs without an extension.
#[derive(Args, Clone)]
#[command(next_help_heading = "Output")]
pub(crate) struct OutputArgs {
    /// Format of an output whose name has no extension, such as standard output (-), given as an
    /// extension, as in --output-format nrrd.
    #[arg(long, value_name = "EXTENSION")]
    output_format: Option<String>,
}

impl OutputArgs {
    /// Returns a path whose extension determines the format of an output: its own path, if that has an extension.
    pub(crate) fn named(&self, path: &Path) -> Result<PathBuf> {
        match &self.output_format {
            _ if path.extension().is_some() => Ok(path.to_owned()),
            Some(format) => Ok(format!("output.{}", format.trim_start_matches('.')).into()),
            None if path == Path::new(Target::STDOUT) => {
                fail_usage!("standard output has no extension" => "name the format, as in --output-format nrrd")
            }
            None => Ok(path.to_owned()),
        }
    }

    /// Refuses `--output-format` if no output needs it.
    pub(crate) fn check<'a>(&self, outputs: impl Iterator<Item = &'a PathBuf>) -> Result<()> {
        let mut outputs = outputs.peekable();
        if self.output_format.is_none() {
            return Ok(());
        }
        if outputs.peek().is_none() {
            fail_usage!("--output-format has no effect: no file is written" => "name an output, as in -o -, or omit it");
        }
        if !outputs.any(|path| path.extension().is_none()) {
            fail_usage!("--output-format has no effect: each output has an extension, which says its format" => "omit it");
        }
        Ok(())
    }
}
