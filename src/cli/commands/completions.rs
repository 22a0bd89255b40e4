//! `walpha completions`: prints shell completions of commands and options.

use std::io::Write;

use clap::Args;
use clap_complete::{Shell, generate};

use crate::cli::build_command;
use crate::cli::options::global::Global;
use crate::cli::process::errors::Result;
use crate::cli::process::output::print_with;

/// Print the script with which a shell completes `walpha` commands.
///
/// Example: walpha completions bash > ~/.local/share/bash-completion/completions/walpha
#[derive(Args)]
pub(crate) struct Completions {
    /// The shell.
    #[arg(value_enum, value_name = "SHELL")]
    shell: Shell,
}

impl Completions {
    pub(crate) fn run(self, _: Global) -> Result<()> {
        let mut script = Vec::new();
        generate(self.shell, &mut build_command(), "walpha", &mut script);
        print_with(|out| out.write_all(&script))
    }
}
