//! `walpha completions`: shell completion of commands and options.

use std::io::Write;

use clap::Args;
use clap_complete::{Shell, generate};

use super::build_command;
use super::errors::Result;
use super::global::Global;
use super::output::print_with;

/// Print the script with which a shell completes `walpha` commands.
///
/// Example: walpha completions bash > ~/.local/share/bash-completion/completions/walpha
#[derive(Args)]
pub(super) struct Completions {
    /// The shell.
    #[arg(value_enum, value_name = "SHELL")]
    shell: Shell,
}

impl Completions {
    pub(super) fn run(self, _: Global) -> Result<()> {
        let mut script = Vec::new();
        generate(self.shell, &mut build_command(), "walpha", &mut script);
        print_with(|out| out.write_all(&script))
    }
}
