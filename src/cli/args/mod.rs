//! Options that several commands share, and how they become options of the library.

mod choices;
mod input;
mod labels;
mod select;
mod shape;
mod values;

use clap::{Args, Command};

pub(super) use input::InputArgs;
use input::PartArgs;
pub(super) use labels::{LabelArgs, of_gray_levels};
pub(super) use select::{Alphas, FrozenArgs, WeightArgs, one_alpha};
pub(super) use select::{HaarArgs, RefitArgs, SelectArgs};
pub(super) use shape::OutputArgs;
pub(super) use shape::PeriodicArgs;
pub(super) use shape::ShapeArgs;
pub(super) use values::not_negative;
#[cfg(feature = "render")]
pub(super) use values::number;

use super::errors::{CommandError, fail_usage};
use super::preset::PresetArgs;
use crate::Recipe;
use crate::interpolate::Refit;
use crate::shape::Torus;

/// From an input to weighted points.
#[derive(Args, Clone)]
pub(super) struct PipelineArgs<W: Args = WeightArgs> {
    #[command(flatten)]
    pub input: InputArgs,
    #[command(flatten)]
    preset: PresetArgs,
    #[command(flatten)]
    pub labels: LabelArgs,
    #[command(flatten)]
    pub haar: HaarArgs,
    #[command(flatten)]
    pub select: SelectArgs,
    #[command(flatten)]
    pub refit: RefitArgs,
    #[command(flatten)]
    pub weights: W,
}

impl<W: Args + Copy + Into<WeightArgs>> PipelineArgs<W> {
    /// The options of all stages except that of the shape.
    pub(super) fn recipe(&self) -> Result<Recipe, CommandError> {
        if self.labels.label.is_some() {
            LabelArgs::refuse_others(&self.input.typed)?;
        }
        let recipe = self.input.recipe().haar(self.haar.options()).refit(self.refit.refit);
        let recipe = recipe.labels(self.labels.label.clone());
        Ok(self.weights.into().set(self.select.set(recipe)?))
    }
}

impl PipelineArgs {
    /// The options of all stages.
    pub(super) fn recipe_of(
        &self,
        shape: &ShapeArgs,
        periodic: Option<Torus>,
    ) -> Result<Recipe, CommandError> {
        let recipe = shape.set(self.recipe()?.periodic(periodic))?;
        if periodic.is_some() {
            self.input
                .typed
                .refuse(&["refit"], "a periodic box repeats, and F is fitted in space")?;
        }
        if recipe.refit == Some(Refit::Whole) && recipe.memory.is_some() {
            fail_usage!("--memory has no effect: --refit fits values on the whole triangulation" => "omit it, or give --refit=shape");
        }
        Ok(recipe)
    }
}

/// From an input to points with weights that stay fixed while α varies.
pub(super) type FrozenPipelineArgs = PipelineArgs<FrozenArgs>;

/// The names of the options that apply to volumes only. `--level` and `--gray-out` apply to some files of points, too.
pub(super) fn volume_options() -> Vec<String> {
    let part = PartArgs::augment_args(Command::new("volume"));
    let points = SelectArgs::augment_args(HaarArgs::augment_args(part));
    let all = LabelArgs::augment_args(RefitArgs::augment_args(points));
    let names = all.get_arguments().map(|arg| arg.get_id().to_string());
    names
        .filter(|name| !["frame", "level"].contains(&name.as_str()))
        .chain(["gray".to_owned()])
        .collect()
}
