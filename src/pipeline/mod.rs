//! Floor 5: all stages in one call, from a volume or points to the shape. The crate's first page has an example.

mod error;
mod parameter;

pub use error::PipelineError;
pub use parameter::{AlphaRule, Parameter, ParameterOrigin};

use rayon::prelude::*;

use crate::haar::{HaarOptions, Truncation, smooth};
use crate::interpolate::{Adaptive, Fit, Refit, adaptive_voxels, exchange, refit};
use crate::points::{
    ModelFacts, Points, SampleGrid, Selection, Units, WeightedPoints, Weighting, difference,
    points_at, scattered_difference, select, weigh,
};
use crate::progress::{Share, Stage, within};
use crate::shape::{Alpha, AlphaShape, Balls, ShapeOptions, Torus, alpha_shape};
use crate::volume::{Coordinates, GrayRange, Volume};

/// Which samples of a volume become points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Choice {
    /// Those of the largest differences, as in the paper.
    Difference(Selection),
    /// Those where the interpolant of the ones before is worst.
    Adaptive(Adaptive),
    /// The same, and then those whose loss costs little exchanged for others
    /// ([`exchange`](crate::interpolate::exchange())).
    Exchanged(Adaptive),
}

impl Default for Choice {
    fn default() -> Self {
        Self::Difference(Selection::default())
    }
}

/// How a volume or points become a shape: the options of every stage. By default those of the paper, without weights.
#[derive(Clone, Debug)]
#[must_use]
pub struct Pipeline {
    haar: HaarOptions,
    choice: Choice,
    units: Units,
    values: Option<GrayRange>,
    weighting: Option<Weighting>,
    alpha: AlphaRule,
    shape: ShapeOptions,
    refit: Option<Refit>,
}

/// Weighted points, and how they came about.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Weighed {
    /// Their values are gray levels, where they come from a volume, or what [`Pipeline::values`] makes of
    /// these.
    pub points: WeightedPoints,
    /// How it all came about.
    pub origin: Origin,
    /// α; `None` where it is still to be found ([`Weighed::find_parameter`]), because weights do not need it.
    pub parameter: Option<Parameter>,
    /// The points by their indices, the most important first, where they were selected from a volume: the
    /// first so many are what a smaller count would have selected.
    pub order: Option<Vec<u32>>,
}

/// What is known of points besides themselves.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Origin {
    /// What their coordinates mean.
    pub coordinates: Coordinates,
    /// Where their weights come from.
    pub weighting: Weighting,
    /// What was dropped of the volume they come from.
    pub truncation: Option<Truncation>,
    /// The grid that they are samples of, where that is known.
    pub grid: Option<SampleGrid>,
    /// The values that were gray 0 and 255, where a file of points tells them.
    pub range: Option<GrayRange>,
    /// Adaptive selection ended before it had as many points as asked for.
    pub ended: Option<Adaptive>,
    /// How values were fitted to the volume; `None` where they are those of its samples.
    pub fit: Option<Fit>,
}

/// A shape, and how it came about.
#[derive(Debug)]
#[non_exhaustive]
pub struct Model {
    /// The shape; it knows what its coordinates mean.
    pub shape: AlphaShape,
    /// The α it is at.
    pub parameter: Parameter,
    /// How its points came about.
    pub origin: Origin,
}

impl Default for Pipeline {
    fn default() -> Self {
        Self {
            haar: HaarOptions::default(),
            choice: Choice::default(),
            units: Units::default(),
            values: None,
            weighting: None,
            alpha: AlphaRule::default(),
            // Its α is never looked at.
            shape: ShapeOptions::new(Alpha::INFINITE),
            refit: None,
        }
    }
}

impl Pipeline {
    /// The paper's options.
    pub fn new() -> Self {
        Self::default()
    }

    /// How the volume is transformed and truncated.
    pub fn haar(self, haar: HaarOptions) -> Self {
        Self { haar, ..self }
    }

    /// Which samples become points.
    pub fn choice(self, choice: Choice) -> Self {
        Self { choice, ..self }
    }

    /// The coordinates of points: sample indices, the default, or those of the world.
    pub fn units(self, units: Units) -> Self {
        Self { units, ..self }
    }

    /// Gives points the values of the file, of which gray levels 0 to 255 were this range.
    pub fn values(self, values: GrayRange) -> Self {
        Self { values: Some(values), ..self }
    }

    /// Where weights come from. By default a column of the input, or else they are 0.
    pub fn weighting(self, weighting: Weighting) -> Self {
        Self { weighting: Some(weighting), ..self }
    }

    /// α, or how to find it. By default 10 h² for a volume, h³ being the volume of a voxel, and
    /// [`AlphaRule::Auto`] for scattered points.
    pub fn alpha(self, alpha: impl Into<AlphaRule>) -> Self {
        Self { alpha: alpha.into(), ..self }
    }

    /// How the shape is computed; its α is not used.
    pub fn shape(self, shape: ShapeOptions) -> Self {
        Self { shape, ..self }
    }

    /// Fits the values of points to the volume by least squares. By default they are those of its
    /// samples.
    pub fn refit(self, to: Refit) -> Self {
        Self { refit: Some(to), ..self }
    }

    /// The shape of a volume of gray levels.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn run(&self, volume: &Volume) -> Result<Model, PipelineError> {
        self.finish(self.weighed(volume, &mut ignore)?, &mut ignore)
    }

    /// The shape of scattered points.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn run_points(&self, points: Points) -> Result<Model, PipelineError> {
        self.finish(self.weighed_points(points, &mut ignore)?, &mut ignore)
    }

    /// The weighted points of a volume of gray levels. `hear` is called with each stage as it begins.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn weighed(
        &self,
        volume: &Volume,
        hear: &mut dyn FnMut(Stage),
    ) -> Result<Weighed, PipelineError> {
        let parameter = self.alpha.of_volume(volume, self.units)?;
        hear(Stage::Haar);
        let (smoothed, truncation) = smooth(volume, &self.haar)?;
        hear(Stage::Points);
        let (points, order, ended) = self.points(volume, &smoothed)?;
        let (dims, frame, units) = (volume.dims(), *volume.frame(), self.units);
        let origin = Origin {
            coordinates: units.coordinates(volume),
            weighting: self.weighting_of(&points),
            truncation: Some(truncation),
            grid: Some(SampleGrid { dims, frame, units }),
            range: None,
            ended,
            fit: None,
        };
        let weighed = Self::weigh(points, origin, parameter, hear)?;
        let mut weighed = Weighed { order: Some(order), ..weighed };
        if let Some(to) = self.refit {
            self.fit(&mut weighed, volume, to, hear)?;
        }
        Ok(self.written(weighed))
    }

    /// Scattered points, weighted. `hear` is called with each stage as it begins.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn weighed_points(
        &self,
        points: Points,
        hear: &mut dyn FnMut(Stage),
    ) -> Result<Weighed, PipelineError> {
        self.weighed_model(points, &ModelFacts::default(), hear)
    }

    /// The points of a file, with what it tells of them: α by default is the one there. `hear` is called
    /// with each stage as it begins.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn weighed_model(
        &self,
        points: Points,
        facts: &ModelFacts,
        hear: &mut dyn FnMut(Stage),
    ) -> Result<Weighed, PipelineError> {
        let origin = Origin {
            coordinates: facts.coordinates,
            weighting: self.weighting_of(&points),
            truncation: None,
            grid: facts.grid,
            range: facts.range,
            ended: None,
            fit: None,
        };
        let unit = origin.coordinates.unit;
        let stored = facts.alpha.filter(|_| self.alpha == AlphaRule::Default);
        let stored = stored.map(|alpha| Parameter { alpha, unit, origin: ParameterOrigin::Stored });
        let parameter = stored.or_else(|| self.alpha.given(unit));
        Ok(self.written(Self::weigh(points, origin, parameter, hear)?))
    }

    /// The shape of weighted points. `hear` is called with each stage as it begins.
    ///
    /// # Errors
    /// Whatever the stage refuses, and [`PipelineError::Radii`].
    pub fn finish(
        &self,
        mut weighed: Weighed,
        hear: &mut dyn FnMut(Stage),
    ) -> Result<Model, PipelineError> {
        weighed.check_periodic(self.shape.periodic)?;
        let parameter = weighed.find_on(self.shape.periodic, hear)?;
        let options = self.options(parameter)?;
        hear(Stage::Shape);
        let Weighed { points, origin, .. } = weighed;
        let shape = alpha_shape(points, &options)?.meaning(origin.coordinates);
        Ok(Model { shape, parameter, origin })
    }

    /// The options of the shape at an α.
    fn options(&self, parameter: Parameter) -> Result<ShapeOptions, PipelineError> {
        if self.shape.balls == Balls::Radius && parameter.is_found() {
            return Err(PipelineError::Radii { radius: parameter.alpha.squared().abs().sqrt() });
        }
        Ok(ShapeOptions { alpha: parameter.alpha, ..self.shape })
    }

    /// Fits the values of weighted points to their volume.
    fn fit(
        &self,
        weighed: &mut Weighed,
        volume: &Volume,
        to: Refit,
        hear: &mut dyn FnMut(Stage),
    ) -> Result<(), PipelineError> {
        let parameter = weighed.find_parameter(hear)?;
        hear(Stage::Refit);
        let shape = within(Share::NONE, || {
            alpha_shape(weighed.points.clone(), &self.options(parameter)?)
                .map_err(PipelineError::from)
        })?;
        let fitted = refit(&shape, volume, self.units, to)?;
        weighed.points.values = Some(fitted.values);
        weighed.origin.fit = Some(fitted.fit);
        Ok(())
    }

    /// With values as they are written.
    fn written(&self, mut weighed: Weighed) -> Weighed {
        if let (Some(range), Some(values)) = (self.values, &mut weighed.points.values) {
            values.iter_mut().for_each(|value| *value = range.value(*value));
        }
        weighed
    }

    fn weighting_of(&self, points: &Points) -> Weighting {
        let column = points.weights.is_some();
        let silent = if column { Weighting::Column } else { Weighting::Common(0.0) };
        self.weighting.unwrap_or(silent)
    }

    /// The samples chosen, their order of importance, and what they were asked for where fewer do.
    fn points(
        &self,
        volume: &Volume,
        smoothed: &Volume,
    ) -> Result<(Points, Vec<u32>, Option<Adaptive>), PipelineError> {
        let differences = difference(smoothed);
        let goal = match self.choice {
            Choice::Difference(selection) => {
                let points = select(volume, smoothed, &differences, &selection, self.units)?;
                let by_difference = points.differences.as_deref().unwrap_or_default();
                let order = largest_first(by_difference);
                return Ok((points, order, None));
            }
            Choice::Adaptive(goal) | Choice::Exchanged(goal) => goal,
        };
        let mut voxels = adaptive_voxels(volume, &goal, self.units)?;
        if matches!(self.choice, Choice::Exchanged(_)) {
            voxels = exchange(volume, &voxels, self.units)?;
        }
        // Points are in the order of their voxels; the order of importance is kept beside them.
        let chosen = voxels.clone();
        voxels.sort_unstable();
        let place = |voxel: &u32| voxels.binary_search(voxel).expect("the same voxels") as u32;
        let order = chosen.iter().map(place).collect();
        // With a target alone as many as there are samples may be needed, and none is asked for.
        let asked = goal.count < volume.dims().samples() as u64;
        let fewer = asked && (voxels.len() as u64) < goal.count;
        let points = points_at(volume, &differences, &voxels, self.units);
        Ok((points, order, fewer.then_some(goal)))
    }

    /// Gives points their weights, and finds α first where these are in proportion to it.
    fn weigh(
        mut points: Points,
        origin: Origin,
        mut parameter: Option<Parameter>,
        hear: &mut dyn FnMut(Stage),
    ) -> Result<Weighed, PipelineError> {
        hear(Stage::Points);
        let Origin { weighting, coordinates, .. } = origin;
        let scattered = points.differences.is_none() && points.values.is_some();
        if scattered && weighting.needs_differences() {
            points.differences = Some(scattered_difference(&points)?);
        }
        if parameter.is_none() && weighting.needs_differences() {
            // Weights are checked before the search.
            weigh(&points, weighting, Alpha::from_squared(0.0)?)?;
            hear(Stage::Alpha);
            parameter = Some(Parameter::find_unweighted(&points, coordinates.unit)?);
            hear(Stage::Points);
        }
        // Weights that do not depend on α are the same at ∞.
        let alpha = parameter.map_or(Alpha::INFINITE, |parameter| parameter.alpha);
        let points = weigh(&points, weighting, alpha)?;
        Ok(Weighed { points, origin, parameter, order: None })
    }
}

impl Weighed {
    /// α, found now if weights did not need it.
    ///
    /// # Errors
    /// What a [`Filtration`](crate::ladder::Filtration) refuses.
    pub fn find_parameter(
        &mut self,
        hear: &mut dyn FnMut(Stage),
    ) -> Result<Parameter, PipelineError> {
        self.find_on(None, hear)
    }

    /// The same of a torus, if there is one.
    fn find_on(
        &mut self,
        torus: Option<Torus>,
        hear: &mut dyn FnMut(Stage),
    ) -> Result<Parameter, PipelineError> {
        if let Some(parameter) = self.parameter {
            return Ok(parameter);
        }
        hear(Stage::Alpha);
        let found = Parameter::find(&self.points, torus, self.origin.coordinates.unit)?;
        self.parameter = Some(found);
        Ok(found)
    }

    /// Whether the points may be those of a torus: weights of scattered points that come from differences
    /// to neighbours know nothing of the copies beyond the sides of the box.
    ///
    /// # Errors
    /// [`PipelineError::PeriodicWeights`].
    pub fn check_periodic(&self, torus: Option<Torus>) -> Result<(), PipelineError> {
        let Origin { weighting, truncation, .. } = self.origin;
        let scattered = truncation.is_none() && weighting.needs_differences();
        if torus.is_some() && scattered { Err(PipelineError::PeriodicWeights) } else { Ok(()) }
    }
}

/// The indices of numbers, the largest first, ties by the index.
fn largest_first(numbers: &[f64]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..numbers.len() as u32).collect();
    let number = |index: u32| numbers[index as usize];
    order.par_sort_unstable_by(|&a, &b| number(b).total_cmp(&number(a)).then(a.cmp(&b)));
    order
}

/// Hears which stage begins, and does nothing.
fn ignore(_: Stage) {}
