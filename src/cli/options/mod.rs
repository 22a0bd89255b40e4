//! Options that several commands share, and their conversion to a recipe: help and syntax are defined here, the meaning in
//! [`Settings`](crate::settings::Settings).

mod alphas;
pub(super) mod config;
pub(super) mod formats;
pub(super) mod global;
pub(super) mod help;
mod input;
mod output_format;
#[cfg_attr(not(feature = "render"), path = "no_picture.rs")]
pub(super) mod picture;
pub(super) mod preset;
mod settings;
pub(super) mod typed;

use std::marker::PhantomData;

use clap::Args;

pub(super) use alphas::{Alphas, one_alpha};
pub(super) use input::InputArgs;
pub(super) use output_format::OutputArgs;
use preset::PresetArgs;
pub(super) use settings::{Declared, Groups};

use super::errors::Result;
use crate::Recipe;
use crate::points::Region;
use crate::settings::{Group, Settings, parse};

/// From an input to weighted points.
#[derive(Args, Clone)]
pub(super) struct PipelineArgs<W: Groups = WithAlpha> {
    #[command(flatten)]
    pub input: InputArgs,
    #[command(flatten)]
    preset: PresetArgs,
    #[command(flatten)]
    selection: Declared<Selection>,
    #[command(flatten)]
    weights: Declared<W>,
    #[arg(skip)]
    of: PhantomData<W>,
}

/// The options of the steps from an input to points with weights that do not change while α varies.
pub(super) type FrozenPipelineArgs = PipelineArgs<Frozen>;

/// The options of the wavelet stage.
pub(super) struct Wavelets;
/// The options for the selection of samples as points, and their values.
pub(super) struct Selection;
/// The options for α, and weights proportional to it.
#[derive(Clone)]
pub(super) struct WithAlpha;
/// The options for weights proportional to an α at which they are frozen.
#[derive(Clone)]
pub(super) struct Frozen;
/// The options for computing the shape.
pub(super) struct OfShape;
/// The option for a periodic box.
pub(super) struct Periodic;
/// Which components of the shape are kept.
pub(super) struct Kept;

impl Groups for Wavelets {
    const GROUPS: &[(Group, &str)] = &[(Group::Haar, "Wavelet stage")];
}

impl Groups for Selection {
    const GROUPS: &[(Group, &str)] = &[
        (Group::Labels, "Labels"),
        (Group::Haar, "Wavelet stage"),
        (Group::Points, "Points"),
        (Group::Coordinates, "Coordinates"),
        (Group::Refit, "Points"),
    ];
}

impl Groups for WithAlpha {
    const GROUPS: &[(Group, &str)] =
        &[(Group::Weights, "Weights and α"), (Group::Weighting, "Weights and α")];
}

impl Groups for Frozen {
    const GROUPS: &[(Group, &str)] =
        &[(Group::Frozen, "Weights, frozen"), (Group::Weighting, "Weights, frozen")];
}

impl Groups for OfShape {
    const GROUPS: &[(Group, &str)] = &[(Group::Shape, "Shape")];
}

impl Groups for Periodic {
    const GROUPS: &[(Group, &str)] = &[(Group::Periodic, "Shape")];
}

impl Groups for Kept {
    const GROUPS: &[(Group, &str)] = &[(Group::Keep, "Shape")];
}

impl<W: Groups> PipelineArgs<W> {
    /// The given settings of the command.
    pub(super) fn settings(&self) -> &Settings {
        self.input.settings()
    }

    /// The recipe with the given settings.
    pub(super) fn recipe(&self) -> Result<Recipe> {
        let typed = &self.input.typed;
        if self.settings().label().is_some() {
            refuse_gray_levels(&self.input)?;
        }
        let recipe = self.input.recipe()?;
        if recipe.periodic.is_some() {
            typed.refuse(&["refit"], "a periodic box repeats, and F is fitted in space")?;
        }
        Ok(recipe)
    }
}

/// The names of the settings in some groups.
pub(super) fn names(groups: &[Group]) -> Vec<&'static str> {
    groups.iter().flat_map(|group| Settings::names(*group)).collect()
}

/// The names of the settings for the selection of points by gray levels, their weights, and α: if one of them is given, a volume
/// is not taken for labels.
pub(super) fn of_gray_levels() -> Vec<&'static str> {
    let groups = [Group::Haar, Group::Points, Group::Refit, Group::Weights, Group::Weighting];
    names(&groups).into_iter().chain(["gray"]).collect()
}

/// The names of the settings that apply to points only.
pub(super) fn of_points() -> Vec<&'static str> {
    names(&[Group::Molecule])
        .into_iter()
        .chain(["columns", "class", "withheld", "value", "thin"])
        .collect()
}

/// The names of the settings that apply to volumes only. `--roi` applies to points, and `--level` and `--gray-out` to some files of
/// them, too.
pub(super) fn of_volumes() -> Vec<&'static str> {
    let groups =
        [Group::Part, Group::Labels, Group::Haar, Group::Points, Group::Coordinates, Group::Refit];
    let names = names(&groups).into_iter().chain(["gray"]);
    names.filter(|name| !["frame", "level", "roi"].contains(name)).collect()
}

/// Refuses typed options that have no effect on the solid of labels.
pub(super) fn refuse_gray_levels(input: &InputArgs) -> Result<()> {
    let mut refused = of_gray_levels();
    refused.extend(names(&[Group::Frozen, Group::Shape, Group::Periodic]));
    refused.push("gray_out");
    let why = "the solid of labels fills their voxels, without gray levels, weights and α";
    input.typed.refuse(&refused, why)
}

/// Parses a number that is not negative.
pub(super) fn not_negative(text: &str) -> Result<f64> {
    Ok(parse::not_negative(text)?)
}

/// Parses √α.
#[cfg(feature = "render")]
pub(super) fn radius(text: &str) -> Result<crate::Alpha> {
    Ok(parse::alpha_radius(text)?)
}

/// Parses a number.
#[cfg(feature = "render")]
pub(super) fn number(text: &str) -> Result<f64> {
    Ok(parse::number(text)?)
}

/// Parses a box in the units of the points.
pub(super) fn places(text: &str) -> Result<Region> {
    Ok(parse::places(text)?)
}
