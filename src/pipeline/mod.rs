//! All stages in one call, from a volume or points to the shape. The crate's first page has an example.

mod choice;
mod error;
mod parameter;
mod weighed;

pub use choice::Choice;
pub use error::PipelineError;
pub use parameter::{AlphaRule, Parameter, ParameterOrigin};
pub use weighed::{Origin, Weighed};

use choice::Chosen;
use walpha_base::Monitor;

use crate::haar::{HaarOptions, smooth_monitored};
use crate::interpolate::{Refit, refit_monitored};
use crate::points::{ModelFacts, Points, SampleGrid, Units, Weighting};
use crate::progress::Stage;
use crate::shape::{Alpha, AlphaShape, Balls, ShapeOptions, alpha_shape_monitored};
use crate::volume::{GrayRange, Volume};

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
        self.finish(self.weighed(volume, &Monitor::silent())?, &Monitor::silent())
    }

    /// The shape of scattered points.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn run_points(&self, points: Points) -> Result<Model, PipelineError> {
        self.finish(self.weighed_points(points, &Monitor::silent())?, &Monitor::silent())
    }

    /// The weighted points of a volume of gray levels. The monitor hears of each stage.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn weighed(&self, volume: &Volume, monitor: &Monitor) -> Result<Weighed, PipelineError> {
        let parameter = self.alpha.of_volume(volume, self.units)?;
        Stage::Haar.begin(monitor)?;
        let (smoothed, truncation) = smooth_monitored(volume, &self.haar, monitor)?;
        Stage::Points.begin(monitor)?;
        let Chosen { points, importance, ended } =
            self.choice.points(volume, &smoothed, self.units, monitor)?;
        let (dims, frame, units) = (volume.dims(), *volume.frame(), self.units);
        let origin = Origin {
            coordinates: units.coordinates(volume),
            weighting: self.weighting_of(&points),
            truncation: Some(truncation),
            grid: Some(SampleGrid { dims, frame, units }),
            range: None,
            ended,
            of_radii: false,
            folded: None,
            fit: None,
        };
        let mut weighed = Weighed::new(points, origin, parameter, monitor)?.ordered(importance);
        if let Some(to) = self.refit {
            self.fit(&mut weighed, volume, to, monitor)?;
        }
        Ok(self.written(weighed))
    }

    /// Scattered points, weighted. The monitor hears of each stage.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn weighed_points(
        &self,
        points: Points,
        monitor: &Monitor,
    ) -> Result<Weighed, PipelineError> {
        self.weighed_model(points, &ModelFacts::default(), monitor)
    }

    /// The points of a file, with what it states about them: α by default is the one there. The monitor hears
    /// of each stage.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn weighed_model(
        &self,
        points: Points,
        facts: &ModelFacts,
        monitor: &Monitor,
    ) -> Result<Weighed, PipelineError> {
        let origin = Origin {
            coordinates: facts.coordinates,
            weighting: self.weighting_of(&points),
            truncation: None,
            grid: facts.grid,
            range: facts.range,
            ended: None,
            of_radii: points.of_radii,
            folded: None,
            fit: None,
        };
        if let (Some(cell), None) = (facts.cell, self.shape.periodic) {
            tracing::warn!(
                "the file states a cell in which points repeat, and it is not used: {cell}"
            );
        }
        let unit = origin.coordinates.unit;
        let stored = facts.alpha.filter(|_| self.alpha == AlphaRule::Default);
        let stored = stored.map(|alpha| Parameter { alpha, unit, origin: ParameterOrigin::Stored });
        let parameter = stored.or_else(|| self.alpha.given(unit));
        Ok(self.written(Weighed::new(points, origin, parameter, monitor)?))
    }

    /// The shape of weighted points. The monitor hears of each stage.
    ///
    /// # Errors
    /// Whatever the stage refuses, and [`PipelineError::Radii`].
    pub fn finish(&self, mut weighed: Weighed, monitor: &Monitor) -> Result<Model, PipelineError> {
        weighed.on_torus(self.shape.periodic)?;
        let parameter = weighed.find_on(self.shape.periodic, monitor)?;
        let options = self.options(parameter)?;
        Stage::Shape.begin(monitor)?;
        let Weighed { points, origin, .. } = weighed;
        let shape =
            alpha_shape_monitored(points, &options, monitor)?.with_coordinates(origin.coordinates);
        Ok(Model { shape, parameter, origin })
    }

    /// The options of the shape at an α.
    fn options(&self, parameter: Parameter) -> Result<ShapeOptions, PipelineError> {
        if self.shape.balls == Balls::Radius && parameter.is_found() {
            return Err(PipelineError::Radii { radius: parameter.alpha.squared().abs().sqrt() });
        }
        Ok(self.shape.alpha(parameter.alpha))
    }

    /// Fits the values of weighted points to their volume.
    fn fit(
        &self,
        weighed: &mut Weighed,
        volume: &Volume,
        to: Refit,
        monitor: &Monitor,
    ) -> Result<(), PipelineError> {
        let parameter = weighed.find_parameter(monitor)?;
        Stage::Refit.begin(monitor)?;
        let options = self.options(parameter)?;
        let shape = alpha_shape_monitored(weighed.points.clone(), &options, &monitor.unheard())?;
        let fitted = refit_monitored(&shape, volume, self.units, to, monitor)?;
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
}
