//! What is read is not written over, unless `--in-place` says so.

use std::path::Path;

use clap::parser::ValueSource;
use clap::{ArgMatches, Command};

use walpha_files::keep_input;

use super::config;
use super::said::misused;
use crate::volume::files_of;

/// Options that name files to read, as arguments without a name do.
const READ: [&str; 2] = ["input", "points"];
/// Options that name files to write.
const WRITTEN: [&str; 3] = ["output", "out", "mask"];
/// The option that allows it.
const IN_PLACE: &str = "in_place";

/// Keeps all that a command line names as inputs from being replaced by an output.
pub(super) fn keep(command: &Command, matches: &ArgMatches) -> anyhow::Result<()> {
    let (mut command, mut matches, mut name) = (command, matches, String::from("walpha"));
    while let Some((of, inner)) = matches.subcommand()
        && let Some(subcommand) = command.find_subcommand(of)
    {
        (command, matches) = (subcommand, inner);
        name = format!("{name} {of}");
    }
    let args = || command.get_arguments();
    if matches.get_flag(IN_PLACE) {
        let typed = matches.value_source(IN_PLACE) == Some(ValueSource::CommandLine);
        let writes = args().any(|arg| WRITTEN.contains(&arg.get_id().as_str()));
        if typed && !config::has_set(IN_PLACE) && !writes {
            misused!("--in-place has no effect: `{name}` writes no file that it is given" => "omit it");
        }
        return Ok(());
    }
    let is_read = |id: &str, is_positional: bool| is_positional || READ.contains(&id);
    for arg in args().filter(|arg| is_read(arg.get_id().as_str(), arg.is_positional())) {
        let values = matches.try_get_raw(arg.get_id().as_str()).ok().flatten();
        values.into_iter().flatten().for_each(|value| keep_input(Path::new(value), files_of));
    }
    Ok(())
}
