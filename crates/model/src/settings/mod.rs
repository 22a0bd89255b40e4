//! The options of a [`Recipe`] as users write them: on the command line, in a file for `--config`, as a preset, or in the page.
//!
//! All of these use one vocabulary: a setting has one name and one parser, which are defined here. [`Settings::recipe`] defines
//! its meaning; the command adds its help.

mod choices;
pub mod parse;

use std::num::NonZeroUsize;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Map, Value};
use walpha_base::advice::{Advice, Advise, Category, Setting, advice};
use walpha_points::haar::{Decomposition, HaarOptions, Tolerance};
use walpha_points::{
    AtomSelection, Columns, Models, Radii, Selection, SelectionRule, Units, Weighting,
};
use walpha_shape::{Alpha, Balls, Engine, Keep, Largest};
use walpha_volume::{Dims, Dtype, Endian, GrayRange, Nan, RawLayout, ReadOptions, Space};

use crate::Recipe;
use crate::interpolate::Refit;
use crate::labels::LabelChoice;
use crate::pipeline::{AlphaRule, Choice, Goal, PeriodicBox};
use crate::surface::SurfaceChoice;
pub use choices::Select;
use parse::Part;

/// An error of a setting, and advice about it. Both may name settings.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{why}")]
pub struct SettingError {
    /// What is wrong.
    pub why: Advice,
    /// What to do about it.
    pub next: Option<Advice>,
}

impl SettingError {
    fn new(why: impl Into<Advice>, next: impl Into<Advice>) -> Self {
        Self { why: why.into(), next: Some(next.into()) }
    }

    fn of(error: &impl Advise) -> Self {
        Self { why: error.message(), next: error.advice() }
    }
}

impl Advise for SettingError {
    fn message(&self) -> Advice {
        self.why.clone()
    }

    fn advice(&self) -> Option<Advice> {
        self.next.clone()
    }

    fn category(&self) -> Category {
        Category::Usage
    }
}

/// A preset: its name, and its settings in TOML.
pub type Preset = (&'static str, &'static str);

/// The preset for bone in a CT.
pub const CT_BONE: &str = "ct-bone";
/// The preset for an object in values without a unit.
pub const MRI: &str = "mri";
/// The preset for the solid of all labels.
pub const LABELS: &str = "labels";
/// All presets.
pub const PRESETS: [Preset; 7] = [
    (CT_BONE, include_str!("../../presets/ct-bone.toml")),
    ("ct-skin", include_str!("../../presets/ct-skin.toml")),
    (LABELS, include_str!("../../presets/labels.toml")),
    (MRI, include_str!("../../presets/mri.toml")),
    ("points", include_str!("../../presets/points.toml")),
    ("molecule", include_str!("../../presets/molecule.toml")),
    ("paper", include_str!("../../presets/paper.toml")),
];

/// Groups of settings of which only one may be used.
const EXCLUSIVE: &[&[&str]] = &[
    &["rms", "epsilon", "coefficients"],
    &["count", "ratio", "threshold"],
    &["gray_min", "value_min"],
    &["max_error", "target_rmse"],
    &["max_error", "exchange"],
    &["alpha", "alpha_radius"],
    &["blocks", "memory"],
    &["dims", "input_format"],
    &["dims", "level"],
    &["dims", "array"],
    &["dims", "frame"],
    &["dims", "series"],
    &["dims", "skip_damaged"],
    &["dims", "no_resample"],
];

/// The setting that makes the solid inside an isosurface.
const SURFACE: &str = "surface";

/// Whether a setting has no effect on the solid inside an isosurface: it is about gray levels, points, α or how a shape of α is computed.
fn is_not_of_surface(name: &str, group: Group) -> bool {
    use Group::{Frozen, Haar, Periodic, Points, Refit, Shape, Weighting, Weights};
    [Frozen, Haar, Periodic, Points, Refit, Shape, Weighting, Weights].contains(&group)
        || ["gray", "gray_out", "label"].contains(&name)
}

macro_rules! settings {
    ($($group:ident { $($(#[$doc:meta])* $name:ident: $kind:ty = $parse:expr,)* })*) => {
        /// A group of settings, which a command has as a whole.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs, reason = "their settings say what they are about")]
        pub enum Group {
            $($group),*
        }

        /// The settings that were given; the others have their defaults. Names are those of the methods; in files and on the
        /// command line they have hyphens.
        ///
        /// ```
        /// use walpha_model::settings::Settings;
        ///
        /// let bone = Settings::preset("ct-bone").expect("a preset");
        /// let mut mine = Settings::default();
        /// mine.set("count", "1000")?;
        /// let both = mine.over(&bone);
        /// assert_eq!((both.count(), both.threshold(), both.rms()), (Some(&1000), None, Some(&4.0)));
        /// let recipe = both.recipe()?;
        /// # Ok::<(), walpha_model::settings::SettingError>(())
        /// ```
        #[derive(Clone, Debug, Default)]
        pub struct Settings {
            $($($name: Option<$kind>,)*)*
            /// All given settings as they were written, in this order.
            written: Vec<(&'static str, String)>,
        }

        impl Settings {
            /// The names of all settings with their groups.
            pub const NAMES: &[(&str, Group)] = &[$($((stringify!($name), Group::$group),)*)*];

            $($($(#[$doc])* pub fn $name(&self) -> Option<&$kind> {
                self.$name.as_ref()
            })*)*

            /// Parses a setting of this name and stores it.
            fn store(&mut self, name: &str, text: &str) -> Result<(), SettingError> {
                match name {
                    $($(stringify!($name) => self.$name = Some($parse(text)?),)*)*
                    _ => unreachable!("{name} is among the names"),
                }
                Ok(())
            }

            fn forget(&mut self, name: &str) {
                match name {
                    $($(stringify!($name) => self.$name = None,)*)*
                    _ => {}
                }
                self.written.retain(|(known, _)| *known != name);
            }
        }
    };
}

settings! {
    Input {
        /// Format of the input, as an extension.
        input_format: String = parse::input_format,
        /// Values that become gray 0 and 255.
        gray: GrayRange = parse::gray_range,
        /// Whether gray levels are written.
        gray_out: bool = parse::switch,
        /// Columns of a table of points.
        columns: Columns = parse::own,
        /// Classes of points in LAS.
        class: Vec<u8> = parse::classes,
        /// Whether withheld points in LAS are read.
        withheld: bool = parse::switch,
        /// Column of points that is F.
        value: String = parse::column,
        /// Side of the cubes of which one point is kept.
        thin: f64 = parse::positive,
    }
    Molecule {
        /// Where the radii of atoms come from.
        radii: Radii = parse::radii,
        /// Whether hydrogens are read.
        hydrogens: bool = parse::switch,
        /// Whether water is read.
        waters: bool = parse::switch,
        /// Whether ligands are read.
        hetero: bool = parse::switch,
        /// Chains to read.
        chains: Vec<String> = parse::chains,
        /// Models to read.
        models: Models = parse::models,
    }
    Part {
        /// Level of a pyramid.
        level: u32 = parse::whole,
        /// Name of an array.
        array: String = parse::text,
        /// Number of a volume.
        frame: u64 = parse::whole,
        /// Series of a folder.
        series: String = parse::text,
        /// Whether damaged slices are skipped.
        skip_damaged: bool = parse::switch,
        /// Whether uneven slices are refused.
        no_resample: bool = parse::switch,
        /// What replaces NaN.
        nan: Nan = parse::nan,
        /// Part of the input.
        roi: Part = parse::part,
        /// Samples along each axis that become one.
        downsample: NonZeroUsize = parse::natural,
    }
    Raw {
        /// Sizes of a raw file.
        dims: Dims = parse::dims,
        /// Type of a sample.
        dtype: Dtype = parse::own,
        /// Byte order of a sample.
        endian: Endian = parse::own,
        /// Bytes before the samples.
        offset: u64 = parse::whole,
    }
    Labels {
        /// Labels whose solid the shape is.
        label: LabelChoice = parse::own,
        /// Value at whose isosurface the shape ends.
        surface: SurfaceChoice = parse::own,
    }
    Haar {
        /// Kind of decomposition.
        haar: Decomposition = parse::named,
        /// Root mean square error.
        rms: f64 = parse::not_negative,
        /// L² norm of the error.
        epsilon: f64 = parse::not_negative,
        /// Number of coefficients.
        coefficients: u64 = parse::whole,
    }
    Points {
        /// How samples are chosen.
        select: Select = parse::named,
        /// RMSE that is good enough.
        target_rmse: f64 = parse::not_negative,
        /// Largest error that is good enough.
        max_error: f64 = parse::not_negative,
        /// Whether points are exchanged.
        exchange: bool = parse::switch,
        /// Number of points.
        count: u64 = parse::count,
        /// Share of the samples.
        ratio: f64 = parse::share,
        /// Least gray difference.
        threshold: f64 = parse::not_nan,
        /// Least gray level.
        gray_min: f64 = parse::not_nan,
        /// Least value.
        value_min: f64 = parse::number,
    }
    Coordinates {
        /// Units of coordinates.
        units: Units = parse::named,
        /// Directions of world coordinates.
        space: Space = parse::named,
    }
    Refit {
        /// What values are fitted to.
        refit: Refit = parse::named,
    }
    Weights {
        /// The parameter, or how it is found.
        alpha: AlphaRule = parse::own,
        /// The parameter as a radius.
        alpha_radius: Alpha = parse::alpha_radius,
    }
    Frozen {
        /// The parameter at which weights are computed.
        alpha_ref: AlphaRule = parse::own,
    }
    Weighting {
        /// Where weights come from.
        weights: Weighting = parse::own,
    }
    Shape {
        /// How α and ω define balls.
        balls: Balls = parse::named,
        /// Which engine computes the shape.
        engine: Engine = parse::named,
        /// Number of blocks.
        blocks: NonZeroUsize = parse::natural,
        /// Bound on memory.
        memory: u64 = parse::bytes,
        /// Whether exterior simplices are kept.
        exterior: bool = parse::switch,
        /// Whether hidden points are listed.
        hidden: bool = parse::switch,
    }
    Periodic {
        /// The periodic box.
        periodic: PeriodicBox = parse::periodic,
    }
    Keep {
        /// How many of the largest components are kept.
        keep: Largest = parse::own,
        /// The least volume of components that are kept.
        min_volume: f64 = parse::positive,
    }
}

impl Settings {
    /// Returns a preset by its name.
    ///
    /// # Panics
    /// Never: presets are settings.
    pub fn preset(name: &str) -> Option<Self> {
        let (_, text) = PRESETS.iter().find(|(known, _)| *known == name)?;
        Some(toml::from_str(text).expect("presets are settings"))
    }

    /// The names of the settings of a group.
    pub fn names(group: Group) -> impl Iterator<Item = &'static str> {
        Self::NAMES.iter().filter(move |(_, of)| *of == group).map(|(name, _)| *name)
    }

    /// The names of the settings that this one excludes, and that exclude it.
    pub fn excluded_by(name: &str) -> impl Iterator<Item = &'static str> {
        let sets = EXCLUSIVE.iter().filter(move |names| names.contains(&name));
        let of_sets = sets.copied().flatten().copied().filter(move |other| *other != name);
        // Each of the others excludes the surface, and the surface all of them.
        let of_surface = Self::NAMES.iter().filter(move |(known, group)| {
            is_not_of_surface(known, *group) && (name == SURFACE || name == *known)
        });
        let of_surface =
            of_surface.map(move |(known, _)| if name == SURFACE { *known } else { SURFACE });
        of_sets.chain(of_surface)
    }

    /// The given settings that this one excludes. A switch that is off does not exclude others, nor is it excluded.
    fn rivals(&self, name: &str, text: &str) -> Vec<&'static str> {
        const OFF: &str = "false";
        let is_given =
            |other: &&str| self.iter().any(|(known, value)| known == *other && value != OFF);
        if text == OFF { Vec::new() } else { Self::excluded_by(name).filter(is_given).collect() }
    }

    /// The named values of a setting, if it has such values, each with its help.
    pub fn choices(name: &str) -> Option<Vec<[&'static str; 2]>> {
        choices::of(name)
    }

    /// Sets a setting, given as text. Settings that exclude it are unset.
    ///
    /// # Errors
    /// No setting has the name, or the text cannot be parsed.
    pub fn set(&mut self, name: &str, text: &str) -> Result<(), SettingError> {
        let name = name.replace('-', "_");
        let Some(&(name, _)) = Self::NAMES.iter().find(|(known, _)| *known == name) else {
            return Err(SettingError::new(
                format!("no option has the name {name}"),
                "see the help of the command",
            ));
        };
        self.store(name, text)?;
        self.rivals(name, text).into_iter().for_each(|other| self.forget(other));
        self.written.retain(|(known, _)| *known != name);
        self.written.push((name, text.to_owned()));
        Ok(())
    }

    /// Unsets a setting, which then has its default.
    pub fn unset(&mut self, name: &str) {
        self.forget(&name.replace('-', "_"));
    }

    /// Returns these settings, completed by those of `others` that they leave open.
    ///
    /// # Panics
    /// Never: text that was parsed once can be parsed again.
    #[must_use]
    pub fn over(&self, others: &Self) -> Self {
        let mut all = others.clone();
        for (name, text) in &self.written {
            all.set(name, text).expect("it was parsed before");
        }
        all
    }

    /// The given settings, each with its text.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.written.iter().map(|(name, text)| (*name, text.as_str()))
    }

    /// Whether a setting was given.
    pub fn has(&self, name: &str) -> bool {
        self.written.iter().any(|(known, _)| *known == name)
    }

    /// The given settings as arguments of the command.
    pub fn arguments(&self) -> Vec<String> {
        let argument = |(name, text): &(&str, String)| {
            let name = name.replace('_', "-");
            if text == "true" { format!("--{name}") } else { format!("--{name}={text}") }
        };
        self.written.iter().filter(|(_, text)| text != "false").map(argument).collect()
    }

    /// The given settings as TOML, one in each line.
    pub fn to_toml(&self) -> String {
        let value = |text: &str| match text.parse::<f64>() {
            Ok(number) if number.is_finite() => text.to_owned(),
            _ if ["true", "false"].contains(&text) => text.to_owned(),
            // JSON's escapes are among TOML's.
            _ => Value::from(text).to_string(),
        };
        self.iter()
            .map(|(name, text)| format!("{} = {}\n", name.replace('_', "-"), value(text)))
            .collect()
    }

    /// The options for reading a volume.
    pub fn reading(&self) -> ReadOptions {
        ReadOptions::default()
            .raw(self.layout())
            .format(self.input_format.clone())
            .level(self.level)
            .array(self.array.clone())
            .frame(self.frame)
            .series(self.series.clone())
            .skip_damaged(self.skip_damaged == Some(true))
            .no_resample(self.no_resample == Some(true))
            .nan(self.nan)
            .region(self.roi.map(|part| part.samples))
            .downsample(self.downsample)
    }

    /// The layout of the samples, if the file is raw.
    fn layout(&self) -> Option<RawLayout> {
        let layout =
            |(dims, dtype)| RawLayout::new(dims, dtype).endian(self.endian.unwrap_or_default());
        self.dims.zip(self.dtype).map(|of| layout(of).offset(self.offset.unwrap_or_default()))
    }

    /// The options for the transform of a volume.
    pub fn transform(&self) -> HaarOptions {
        let tolerance = match (self.epsilon, self.coefficients, self.rms) {
            (Some(epsilon), ..) => Tolerance::Epsilon(epsilon),
            (_, Some(count), _) => Tolerance::Coefficients(count),
            (.., Some(rms)) => Tolerance::Rms(rms),
            _ => HaarOptions::default().tolerance,
        };
        let decomposition = self.haar.unwrap_or(HaarOptions::default().decomposition);
        HaarOptions::default().decomposition(decomposition).tolerance(tolerance)
    }

    /// The rule by which samples are selected.
    pub fn rule(&self) -> SelectionRule {
        match (self.count, self.threshold, self.ratio) {
            (Some(count), ..) => SelectionRule::Count(count),
            (_, Some(threshold), _) => SelectionRule::Threshold(threshold),
            (.., Some(ratio)) => SelectionRule::Ratio(ratio),
            _ => SelectionRule::default(),
        }
    }

    /// Which atoms of a molecule are read.
    pub fn atoms(&self) -> AtomSelection {
        AtomSelection::default()
            .hydrogens(self.hydrogens == Some(true))
            .waters(self.waters == Some(true))
            .hetero(self.hetero == Some(true))
            .chains(self.chains.clone())
            .models(self.models)
    }

    /// The value of α, or the rule that finds it.
    pub fn parameter(&self) -> AlphaRule {
        let given = self.alpha_radius.map(AlphaRule::Given);
        given.or(self.alpha).or(self.alpha_ref).unwrap_or_default()
    }

    fn choice(&self) -> Result<Choice, SettingError> {
        let exchange = self.exchange == Some(true);
        if self.select != Some(Select::Adaptive) {
            let belongs = |what: &[Setting], next: Advice| {
                let names = listed(what);
                Err(SettingError::new(
                    names.and(advice![
                        if what.len() == 1 { " belongs" } else { " belong" },
                        " to ",
                        Setting::Select,
                        " adaptive"
                    ]),
                    next,
                ))
            };
            if self.target_rmse.is_some() {
                return belongs(&[Setting::TargetRmse], advice!["add it, or use ", Setting::Count]);
            }
            if self.max_error.is_some() || exchange {
                return belongs(&[Setting::MaxError, Setting::Exchange], advice!["add it"]);
            }
            return Ok(Choice::Difference(
                Selection::default().rule(self.rule()).gray_min(self.gray_min),
            ));
        }
        if self.threshold.is_some() || self.gray_min.or(self.value_min).is_some() {
            let why =
                listed(&[Setting::Threshold, Setting::GrayMin, Setting::ValueMin]).and(advice![
                    " choose by gray levels, which ",
                    Setting::Select,
                    " adaptive does not"
                ]);
            let next =
                advice!["use ", Setting::Count, ", ", Setting::Ratio, " or ", Setting::TargetRmse];
            return Err(SettingError::new(why, next));
        }
        let goal = Goal {
            count: self.count,
            ratio: self.ratio,
            rmse: self.target_rmse,
            max_error: self.max_error,
        };
        Ok(if exchange { Choice::Exchanged(goal) } else { Choice::Adaptive(goal) })
    }

    /// The recipe for a CT, the values of whose volume are Hounsfield units, where these settings do not say which samples to select: it selects bone, as
    /// [`CT_BONE`] does. `None` where they do.
    ///
    /// # Panics
    /// Never: presets are settings.
    pub fn for_ct(&self, recipe: &Recipe) -> Option<Recipe> {
        let selects =
            |name: &str| name == "gray" || Self::names(Group::Points).any(|known| known == name);
        if self.iter().any(|(name, _)| selects(name)) {
            return None;
        }
        let bone = Self::preset(CT_BONE).expect("a preset").recipe();
        let bone = bone.expect("presets do not contradict themselves");
        let haar = if recipe.haar == HaarOptions::default() { bone.haar } else { recipe.haar };
        Some(recipe.clone().gray(bone.gray).choice(bone.choice).haar(haar))
    }

    /// Creates the recipe with these settings.
    ///
    /// # Errors
    /// Settings contradict each other.
    pub fn recipe(&self) -> Result<Recipe, SettingError> {
        let is_set = |switch: Option<bool>| switch == Some(true);
        let recipe = Recipe::new()
            .read(self.reading())
            .columns(self.columns.clone())
            .classes(self.class.clone())
            .withheld(is_set(self.withheld))
            .value(self.value.clone())
            .region(self.roi.map(|part| part.places))
            .thin(self.thin)
            .radii(self.radii.clone())
            .atoms(self.atoms())
            .labels(self.label.clone())
            .surface(self.surface)
            .gray(self.gray)
            .gray_out(is_set(self.gray_out))
            .units(self.units)
            .space(self.space)
            .haar(self.transform())
            .choice(self.choice()?)
            .value_min(self.value_min)
            .refit(self.refit)
            .weighting(self.weights)
            .alpha(self.parameter())
            .balls(self.balls.unwrap_or_default())
            .engine(self.engine.unwrap_or_default())
            .exterior(is_set(self.exterior))
            .hidden(is_set(self.hidden))
            .blocks(self.blocks)
            .memory(self.memory)
            .periodic(self.periodic)
            .keep(Keep::default().largest(self.keep).min_volume(self.min_volume));
        if !recipe.keep.is_all() && recipe.exterior {
            return Err(SettingError::new(
                advice![
                    Setting::Exterior,
                    " has no effect: simplices outside the shape belong to no component that could be kept"
                ],
                advice!["omit it, or omit ", Setting::Keep, " and ", Setting::MinVolume],
            ));
        }
        if !recipe.keep.is_all() && recipe.periodic.is_some() {
            return Err(SettingError::new(
                listed(&[Setting::Keep, Setting::MinVolume])
                    .and(advice![" are for shapes in space, and a periodic box is a torus"]),
                advice!["omit them, or omit ", Setting::Periodic],
            ));
        }
        if recipe.engine == Engine::Cgal && recipe.blocks.is_some_and(|blocks| blocks.get() > 1) {
            return Err(SettingError::new(
                advice![Setting::Blocks, " has no effect: the engine cgal does not work in blocks"],
                advice!["omit it, or take ", Setting::Engine, " native"],
            ));
        }
        let needs_radii = recipe.weighting.is_none_or(|kind| kind == Weighting::Column);
        if !needs_radii && recipe.radii.as_ref().is_some_and(|radii| *radii != Radii::None) {
            return Err(SettingError::new(
                advice![Setting::Radii, " has no effect: weights come from elsewhere"],
                advice!["omit it, or take column as weights"],
            ));
        }
        recipe.check().map_err(|error| SettingError::of(&error))?;
        if recipe.refit == Some(Refit::Whole) && recipe.memory.is_some() {
            return Err(SettingError::new(
                advice![
                    Setting::Memory,
                    " has no effect: ",
                    Setting::Refit,
                    " fits values on the whole triangulation"
                ],
                advice!["omit it, or give ", Setting::Refit, "=shape"],
            ));
        }
        Ok(recipe)
    }
}

/// Lists the names of settings.
fn listed(settings: &[Setting]) -> Advice {
    let mut parts = Vec::new();
    for (k, setting) in settings.iter().enumerate() {
        if k > 0 {
            parts.push(if k + 1 == settings.len() { " and " } else { ", " }.into());
        }
        parts.push((*setting).into());
    }
    Advice::new(parts)
}

/// Reads settings by their names with hyphens. Values are text, numbers, `true`, or lists of these. Settings that exclude each
/// other are an error.
impl<'de> Deserialize<'de> for Settings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut settings = Self::default();
        for (name, value) in Map::deserialize(deserializer)? {
            let text = match &value {
                Value::Null => continue,
                Value::Array(items) => items.iter().map(plain_text).collect::<Vec<_>>().join(","),
                value => plain_text(value),
            };
            if let Some(other) = settings.rivals(&name.replace('-', "_"), &text).first() {
                let other = other.replace('_', "-");
                return Err(D::Error::custom(format_args!(
                    "{name} and {other} exclude each other"
                )));
            }
            settings
                .set(&name, &text)
                .map_err(|error| D::Error::custom(format_args!("{name} = {value}: {error}")))?;
        }
        Ok(settings)
    }
}

fn plain_text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

impl Serialize for Settings {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer
            .collect_map(self.written.iter().map(|(name, text)| (name.replace('_', "-"), text)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(given: &[(&str, &str)]) -> Settings {
        let mut settings = Settings::default();
        for (name, text) in given {
            settings.set(name, text).unwrap();
        }
        settings
    }

    #[test]
    fn presets_are_recipes() {
        for (name, _) in PRESETS {
            assert!(Settings::preset(name).unwrap().recipe().is_ok(), "{name}");
        }
        let paper = Recipe::paper();
        let share = SelectionRule::Ratio(15956.0 / 262_144.0);
        assert_eq!(paper.choice, Choice::Difference(Selection::default().rule(share)));
        assert_eq!((paper.weighting, paper.units), (Some(Weighting::MinMax), Some(Units::Voxel)));
        let bone = Settings::preset(CT_BONE).unwrap().recipe().unwrap();
        assert_eq!(bone.gray, Some(GrayRange { low: 0.0, high: 1000.0 }));
        let selection = Selection::default().rule(SelectionRule::Threshold(30.0));
        assert_eq!(bone.choice, Choice::Difference(selection.gray_min(Some(64.0))));
        assert_eq!(
            Settings::preset(LABELS).unwrap().recipe().unwrap().labels,
            Some(LabelChoice::All)
        );
        assert!(Settings::preset("no such").is_none());
    }

    /// A setting that is given later, or over another, replaces the settings that it excludes, and no others.
    #[test]
    fn one_of_those_that_exclude_each_other_is_kept() {
        let bone = Settings::preset(CT_BONE).unwrap();
        let mine = of(&[("ratio", "0.5"), ("value-min", "-10")]).over(&bone);
        let kept: Vec<_> = mine.iter().collect();
        assert_eq!(
            kept,
            [("gray", "0..1000"), ("rms", "4"), ("ratio", "0.5"), ("value_min", "-10")]
        );
        assert_eq!((mine.threshold(), mine.gray_min(), mine.ratio()), (None, None, Some(&0.5)));
        assert_eq!(
            mine.arguments(),
            ["--gray=0..1000", "--rms=4", "--ratio=0.5", "--value-min=-10"]
        );
    }

    #[test]
    fn files_and_pages_have_the_same_settings() {
        let given = of(&[
            ("gray", "-1..2.5"),
            ("nan", "mask"),
            ("count", "12"),
            ("exterior", "true"),
            ("alpha", "auto:connected"),
            ("class", "ground,7"),
            ("columns", "x,y,\"z"),
            ("hidden", "false"),
        ]);
        let entries = |settings: &Settings| -> Vec<(&str, String)> {
            settings.iter().map(|(name, text)| (name, text.to_owned())).collect()
        };
        let (toml, json) = (given.to_toml(), serde_json::to_string(&given).unwrap());
        let mut of_toml: Settings = toml::from_str(&toml).unwrap();
        let of_json: Settings = serde_json::from_str(&json).unwrap();
        assert_eq!(entries(&of_json), entries(&given));
        // TOML's tables may be in another order.
        of_toml.written.sort_by_key(|(name, _)| given.iter().position(|(known, _)| known == *name));
        assert_eq!(entries(&of_toml), entries(&given), "{toml}");
        assert_eq!(of_toml.recipe().unwrap(), given.recipe().unwrap());
        let lists: Settings =
            serde_json::from_str(r#"{"class": [2, 9], "gray-min": 3.5, "alpha": null}"#).unwrap();
        assert_eq!(
            (lists.class(), lists.gray_min(), lists.alpha()),
            (Some(&vec![2, 9]), Some(&3.5), None)
        );
    }

    #[test]
    fn what_cannot_be_is_an_error() {
        for text in [r#"{"no-such": 1}"#, r#"{"count": "many"}"#, r#"{"ratio": 2}"#] {
            assert!(serde_json::from_str::<Settings>(text).is_err(), "{text}");
        }
        let both = serde_json::from_str::<Settings>(r#"{"count": 3, "gray-min": 4, "ratio": 0.5}"#);
        let both = both.unwrap_err().to_string();
        assert!(both.contains("ratio and count exclude each other"), "{both}");
        let off = r#"{"select": "adaptive", "max-error": 3, "exchange": false}"#;
        let off: Settings = serde_json::from_str(off).unwrap();
        assert_eq!((off.max_error(), off.exchange()), (Some(&3.0), Some(&false)));
        let refused = |given: &[(&str, &str)]| of(given).recipe().unwrap_err();
        let error = refused(&[("max_error", "3")]);
        assert_eq!(error.to_string(), "`max_error` and `exchange` belong to `select` adaptive");
        let error = refused(&[("select", "adaptive"), ("threshold", "3")]);
        assert!(
            error.to_string().starts_with("`threshold`, `gray_min` and `value_min` choose"),
            "{error}"
        );
        let error = refused(&[("engine", "cgal"), ("blocks", "2")]);
        assert!(error.advice().unwrap().to_string().contains("take `engine` native"), "{error}");
        refused(&[("refit", "whole"), ("memory", "1G")]);
        refused(&[("exterior", "true"), ("blocks", "3")]);
        let taken = of(&[
            ("select", "adaptive"),
            ("target_rmse", "3"),
            ("refit", "shape"),
            ("memory", "1G"),
        ]);
        assert!(taken.recipe().is_ok());
    }
}
