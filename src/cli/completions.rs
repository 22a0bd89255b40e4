//! `walpha completions`: so that the shell knows commands and options.

use clap::Args;
use clap_complete::{Shell, generate};

use super::described;
use super::global::Global;
use super::output::print;

/// Print the completions of a shell: what to type after `walpha` and the tab key.
///
/// Example: walpha completions bash > ~/.local/share/bash-completion/completions/walpha
#[derive(Args)]
pub(super) struct Completions {
    /// The shell.
    #[arg(value_enum, value_name = "SHELL")]
    shell: Shell,
}

impl Completions {
    pub(super) fn run(self, _: Global) -> anyhow::Result<()> {
        let mut script = Vec::new();
        generate(self.shell, &mut described(), "walpha", &mut script);
        Ok(print(&String::from_utf8(script)?)?)
    }
}
