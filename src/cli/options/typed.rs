//! The options typed on the command line: those without effect are refused, and inputs are protected from being overwritten.

use std::fmt;
use std::path::Path;

use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches};
use walpha_files::keep_input;

use super::config::CONFIGURED;
use crate::cli::process::errors::{Result, fail_usage};
use crate::volume::files_of;

/// The names of the options that the user typed. Those from the file of `--config` are left out: they are for all inputs, and
/// need not apply to this one.
///
/// This must be the first field that a command parses, as the others remove their values from the matches.
#[derive(Clone, Debug, Default)]
pub(crate) struct TypedOptions(Vec<String>);

impl TypedOptions {
    /// Those of these options that are given, as they are typed.
    fn given(&self, names: &[impl AsRef<str>]) -> impl Iterator<Item = String> {
        let wanted = self.0.iter().filter(|given| names.iter().any(|name| name.as_ref() == *given));
        wanted.map(|name| format!("--{}", name.replace('_', "-")))
    }

    /// The first of these options that is given.
    pub(crate) fn first_of(&self, names: &[&str]) -> Option<String> {
        self.given(names).next()
    }

    /// Refuses options that would have no effect; `why` follows their names.
    pub(crate) fn refuse(&self, names: &[impl AsRef<str>], why: impl fmt::Display) -> Result<()> {
        let options: Vec<String> = self.given(names).collect();
        match &options[..] {
            [] => Ok(()),
            [one] => fail_usage!("{one} has no effect: {why}" => "omit it"),
            several => {
                let names = several.join(", ");
                fail_usage!("{names} have no effect: {why}" => "omit them")
            }
        }
    }
}

/// Whether an option is on the command line, and not only in the file of `--config`.
fn is_typed(matches: &ArgMatches, name: &str) -> bool {
    let configured = || matches.get_many::<String>(CONFIGURED).into_iter().flatten();
    matches.value_source(name) == Some(ValueSource::CommandLine)
        && !configured().any(|known| known == name)
}

impl FromArgMatches for TypedOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let names = matches.ids().map(|id| id.as_str().to_owned());
        Ok(Self(names.filter(|name| is_typed(matches, name)).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for TypedOptions {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}

/// The options that name files to read; positional arguments do so, too.
const READ: [&str; 4] = ["config", "input", "points", "radii"];
/// The options that name files to write.
const WRITTEN: [&str; 3] = ["output", "out", "mask"];
/// The option that lets outputs replace inputs.
const IN_PLACE: &str = "in_place";

/// Protects all inputs that a command line names from being replaced by an output.
pub(crate) fn protect_inputs(command: &Command, matches: &ArgMatches) -> Result<()> {
    let (mut command, mut matches, mut name) = (command, matches, String::from("walpha"));
    while let Some((of, inner)) = matches.subcommand()
        && let Some(subcommand) = command.find_subcommand(of)
    {
        (command, matches) = (subcommand, inner);
        name = format!("{name} {of}");
    }
    let args = || command.get_arguments();
    if matches.get_flag(IN_PLACE) {
        let writes = args().any(|arg| WRITTEN.contains(&arg.get_id().as_str()));
        if is_typed(matches, IN_PLACE) && !writes {
            fail_usage!("--in-place has no effect: `{name}` writes no file that it is given" => "omit it");
        }
        return Ok(());
    }
    let positional = args().filter(|arg| arg.is_positional()).map(|arg| arg.get_id().as_str());
    for id in positional.chain(READ) {
        let values = matches.try_get_raw(id).ok().flatten();
        values.into_iter().flatten().for_each(|value| keep_input(Path::new(value), files_of));
    }
    Ok(())
}
