//! `--preset`: named sets of options, which are files for `--config` that the program contains.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};

use super::args::{InputArgs, PipelineArgs, WeightArgs};
use super::config;
use crate::volume::{Hounsfield, Volume};
use crate::{HaarOptions, Recipe};

/// The name of the option.
pub(super) const OPTION: &str = "preset";
/// The preset that a CT gets where no option says what to look for.
pub(super) const OF_CT: &str = "ct-bone";

/// Names and contents.
const PRESETS: [(&str, &str); 6] = [
    (OF_CT, include_str!("../../presets/ct-bone.toml")),
    ("ct-skin", include_str!("../../presets/ct-skin.toml")),
    ("mri", include_str!("../../presets/mri.toml")),
    ("points", include_str!("../../presets/points.toml")),
    ("molecule", include_str!("../../presets/molecule.toml")),
    ("paper", include_str!("../../presets/paper.toml")),
];

/// The options that say what to look for in a volume. With one of them, nothing is assumed.
const STATED: [&str; 11] = [
    OPTION,
    "gray",
    "gray_min",
    "value_min",
    "threshold",
    "count",
    "ratio",
    "select",
    "target_rmse",
    "max_error",
    "exchange",
];

/// The option. Its settings become arguments before these are parsed ([`config::with_settings`]).
#[derive(Clone, Copy)]
pub(super) struct PresetArgs;

impl Args for PresetArgs {
    fn augment_args(command: Command) -> Command {
        let names = PossibleValuesParser::new(PRESETS.map(|(name, _)| name));
        command.arg(Arg::new(OPTION).long(OPTION).value_name("NAME").help_heading("Input").value_parser(names).help(
            "Options for a kind of INPUT, as --print-config shows them; options that are given take precedence",
        ))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for PresetArgs {
    fn from_arg_matches(_: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(Self)
    }

    fn update_from_arg_matches(&mut self, _: &ArgMatches) -> Result<(), clap::Error> {
        Ok(())
    }
}

/// The content of a preset.
pub(super) fn text(name: &str) -> Option<&'static str> {
    PRESETS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// A preset as a recipe, and as arguments.
fn recipe_of(name: &str) -> (Recipe, Vec<String>) {
    let command = PipelineArgs::<WeightArgs>::augment_args(Command::new("walpha"));
    let settings = config::settings_as_arguments(&command, text(name).expect("a preset"));
    let all = ["walpha", "-"].into_iter().map(str::to_owned).chain(settings.iter().cloned());
    let matches = command.try_get_matches_from(all).expect("presets are options");
    let args =
        PipelineArgs::<WeightArgs>::from_arg_matches(&matches).expect("they have all fields");
    (args.recipe().expect("presets do not contradict themselves"), settings)
}

/// The recipe for a CT whose selection nobody stated: that of bone, with a warning that says how to state it. `None` for
/// other volumes.
pub(super) fn suited(
    args: &InputArgs,
    recipe: &Recipe,
    found: impl FnOnce() -> Option<Hounsfield>,
) -> Option<Recipe> {
    if STATED.iter().any(|name| args.typed.has(name) || config::has_set(name)) {
        return None;
    }
    let Hounsfield { air, soft_tissue, .. } = found()?;
    let (bone, settings) = recipe_of(OF_CT);
    let explicit = settings.join(" ").replace('=', " ");
    // For a shell; no argument holds a zero byte.
    let typed: Vec<String> = std::env::args_os()
        .skip(1)
        .map(|arg| shlex::try_quote(&arg.to_string_lossy()).unwrap_or_default().into_owned())
        .collect();
    tracing::warn!(
        "the values look like Hounsfield units ({:.0} % air, {:.0} % soft tissue), so bone is selected, as by \
         --preset {OF_CT}. The same, stated: walpha {} {explicit}",
        100.0 * air,
        100.0 * soft_tissue,
        typed.join(" "),
    );
    let haar = if recipe.haar == HaarOptions::default() { bone.haar } else { recipe.haar };
    Some(recipe.clone().gray(bone.gray).choice(bone.choice).haar(haar))
}

/// [`suited`] for a volume in memory.
pub(super) fn suited_to(args: &InputArgs, recipe: &Recipe, volume: &Volume) -> Option<Recipe> {
    suited(args, recipe, || Hounsfield::of_volume(volume))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_of_the_command_is_that_of_the_library() {
        assert_eq!(recipe_of("paper").0, Recipe::paper());
    }
}
