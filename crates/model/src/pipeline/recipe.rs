use std::num::NonZeroUsize;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use walpha_base::advice::Setting;
use walpha_base::setters;

use super::{AlphaRule, Choice, Parameter, PeriodicBox, PipelineError, Weighed};
use crate::interpolate::Refit;
use crate::labels::LabelChoice;
use crate::settings::Settings;
use crate::surface::SurfaceChoice;
use walpha_points::haar::{HaarOptions, Tolerance};
use walpha_points::internal::LEAST_GRAY;
use walpha_points::{
    AtomSelection, Attributes, Columns, PointOptions, Points, PointsError, Radii, Region,
    Selection, Units, Weighting,
};
use walpha_shape::{Alpha, Balls, Classifier, Engine, Keep, ShapeError, ShapeOptions};
use walpha_volume::{Coordinates, Frame, Gray, GrayRange, LengthUnit, ReadOptions, Space};

/// The largest number of points for which [`Engine::Auto`] takes CGAL: about the paper's size, which takes CGAL a third of
/// a second.
const MOST_FOR_CGAL: usize = 20_000;

/// The numbers of the paper's experiment.
pub mod paper {
    /// The number of selected points.
    pub const POINTS: usize = 15956;
    /// The number of samples of its volume: 64³.
    pub const SAMPLES: usize = 262_144;
}

/// The options of all stages, from an input to its shape. The defaults are those of the paper, without weights.
///
/// Recipes can be serialised. The command builds one from its arguments, and a plan of blocks stores one.
///
/// ```
/// use walpha_model::Recipe;
/// use walpha_points::Weighting;
/// use walpha_shape::Alpha;
///
/// let recipe = Recipe::new().weighting(Weighting::MinMax).alpha(Alpha::from_squared(10.0)?);
/// let text = serde_json::to_string(&recipe)?;
/// assert_eq!(serde_json::from_str::<Recipe>(&text)?, recipe);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[must_use]
#[non_exhaustive]
#[expect(clippy::struct_excessive_bools, reason = "each is an option of its own")]
pub struct Recipe {
    /// The options for reading a volume.
    pub read: ReadOptions,
    /// The columns of a table of points; `None` takes them from its header or guesses them from its numbers.
    pub columns: Option<Columns>,
    /// The classes of points to read from LAS and LAZ ([`PointOptions::classes`]).
    pub classes: Option<Vec<u8>>,
    /// Whether withheld points of LAS and LAZ are read ([`PointOptions::withheld`]).
    pub withheld: bool,
    /// The column of points whose numbers are the values F ([`PointOptions::value`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<String>,
    /// The columns of points that are kept beside them ([`PointOptions::attributes`]). They are not stored with the other options.
    #[serde(skip)]
    pub attributes: Attributes,
    /// Reads only the points in this box ([`PointOptions::region`]); of a volume, [`ReadOptions::region`] is a part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub region: Option<Region>,
    /// Keeps the first point in each cube of this side ([`PointOptions::thin`]).
    pub thin: Option<f64>,
    /// Where the radii of atoms come from ([`PointOptions::radii`]); not looked up where weights come from elsewhere.
    pub radii: Option<Radii>,
    /// Which atoms of a molecule are read ([`PointOptions::atoms`]).
    pub atoms: AtomSelection,
    /// The labels whose [solid](Recipe::solid) is the shape; `None` selects points by gray levels. With labels, the rest of the
    /// recipe has no effect, except the options for reading a volume, its units and its space.
    pub labels: Option<LabelChoice>,
    /// The value at whose isosurface the [solid](Recipe::solid_inside) ends that the shape is; `None` selects points by gray levels. With it nothing
    /// else of the recipe has an effect, except how a volume is read, its units and its space.
    pub surface: Option<SurfaceChoice>,
    /// The values that become gray 0 and 255; `None` leaves unsigned bytes unchanged, and otherwise takes the
    /// smallest and largest value.
    pub gray: Option<GrayRange>,
    /// Whether points get gray levels and not the values of the input.
    pub gray_out: bool,
    /// The units of the coordinates; `None` is [`Units::World`] if the input states a unit of length, a spacing or an origin, and
    /// otherwise [`Units::Voxel`].
    pub units: Option<Units>,
    /// The directions of the world axes, if the input states the patient's orientation; `None` is [`Space::Lps`].
    pub space: Option<Space>,
    /// The options for the transform and truncation of the volume.
    pub haar: HaarOptions,
    /// The choice of samples that become points.
    pub choice: Choice,
    /// Leaves out samples below this value of the input; an alternative to [`Selection::gray_min`].
    pub value_min: Option<f64>,
    /// Fits the values of points to the volume by least squares; `None` keeps the values of its samples.
    pub refit: Option<Refit>,
    /// The source of weights; `None` is the column of the input, or 0 if it has none.
    pub weighting: Option<Weighting>,
    /// The value of α, or the rule that finds it.
    pub alpha: AlphaRule,
    /// How α and ω define the balls.
    pub balls: Balls,
    /// The engine that computes the shape.
    pub engine: Engine,
    /// Whether exterior simplices are listed, too ([`ShapeOptions::exterior`]).
    pub exterior: bool,
    /// Whether hidden points are listed ([`ShapeOptions::hidden`]).
    pub hidden: bool,
    /// The number of blocks that the points are cut into ([`ShapeOptions::blocks`]).
    pub blocks: Option<NonZeroUsize>,
    /// A bound on memory in bytes ([`ShapeOptions::memory`]).
    pub memory: Option<u64>,
    /// Whether points that span no volume are an error ([`ShapeOptions::refuse_flat`]).
    pub refuse_flat: bool,
    /// The periodic box, if there is one.
    pub periodic: Option<PeriodicBox>,
    /// Which components of the shape are kept.
    #[serde(skip_serializing_if = "Keep::is_all")]
    pub keep: Keep,
    /// The engine of another crate ([`ShapeOptions::classifier`]); in the crate `walpha`, this is CGAL. It is not stored with the
    /// other options.
    #[serde(skip)]
    pub classifier: Option<Classifier>,
}

impl Recipe {
    /// Creates a recipe with the defaults.
    pub fn new() -> Self {
        Self::default()
    }

    /// The paper's experiment on any volume: its share of the samples, lengths in voxels, weights by its equation 4.1, and α =
    /// 10, which is the default for voxels. The command calls this `--preset paper`, and `reproduce` starts from it.
    ///
    /// # Panics
    /// Never: it is a preset.
    pub fn paper() -> Self {
        let settings = Settings::preset("paper").expect("a preset");
        settings.recipe().expect("presets do not contradict themselves")
    }

    setters! {
        read: ReadOptions,
        columns: Option<Columns>,
        classes: Option<Vec<u8>>,
        withheld: bool,
        value: Option<String>,
        attributes: Attributes,
        region: Option<Region>,
        thin: Option<f64>,
        radii: Option<Radii>,
        atoms: AtomSelection,
        labels: Option<LabelChoice>,
        surface: Option<SurfaceChoice>,
        gray_out: bool,
        haar: HaarOptions,
        choice: Choice,
        value_min: Option<f64>,
        balls: Balls,
        engine: Engine,
        exterior: bool,
        hidden: bool,
        blocks: Option<NonZeroUsize>,
        memory: Option<u64>,
        refuse_flat: bool,
        periodic: Option<PeriodicBox>,
        keep: Keep,
        classifier: Option<Classifier>,
    }

    /// Converts the options that differ from the defaults to a JSON object, from which the recipe can be deserialised. A `.wvm`
    /// stores this.
    ///
    /// # Panics
    /// Never: all options can be serialised.
    pub fn to_json(&self) -> String {
        let object = |recipe: &Self| match serde_json::to_value(recipe) {
            Ok(Value::Object(object)) => object,
            other => unreachable!("options have names: {other:?}"),
        };
        let (mut options, default) = (object(self), object(&Self::default()));
        options.retain(|name, value| default.get(name) != Some(value));
        let mut options = Value::Object(options);
        drop_nulls(&mut options);
        options.to_string()
    }

    /// Sets `gray`: a range, or `None`.
    pub fn gray(self, gray: impl Into<Option<GrayRange>>) -> Self {
        Self { gray: gray.into(), ..self }
    }

    /// Sets `units`; `None` chooses them by the input.
    pub fn units(self, units: impl Into<Option<Units>>) -> Self {
        Self { units: units.into(), ..self }
    }

    /// Sets `space`; `None` is LPS.
    pub fn space(self, space: impl Into<Option<Space>>) -> Self {
        Self { space: space.into(), ..self }
    }

    /// Sets `refit`; `None` keeps the values of the samples.
    pub fn refit(self, to: impl Into<Option<Refit>>) -> Self {
        Self { refit: to.into(), ..self }
    }

    /// Sets `weighting`; `None` takes the weights of the input.
    pub fn weighting(self, weighting: impl Into<Option<Weighting>>) -> Self {
        Self { weighting: weighting.into(), ..self }
    }

    /// Sets `alpha`: a number, or a rule.
    pub fn alpha(self, alpha: impl Into<AlphaRule>) -> Self {
        Self { alpha: alpha.into(), ..self }
    }

    /// The options for reading points.
    #[doc(hidden)]
    pub fn of_points(&self) -> PointOptions {
        let needs_radii = self.weighting.is_none_or(|kind| kind == Weighting::Column);
        PointOptions::default()
            .radii(if needs_radii { self.radii.clone() } else { Some(Radii::None) })
            .atoms(self.atoms.clone())
            .columns(self.columns.clone())
            .level(self.read.level)
            .format(self.read.format.clone())
            .frame(self.read.frame)
            .classes(self.classes.clone())
            .withheld(self.withheld)
            .value(self.value.clone())
            .attributes(self.attributes.clone())
            .weights(self.weighting == Some(Weighting::Column))
            .region(self.region)
            .thin(self.thin)
    }

    /// The mapping of values to gray levels.
    pub(crate) fn gray_levels(&self) -> Gray {
        self.gray.map_or(Gray::Automatic, Gray::Range)
    }

    /// The values that gray levels represent in written files; `range` became 0..255.
    pub fn written(&self, range: GrayRange) -> GrayRange {
        if self.gray_out { GrayRange::IDENTITY } else { range }
    }

    /// Converts a grid to the coordinates that its points will have, and returns these with their units.
    ///
    /// # Errors
    /// [`PipelineError::SpaceOfVoxels`] and [`PipelineError::UnknownSpace`].
    pub fn place(&self, frame: Frame) -> Result<(Frame, Units), PipelineError> {
        let Coordinates { space, unit } = frame.coordinates;
        let stated = if unit == LengthUnit::Voxel { Units::Voxel } else { Units::World };
        let units = self.units.unwrap_or(stated);
        if units == Units::World && unit == LengthUnit::Voxel {
            tracing::warn!(
                "the volume states no spacing: lengths stay in voxels, each of side 1; a format with a spacing, as NRRD, states it"
            );
        }
        if self.space.is_some() && units == Units::Voxel {
            return Err(PipelineError::SpaceOfVoxels);
        }
        if self.space.is_some() && !space.is_known() {
            return Err(PipelineError::UnknownSpace);
        }
        let space = self.space.unwrap_or(Space::Lps);
        Ok((frame.to(Coordinates { space, unit }), units))
    }

    /// The selection by differences in a volume whose values `range` are gray 0..255; `None` if points are chosen adaptively.
    #[doc(hidden)]
    pub fn selection(&self, range: &GrayRange) -> Option<Selection> {
        match self.choice.at_least(self.value_min.map(|value| range.gray(value))) {
            Choice::Difference(selection) => Some(selection),
            Choice::Adaptive(_) | Choice::Exchanged(_) => None,
        }
    }

    /// Converts an error of selection to the terms of this recipe: of alternative settings, it names the given one. The values
    /// `range` of the volume are gray 0..255.
    #[doc(hidden)]
    pub fn in_its_terms(&self, error: PointsError, range: &GrayRange) -> PointsError {
        let gray_min = match self.choice {
            Choice::Difference(selection) => selection.gray_min,
            Choice::Adaptive(_) | Choice::Exchanged(_) => None,
        };
        let value_min = self.value_min.filter(|_| gray_min.is_none());
        match (error, value_min) {
            (PointsError::Masked { highest, .. }, Some(least)) => {
                PointsError::MaskedValues { least, highest: range.value(highest) }
            }
            (PointsError::Threshold { least, largest, mask: Some(_) }, Some(_)) => {
                PointsError::Threshold { least, largest, mask: Some(Setting::ValueMin) }
            }
            (PointsError::Number { what: LEAST_GRAY, need, .. }, Some(given)) => {
                PointsError::Number { what: "a least value of", given, need }
            }
            (PointsError::Flat { available, .. }, _) => {
                let tolerance = match self.haar.tolerance {
                    Tolerance::Epsilon(_) => Setting::Epsilon,
                    Tolerance::Coefficients(_) => Setting::Coefficients,
                    _ => Setting::Rms,
                };
                PointsError::Flat { available, tolerance }
            }
            (error, _) => error,
        }
    }

    /// The source of the weights of these points.
    pub(super) fn weighting_of(&self, points: &Points) -> Weighting {
        let of_input =
            if points.weights.is_some() { Weighting::Column } else { Weighting::Common(0.0) };
        self.weighting.unwrap_or(of_input)
    }

    /// The options of the shape at this α. A periodic box that the input states is not among them.
    pub fn shape_at(&self, alpha: Alpha) -> ShapeOptions {
        ShapeOptions::new(alpha)
            .balls(self.balls)
            .engine(self.engine)
            .exterior(self.exterior)
            .hidden(self.hidden)
            .blocks(self.blocks)
            .memory(self.memory)
            .refuse_flat(self.refuse_flat)
            .periodic(self.periodic.and_then(PeriodicBox::given))
            .classifier(self.classifier)
    }

    /// Checks in advance that the options of the shape are compatible, as far as α is known.
    ///
    /// # Errors
    /// See [`ShapeOptions::check`].
    pub fn check(&self) -> Result<(), ShapeError> {
        let alpha = match self.alpha {
            AlphaRule::Given(alpha) => alpha,
            // An α that is found will be finite.
            AlphaRule::Auto | AlphaRule::Connected | AlphaRule::Default => Alpha::ZERO,
        };
        self.shape_at(alpha).check()
    }

    /// The options of the shape of weighted points at an α that was given or found.
    pub(super) fn shape_of(
        &self,
        weighed: &Weighed,
        parameter: Parameter,
    ) -> Result<ShapeOptions, PipelineError> {
        if self.balls == Balls::Radius && parameter.is_found() {
            return Err(PipelineError::Radii { radius: parameter.alpha.squared().abs().sqrt() });
        }
        let options = self.shape_at(parameter.alpha).periodic(weighed.origin.torus);
        Ok(options.engine(self.engine_for(weighed)))
    }

    /// The engine that computes the shape of weighted points. [`Engine::Auto`] takes CGAL, if it is at hand, for what the paper
    /// computes, and native for everything else and for what only it can do: blocks, a limit on memory, periodic boxes.
    fn engine_for(&self, weighed: &Weighed) -> Engine {
        let needs_native = self.periodic.is_some()
            || self.memory.is_some()
            || self.blocks.is_some_and(|blocks| blocks.get() > 1);
        let is_of_paper = weighed.origin.grid.is_some() && weighed.points.len() <= MOST_FOR_CGAL;
        match self.engine {
            Engine::Auto if self.classifier.is_some() && is_of_paper && !needs_native => {
                Engine::Cgal
            }
            Engine::Auto => Engine::Native,
            asked => asked,
        }
    }
}

/// Drops null fields, which are absent by default.
fn drop_nulls(value: &mut Value) {
    if let Value::Object(fields) = value {
        fields.retain(|_, value| !value.is_null());
        fields.values_mut().for_each(drop_nulls);
    }
}

#[cfg(test)]
mod tests {
    use walpha_shape::Torus;

    use super::*;
    use crate::pipeline::{Goal, Values};
    use walpha_points::{Models, SelectionRule};

    /// This includes an infinite α, for which JSON has no number, and one that must be found.
    #[test]
    fn recipes_survive_json() {
        let base = Recipe::new()
            .columns(Some("x,y,other,z,value".parse().unwrap()))
            .gray(GrayRange { low: -1000.0, high: 0.1 })
            .units(Units::World)
            .space(Space::Ras)
            .value_min(Some(-0.3))
            .refit(Refit::Shape)
            .weighting(Weighting::Common(2.5))
            .radii(Some("a/b.txt".parse().unwrap()))
            .atoms(
                AtomSelection::default()
                    .chains(Some(vec!["A".into()]))
                    .models(Some(Models::One(2))),
            )
            .blocks(NonZeroUsize::new(3))
            .memory(Some(1 << 40))
            .periodic(Some(PeriodicBox::Given(Torus::new([1.0, 2.5, 0.7]).unwrap())));
        let goal = Goal { ratio: Some(0.1), max_error: Some(3.5), ..Goal::default() };
        let selection = Selection::default().rule(SelectionRule::Threshold(30.0)).gray_min(64.5);
        let alphas = ["auto", "auto:connected", "inf", "0.1", "-3"];
        for alpha in
            alphas.map(|text| text.parse().unwrap()).into_iter().chain([AlphaRule::Default])
        {
            for choice in
                [Choice::Difference(selection), Choice::Adaptive(goal), Choice::Exchanged(goal)]
            {
                let recipe = base.clone().alpha(alpha).choice(choice);
                for text in [serde_json::to_string(&recipe).unwrap(), recipe.to_json()] {
                    assert_eq!(serde_json::from_str::<Recipe>(&text).unwrap(), recipe, "{text}");
                }
            }
        }
        assert_eq!(serde_json::from_str::<Recipe>("{}").unwrap(), Recipe::new());
        assert_eq!(Recipe::new().to_json(), "{}");
        assert_eq!(Recipe::new().hidden(true).to_json(), r#"{"hidden":true}"#);
        let wrong = [r#"{"alfa": "1"}"#, r#"{"alpha": "nan"}"#, r#"{"periodic": [1, -1, 1]}"#];
        for text in wrong {
            assert!(serde_json::from_str::<Recipe>(text).is_err(), "{text}");
        }
    }

    #[test]
    fn cgal_computes_what_the_paper_does() {
        let classifier = Classifier(|_, _| unreachable!("no shape is made"));
        let recipe = Recipe::new().alpha(Alpha::ZERO).classifier(Some(classifier));
        let volume = walpha_volume::phantom(64).unwrap();
        let source = recipe.source(volume).unwrap();
        let weighed = |count: usize| {
            let rule = SelectionRule::Count(count as u64);
            let recipe = recipe.clone().choice(Choice::Difference(Selection::default().rule(rule)));
            recipe.weighed(&source, Values::Gray).unwrap()
        };
        let selected = weighed(MOST_FOR_CGAL);
        assert_eq!(recipe.engine_for(&selected), Engine::Cgal);
        assert_eq!(recipe.engine_for(&weighed(MOST_FOR_CGAL + 1)), Engine::Native);
        let mut scattered = selected.clone();
        scattered.origin.grid = None;
        assert_eq!(recipe.engine_for(&scattered), Engine::Native);
        let torus = PeriodicBox::Given(Torus::new([64.0; 3]).unwrap());
        for other in [
            recipe.clone().classifier(None),
            recipe.clone().blocks(NonZeroUsize::new(2)),
            recipe.clone().memory(1 << 30),
            recipe.clone().periodic(torus),
        ] {
            assert_eq!(other.engine_for(&selected), Engine::Native);
        }
        assert_eq!(recipe.clone().blocks(NonZeroUsize::new(1)).engine_for(&selected), Engine::Cgal);
        for engine in [Engine::Cgal, Engine::Native, Engine::Both] {
            assert_eq!(recipe.clone().engine(engine).engine_for(&scattered), engine);
        }
    }
}
