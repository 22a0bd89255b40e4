//! What was said on the command line, and whether it can have an effect.

use std::fmt;

use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches};

use super::config;
use super::said::{Said, misused};

/// The names of the options that the user gave on the command line; those of a file of `--config` are
/// for all inputs, and need not fit this one.
///
/// It must be the first field that a command parses: others take their values out of the matches.
#[derive(Clone, Debug, Default)]
pub(super) struct Given(Vec<String>);

impl Given {
    /// Refuses options that would have no effect; `why` follows their names.
    pub(super) fn refuse(
        &self,
        names: &[impl AsRef<str>],
        why: impl fmt::Display,
    ) -> Result<(), Said> {
        let wanted = self.0.iter().filter(|given| names.iter().any(|name| name.as_ref() == *given));
        let options: Vec<String> =
            wanted.map(|name| format!("--{}", name.replace('_', "-"))).collect();
        match &options[..] {
            [] => Ok(()),
            [one] => misused!("{one} has no effect: {why}" => "omit it"),
            several => {
                let names = several.join(", ");
                misused!("{names} have no effect: {why}" => "omit them")
            }
        }
    }
}

impl FromArgMatches for Given {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let typed = |name: &str| {
            matches.value_source(name) == Some(ValueSource::CommandLine) && !config::has_set(name)
        };
        let names = matches.ids().map(|id| id.as_str().to_owned());
        Ok(Self(names.filter(|name| typed(name)).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for Given {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}
