//! `--preset`: named settings, and the choice of settings for an input if the user does not say what to look for.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};

use super::{InputArgs, of_gray_levels};
use crate::Recipe;
use crate::labels::{self, LabelChoice};
use crate::settings::{CT_BONE, LABELS, MRI, PRESETS, Settings};
use crate::volume::{Hounsfield, Labels, Volume};

/// The name of the option.
pub(crate) const OPTION: &str = "preset";

/// The option. Its settings are in [`Given`](super::settings::Given).
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

/// The recipe for a CT if the user stated no selection: that for bone, with a note that shows how to state it. `None` for
/// other volumes.
pub(crate) fn suited(
    args: &InputArgs,
    recipe: &Recipe,
    found: impl FnOnce() -> Option<Hounsfield>,
) -> Option<Recipe> {
    if args.given.preset {
        return None;
    }
    let bone = args.settings().for_ct(recipe)?;
    let Some(Hounsfield { air, soft_tissue, .. }) = found() else {
        // Weights are those of the paper.
        if !args.settings().has("weights") {
            tracing::info!(
                "samples are selected by gray difference, the paper's method; --preset {MRI} makes the surface of the object instead"
            );
        }
        return None;
    };
    let settings = Settings::preset(CT_BONE).expect("a preset");
    tracing::info!(
        "the values look like Hounsfield units ({:.0} % air, {:.0} % soft tissue): bone is selected, as by --preset \
         {CT_BONE} ({})",
        100.0 * air,
        100.0 * soft_tissue,
        stated(&settings),
    );
    Some(bone)
}

/// Settings as options on a command line.
fn stated(settings: &Settings) -> String {
    settings.arguments().join(" ").replace('=', " ")
}

/// Whether an option says what to look for by gray levels, weights or α, so that a volume is not taken for labels.
pub(crate) fn looks_for_gray_levels(args: &InputArgs) -> bool {
    args.given.preset || of_gray_levels().iter().any(|name| args.settings().has(name))
}

/// Like [`suited`], for a volume in memory. For a segmentation without named labels, it is the recipe for the solid of all
/// labels, with a note that says how to get another.
pub(crate) fn suited_to(args: &InputArgs, recipe: &Recipe, volume: &Volume) -> Option<Recipe> {
    if recipe.labels.is_some() || recipe.surface.is_some() {
        return None;
    }
    let by_labels = !looks_for_gray_levels(args);
    if by_labels && let Some(found) = Labels::of_volume(volume) {
        let there: Vec<i32> = found.foreground().map(|(label, _)| label).collect();
        let how =
            if found.stated { "the file states labels" } else { "the values look like labels" };
        tracing::info!(
            "{how} ({}): the shape is the solid of all but 0, as by --preset {LABELS}; --label takes some of them, \
             and --threshold, --count or --ratio selects points by gray levels",
            labels::list(there.into_iter()),
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
