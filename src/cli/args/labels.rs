//! Which labels of a segmentation a solid is of.

use clap::{Args, Command};

use super::{HaarArgs, RefitArgs, SelectArgs};
use crate::cli::command_line::TypedOptions;
use crate::cli::errors::CommandError;
use crate::labels::LabelChoice;

/// The labels to take.
#[derive(Args, Clone)]
#[command(next_help_heading = "Labels")]
pub(crate) struct LabelArgs {
    /// Make the solid of labels of a segmentation, as in 3 or 3,5, or of all that are not 0 (all): its cells fill their
    /// voxels, without α [default: all, where values are labels and no option says what to look for].
    #[arg(long, value_name = "N,N,…", allow_hyphen_values = true)]
    pub label: Option<LabelChoice>,
}

/// Options that say how points are selected by gray levels and weighted, and what α is: with one of them, a volume is not taken for labels.
pub(crate) fn of_gray_levels() -> Vec<String> {
    let selection = SelectArgs::augment_args(HaarArgs::augment_args(Command::new("points")));
    let all = RefitArgs::augment_args(selection);
    let names = all.get_arguments().map(|arg| arg.get_id().to_string());
    let names = names.filter(|name| !["units", "space"].contains(&name.as_str()));
    names.chain(["gray", "weights", "alpha", "alpha_radius"].map(str::to_owned)).collect()
}

/// Options of a shape by α, besides those.
const OF_ALPHA: [&str; 10] = [
    "alpha_ref",
    "balls",
    "engine",
    "blocks",
    "memory",
    "exterior",
    "hidden",
    "periodic",
    "gray_out",
    "require_3d",
];

impl LabelArgs {
    /// Refuses options that have no effect on the solid of labels.
    pub(crate) fn refuse_others(typed: &TypedOptions) -> Result<(), CommandError> {
        let names: Vec<String> =
            of_gray_levels().into_iter().chain(OF_ALPHA.map(str::to_owned)).collect();
        typed.refuse(
            &names,
            "the solid of labels fills their voxels, without gray levels, weights and α",
        )
    }
}
