//! `--preset`: named settings, and those that suit an input where nobody says what to look for.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};

use super::{InputArgs, names, of_gray_levels};
use crate::labels::{self, LabelChoice};
use crate::settings::{CT_BONE, Group, LABELS, PRESETS, Settings};
use crate::volume::{Hounsfield, Labels, Volume};
use crate::{HaarOptions, Recipe};

/// The name of the option.
pub(crate) const OPTION: &str = "preset";

/// The option. [`Given`](super::settings::Given) has its settings.
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

/// The recipe for a CT whose selection nobody stated: that of bone, with a warning that says how to state it. `None` for
/// other volumes.
pub(crate) fn suited(
    args: &InputArgs,
    recipe: &Recipe,
    found: impl FnOnce() -> Option<Hounsfield>,
) -> Option<Recipe> {
    let given = args.settings();
    let states = |name: &str| name == "gray" || names(&[Group::Points]).contains(&name);
    if args.given.preset || given.iter().any(|(name, _)| states(name)) {
        return None;
    }
    let Hounsfield { air, soft_tissue, .. } = found()?;
    let settings = Settings::preset(CT_BONE).expect("a preset");
    let bone = settings.recipe().expect("presets do not contradict themselves");
    tracing::warn!(
        "the values look like Hounsfield units ({:.0} % air, {:.0} % soft tissue), so bone is selected, as by \
         --preset {CT_BONE}. The same, stated: {}",
        100.0 * air,
        100.0 * soft_tissue,
        stated(&settings),
    );
    let haar = if recipe.haar == HaarOptions::default() { bone.haar } else { recipe.haar };
    Some(recipe.clone().gray(bone.gray).choice(bone.choice).haar(haar))
}

/// The command line with these settings.
fn stated(settings: &Settings) -> String {
    // For a shell; no argument holds a zero byte.
    let typed: Vec<String> = std::env::args_os()
        .skip(1)
        .map(|arg| shlex::try_quote(&arg.to_string_lossy()).unwrap_or_default().into_owned())
        .collect();
    format!("walpha {} {}", typed.join(" "), settings.arguments().join(" ").replace('=', " "))
}

/// Whether an option says what to look for by gray levels, weights or α, so that a volume is not taken for labels.
pub(crate) fn looks_for_gray_levels(args: &InputArgs) -> bool {
    args.given.preset || of_gray_levels().iter().any(|name| args.settings().has(name))
}

/// [`suited`] for a volume in memory: for a segmentation whose labels nobody named the solid of all of them, with a warning that
/// says how to have it otherwise.
pub(crate) fn suited_to(args: &InputArgs, recipe: &Recipe, volume: &Volume) -> Option<Recipe> {
    if recipe.labels.is_some() || recipe.surface.is_some() {
        return None;
    }
    let by_labels = !looks_for_gray_levels(args);
    if by_labels && let Some(found) = Labels::of_volume(volume) {
        let there: Vec<i32> = found.foreground().map(|(label, _)| label).collect();
        let how =
            if found.stated { "the file states labels" } else { "the values look like labels" };
        tracing::warn!(
            "{how} ({}), so the shape is the solid of all but 0, as by --preset {LABELS}; --label takes some of \
             them, and --threshold, --count or --ratio selects points by gray levels. The same, stated: {}",
            labels::list(there.into_iter()),
            stated(&Settings::preset(LABELS).expect("a preset")),
        );
        return Some(recipe.clone().labels(Some(LabelChoice::All)));
    }
    if by_labels && volume.states_labels() {
        tracing::warn!(
            "the file states labels, but some are not whole numbers below 16777216 (2²⁴), from where on single precision does \
             not tell all apart: they are taken for gray levels"
        );
    }
    suited(args, recipe, || Hounsfield::of_volume(volume))
}
