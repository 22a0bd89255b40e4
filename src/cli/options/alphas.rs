//! The option α for commands that make several shapes.

use std::str::FromStr;

use crate::Alpha;
use crate::cli::process::errors::{CommandError, Result, command_error};
use crate::pipeline::{AlphaRule, Parameter, PlacedVolume};

/// The α for a command that makes several sets of points from a volume. `auto` is refused, because each set would have a
/// different one.
pub(crate) fn one_alpha(rule: AlphaRule, source: &PlacedVolume) -> Result<Parameter> {
    rule.of_volume(&source.volume, source.units)?.ok_or_else(|| {
        command_error!(
            "there are several sets of points, each with an `auto` of its own" => "give α as a \
             number"
        )
    })
}

/// The values of α of a ladder.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Alphas {
    /// Critical values, chosen automatically.
    Auto,
    /// The given values.
    Given(Vec<Alpha>),
}

impl FromStr for Alphas {
    type Err = CommandError;

    fn from_str(text: &str) -> Result<Self> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        Ok(Self::Given(text.split(',').map(|item| item.trim().parse()).collect::<Result<_, _>>()?))
    }
}
