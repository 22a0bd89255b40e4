//! Options of the wavelet stage, of the selection of points, of their weights, and α.

use std::str::FromStr;

use clap::{Args, ValueEnum};

use super::choices::choice;
use super::values::{alpha_radius, count, not_nan, not_negative, share};
use crate::cli::errors::{CommandError, command_error, fail_usage};
use crate::interpolate::Refit;
use crate::pipeline::{AlphaRule, Choice, Goal, Parameter, Source};
use crate::{
    Alpha, Decomposition, HaarOptions, Recipe, Selection, SelectionRule, Space, Tolerance, Units,
    Weighting,
};

/// The wavelet stage.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Wavelet stage")]
pub(crate) struct HaarArgs {
    /// Decomposition: all axes once per level, or each axis fully.
    #[arg(long, value_parser = choice::<Decomposition>(), default_value = "non-standard",
          value_name = "KIND")]
    haar: Decomposition,
    /// Root mean square error allowed, in gray levels.
    #[arg(long, value_name = "E", group = "tolerance", value_parser = not_negative,
          default_value = "1")]
    rms: f64,
    /// L² norm of the error allowed, in gray levels.
    #[arg(long, value_name = "E", group = "tolerance", value_parser = not_negative)]
    epsilon: Option<f64>,
    /// Coefficients to keep.
    #[arg(long, value_name = "N", group = "tolerance")]
    coefficients: Option<u64>,
}

impl HaarArgs {
    /// The stage's options.
    pub(crate) fn options(&self) -> HaarOptions {
        let tolerance = match (self.epsilon, self.coefficients) {
            (Some(epsilon), _) => Tolerance::Epsilon(epsilon),
            (_, Some(count)) => Tolerance::Coefficients(count),
            _ => Tolerance::Rms(self.rms),
        };
        HaarOptions::default().decomposition(self.haar).tolerance(tolerance)
    }
}

/// Which samples become points.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Points")]
pub(crate) struct SelectArgs {
    /// Select the samples of largest gray difference, or adaptively: starting from the corners of the
    /// volume, those where the interpolant of the previous ones is worst.
    #[arg(long, value_enum, default_value_t, value_name = "HOW")]
    select: SelectArg,
    /// Adaptive: stop when the RMSE of the interpolant over all samples is at most E gray levels
    /// (--rms belongs to the wavelet stage). With --count or --ratio: at whichever comes first.
    #[arg(long, value_name = "E", value_parser = not_negative)]
    target_rmse: Option<f64>,
    /// Adaptive: stop when no sample is further than E gray levels from the interpolant, choosing points
    /// by that error. With --count or --ratio: at whichever comes first.
    #[arg(long, value_name = "E", value_parser = not_negative,
          conflicts_with_all = ["target_rmse", "exchange"])]
    max_error: Option<f64>,
    /// Adaptive: exchange points that contribute little for samples that contribute more, until no
    /// exchange gains anything. The error is that of fitted values: give --refit, too.
    #[arg(long)]
    exchange: bool,
    /// Keep N samples.
    #[arg(long, value_name = "N", group = "rule", value_parser = count)]
    count: Option<u64>,
    /// Keep this share of all samples, 0 < R ≤ 1 [default: 0.0609, or all samples that differ from a
    /// neighbour if these are fewer].
    #[arg(long, value_name = "R", group = "rule", value_parser = share)]
    ratio: Option<f64>,
    /// Keep the samples whose gray difference is at least T gray levels.
    #[arg(long, value_name = "T", group = "rule", value_parser = not_nan,
          allow_negative_numbers = true)]
    threshold: Option<f64>,
    /// Drop samples below this gray level after truncation.
    #[arg(long, value_name = "G", value_parser = not_nan, allow_negative_numbers = true)]
    gray_min: Option<f64>,
    /// Drop samples below this value of INPUT, as in --value-min 300 for Hounsfield units.
    #[arg(long, value_name = "V", allow_negative_numbers = true, conflicts_with = "gray_min")]
    value_min: Option<f64>,
    #[command(flatten)]
    coordinates: CoordinateArgs,
}

/// Which values points get.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Points")]
pub(crate) struct RefitArgs {
    /// Fit the values of points to the volume by least squares: to all its samples, on the triangulation
    /// that interpolate --fill uses, or to those that the shape covers. Otherwise points have the
    /// values of their samples.
    #[arg(long, value_parser = choice::<Refit>(), value_name = "TO", num_args = 0..=1, require_equals = true,
          default_missing_value = "whole")]
    pub refit: Option<Refit>,
}

/// Coordinates of points and shapes, and the unit of all lengths.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Coordinates")]
pub(super) struct CoordinateArgs {
    /// Coordinates, α, weights and sizes in voxels, or in the unit of the file [default: world where the
    /// file states a spacing or an origin, otherwise voxel].
    #[arg(long, value_parser = choice::<Units>(), value_name = "UNITS")]
    units: Option<Units>,
    /// Direction of world coordinates, where the file states the patient's orientation: x to the left
    /// and y to the back (lps), or to the right and the front (ras) [default: lps].
    #[arg(long, value_parser = choice::<Space>(), value_name = "SPACE")]
    space: Option<Space>,
}

#[derive(Clone, Copy, Default, PartialEq, ValueEnum)]
enum SelectArg {
    #[default]
    Difference,
    Adaptive,
}

impl SelectArgs {
    /// The rule by which samples are selected.
    pub(crate) fn rule(&self) -> SelectionRule {
        match (self.count, self.threshold) {
            (Some(count), _) => SelectionRule::Count(count),
            (_, Some(threshold)) => SelectionRule::Threshold(threshold),
            _ => self.ratio.map_or_else(SelectionRule::default, SelectionRule::Ratio),
        }
    }

    /// How samples are chosen as points, and the least value of INPUT that is kept.
    fn choice(&self) -> Result<(Choice, Option<f64>), CommandError> {
        if self.select != SelectArg::Adaptive {
            if self.target_rmse.is_some() {
                fail_usage!("--target-rmse belongs to --select adaptive" => "add it, or use --count");
            }
            if self.max_error.is_some() || self.exchange {
                fail_usage!("--max-error and --exchange belong to --select adaptive" => "add it");
            }
            let selection = Selection::default().rule(self.rule()).gray_min(self.gray_min);
            return Ok((Choice::Difference(selection), self.value_min));
        }
        if self.threshold.is_some() || self.gray_min.or(self.value_min).is_some() {
            fail_usage!("--threshold, --gray-min and --value-min choose by gray levels, which --select adaptive does not" => "use --count, --ratio or --target-rmse");
        }
        let goal = Goal {
            count: self.count,
            ratio: self.ratio,
            rmse: self.target_rmse,
            max_error: self.max_error,
        };
        Ok((if self.exchange { Choice::Exchanged(goal) } else { Choice::Adaptive(goal) }, None))
    }

    /// A recipe with these options.
    pub(super) fn set(&self, recipe: Recipe) -> Result<Recipe, CommandError> {
        let (choice, value_min) = self.choice()?;
        let CoordinateArgs { units, space } = self.coordinates;
        Ok(recipe.choice(choice).value_min(value_min).units(units).space(space))
    }
}

/// α and the weights in proportion to it.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Weights and α")]
pub(crate) struct WeightArgs {
    /// The parameter α, a squared length in the units of the points: auto takes it from the spacing of
    /// the points, auto:connected is the smallest at which all points lie in one solid component, and
    /// inf gives the convex hull [default: auto for scattered points; 10·h² for a volume, where h³ is the
    /// volume of a voxel].
    #[arg(long, value_name = "A", group = "parameter", allow_negative_numbers = true)]
    alpha: Option<AlphaRule>,
    /// The parameter as a radius: α = R².
    #[arg(long, value_name = "R", value_parser = alpha_radius, group = "parameter",
          allow_negative_numbers = true)]
    alpha_radius: Option<Alpha>,
    #[arg(long, value_name = "KIND", allow_hyphen_values = true, help = WEIGHTS, long_help = weights_help())]
    pub weights: Option<Weighting>,
}

impl WeightArgs {
    /// The α asked for.
    pub(crate) fn alpha(&self) -> AlphaRule {
        self.alpha_radius.map(AlphaRule::Given).or(self.alpha).unwrap_or_default()
    }

    /// A recipe with these options.
    pub(super) fn set(self, recipe: Recipe) -> Recipe {
        recipe.alpha(self.alpha()).weighting(self.weights)
    }
}

/// α for a command that makes several sets of points from a volume. `auto` is refused, because each set would have its own.
pub(crate) fn one_alpha(rule: AlphaRule, source: &Source) -> anyhow::Result<Parameter> {
    rule.of_volume(&source.volume, source.units)?.ok_or_else(|| {
        command_error!(
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
    /// that levels are nested [default: as --alpha of walpha shape].
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    alpha_ref: Option<AlphaRule>,
    #[arg(long, value_name = "KIND", allow_hyphen_values = true, help = WEIGHTS, long_help = weights_help())]
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
    /// Critical values, chosen automatically.
    Auto,
    /// The values given.
    Given(Vec<Alpha>),
}

impl FromStr for Alphas {
    type Err = CommandError;

    fn from_str(text: &str) -> Result<Self, CommandError> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        Ok(Self::Given(text.split(',').map(|item| item.trim().parse()).collect::<Result<_, _>>()?))
    }
}

/// The short help of `--weights`.
const WEIGHTS: &str = "Weights ω: common=C, min-max, barycentric, barycentric-n or column; none unless the input has a column";

/// The help of `--weights`.
fn weights_help() -> String {
    format!(
        "Weights ω (squared lengths): {} [default: column where the input has weights, else common=0]; where \
         column is asked for and no column is called weight or radius, its values are taken",
        Weighting::known()
    )
}
