//! `walpha man`: writes manual pages.

use std::path::PathBuf;

use clap::Args;
use clap_mangen::Man as Page;
use walpha_base::shown::shown;

use crate::export::Target;

use crate::cli::build_command;
use crate::cli::options::global::Global;
use crate::cli::process::errors::Result;
use crate::cli::process::output::{print, print_with};

/// Print the manual page, or write one for each command.
///
/// Example: walpha man -o ~/.local/share/man/man1
#[derive(Args)]
pub(crate) struct Man {
    /// Folder for walpha.1, walpha-shape.1 and so on; existing files are replaced [default: walpha.1 to
    /// standard output].
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

impl Man {
    pub(crate) fn run(self, global: Global) -> Result<()> {
        // The long version also names the licence, which belongs elsewhere in a manual page.
        let command = build_command().version(env!("CARGO_PKG_VERSION"));
        let Some(folder) = self.output else {
            return print_with(|mut out| Page::new(command).render(&mut out));
        };
        let documented = command.get_subcommands().filter(|sub| sub.get_name() != "help");
        for command in std::iter::once(&command).chain(documented) {
            let page = Page::new(command.clone());
            let path = folder.join(page.get_filename());
            Target::open(&path)?.write(|mut out| page.render(&mut out))?;
            if !global.quiet {
                print(&format!("wrote     {}\n", shown(&path)))?;
            }
        }
        Ok(())
    }
}
