//! α and the weights in proportion to it.

use std::str::FromStr;

use clap::Args;

use crate::cli::said::{Said, said};
use crate::pipeline::{AlphaRule, Parameter, Source};
use crate::{Alpha, Recipe, Weighting};

use super::values::alpha_radius;

/// α and the weights in proportion to it.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Weights and α")]
pub(crate) struct WeightArgs {
    /// The parameter α, a squared length in the units of the points; `inf` gives the convex hull,
    /// `auto` the smallest α at which all points lie in one solid component [default: auto for
    /// scattered points; 10·h² for a volume, where h³ is the volume of a voxel].
    #[arg(long, value_name = "A", group = "parameter", allow_negative_numbers = true)]
    alpha: Option<AlphaRule>,
    /// The parameter as a radius: α = R².
    #[arg(long, value_name = "R", value_parser = alpha_radius, group = "parameter",
          allow_negative_numbers = true)]
    alpha_radius: Option<Alpha>,
    #[arg(long, value_name = "KIND", allow_hyphen_values = true, help = weights_help())]
    pub weights: Option<Weighting>,
}

impl WeightArgs {
    /// α as it is asked for.
    pub(crate) fn alpha(&self) -> AlphaRule {
        self.alpha_radius.map(AlphaRule::Given).or(self.alpha).unwrap_or_default()
    }

    /// A recipe with these options.
    pub(super) fn set(self, recipe: Recipe) -> Recipe {
        recipe.alpha(self.alpha()).weighting(self.weights)
    }
}

/// α for work on a volume that makes several sets of points.
pub(crate) fn one_alpha(rule: AlphaRule, source: &Source) -> anyhow::Result<Parameter> {
    rule.of_volume(&source.volume, source.units)?.ok_or_else(|| {
        said!(
            "there are several sets of points, each with an `auto` of its own" => "give α as a \
             number"
        )
        .into()
    })
}

/// Weights in proportion to an α at which they are frozen.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Weights, frozen")]
pub(crate) struct FrozenArgs {
    /// The α, a squared length, for which weights are computed; they are the same at every level, so
    /// that levels are nested [default: as --alpha of `walpha shape`].
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    alpha_ref: Option<AlphaRule>,
    #[arg(long, value_name = "KIND", allow_hyphen_values = true, help = weights_help())]
    weights: Option<Weighting>,
}

impl From<FrozenArgs> for WeightArgs {
    fn from(FrozenArgs { alpha_ref, weights }: FrozenArgs) -> Self {
        Self { alpha: alpha_ref, alpha_radius: None, weights }
    }
}

/// The α of a ladder.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Alphas {
    /// Critical values, chosen to be readable.
    Auto,
    /// These.
    Given(Vec<Alpha>),
}

impl FromStr for Alphas {
    type Err = Said;

    fn from_str(text: &str) -> Result<Self, Said> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        Ok(Self::Given(text.split(',').map(|item| item.trim().parse()).collect::<Result<_, _>>()?))
    }
}

/// The help of `--weights`.
fn weights_help() -> String {
    format!(
        "Weights ω (squared lengths): {} [default: column where the input has weights, else common=0]",
        Weighting::known()
    )
}
