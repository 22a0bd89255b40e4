//! `--preset`: named sets of options, which are files for `--config` that the program contains.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};

use super::args::{InputArgs, PipelineArgs, WeightArgs, of_gray_levels};
use super::config;
use crate::labels::{self, LabelChoice};
use crate::volume::{Hounsfield, Labels, Volume};
use crate::{HaarOptions, Recipe};

/// The name of the option.
pub(super) const OPTION: &str = "preset";
/// The preset that a CT gets where no option says what to look for.
pub(super) const OF_CT: &str = "ct-bone";
/// The preset that a segmentation gets where no option says what to look for.
pub(super) const OF_LABELS: &str = "labels";

/// Names and contents.
const PRESETS: [(&str, &str); 7] = [
    (OF_CT, include_str!("../../presets/ct-bone.toml")),
    ("ct-skin", include_str!("../../presets/ct-skin.toml")),
    (OF_LABELS, include_str!("../../presets/labels.toml")),
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
    tracing::warn!(
        "the values look like Hounsfield units ({:.0} % air, {:.0} % soft tissue), so bone is selected, as by \
         --preset {OF_CT}. The same, stated: {}",
        100.0 * air,
        100.0 * soft_tissue,
        stated(&settings),
    );
    let haar = if recipe.haar == HaarOptions::default() { bone.haar } else { recipe.haar };
    Some(recipe.clone().gray(bone.gray).choice(bone.choice).haar(haar))
}

/// The command line with these settings.
fn stated(settings: &[String]) -> String {
    // For a shell; no argument holds a zero byte.
    let typed: Vec<String> = std::env::args_os()
        .skip(1)
        .map(|arg| shlex::try_quote(&arg.to_string_lossy()).unwrap_or_default().into_owned())
        .collect();
    format!("walpha {} {}", typed.join(" "), settings.join(" ").replace('=', " "))
}

/// Whether an option says what to look for by gray levels, weights or α, so that a volume is not taken for labels.
pub(super) fn looks_for_gray_levels(args: &InputArgs) -> bool {
    let has = |name: &str| args.typed.has(name) || config::has_set(name);
    has(OPTION) || of_gray_levels().iter().any(|name| has(name))
}

/// [`suited`] for a volume in memory: for a segmentation whose labels nobody named the solid of all of them, with a warning that
/// says how to have it otherwise.
pub(super) fn suited_to(args: &InputArgs, recipe: &Recipe, volume: &Volume) -> Option<Recipe> {
    if recipe.labels.is_some() {
        return None;
    }
    let by_labels = !looks_for_gray_levels(args);
    if by_labels && let Some(found) = Labels::of_volume(volume) {
        let there: Vec<i32> = found.foreground().map(|(label, _)| label).collect();
        let how =
            if found.stated { "the file states labels" } else { "the values look like labels" };
        tracing::warn!(
            "{how} ({}), so the shape is the solid of all but 0, as by --preset {OF_LABELS}; --label takes some of \
             them, and --threshold, --count or --ratio selects points by gray levels. The same, stated: {}",
            labels::list(there.into_iter()),
            stated(&recipe_of(OF_LABELS).1),
        );
        return Some(recipe.clone().labels(Some(LabelChoice::All)));
    }
    if by_labels && volume.states_labels() {
        tracing::warn!(
            "the file states labels, but some are no whole numbers below 16777216 (2²⁴), from where on single precision does \
             not tell all apart: they are taken for gray levels"
        );
    }
    suited(args, recipe, || Hounsfield::of_volume(volume))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_of_the_command_is_that_of_the_library() {
        assert_eq!(recipe_of("paper").0, Recipe::paper().classifier(crate::shape::CGAL));
    }
}
