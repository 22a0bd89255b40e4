//! All stages in one call: a [`Recipe`] holds their options, and makes a shape of a volume or of points. The crate's
//! first page has an example.

mod choice;
mod error;
mod input;
mod parameter;
mod recipe;
mod weighed;

pub use choice::{Choice, Goal};
pub use error::PipelineError;
pub use input::{Grays, Input, Source, Values};
pub use parameter::{AlphaRule, Parameter, ParameterOrigin};
pub use recipe::Recipe;
pub use weighed::{Origin, Weighed};

use choice::Chosen;
use input::to_gray;
use walpha_base::Monitor;

use crate::haar::smooth_monitored;
use crate::interpolate::{Refit, refit_monitored};
use crate::points::{ModelMetadata, Points, SampleGrid};
use crate::progress::Stage;
use crate::shape::{AlphaShape, alpha_shape_monitored};
use crate::volume::Volume;

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

impl Recipe {
    /// The shape of a volume, which is turned into gray levels if it has others.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn run(&self, volume: Volume) -> Result<Model, PipelineError> {
        self.run_monitored(volume, &Monitor::noop())
    }

    /// With a monitor, which hears of each stage and can cancel it.
    ///
    /// # Errors
    /// Whatever a stage refuses, and [`PipelineError::Cancelled`].
    pub fn run_monitored(&self, volume: Volume, monitor: &Monitor) -> Result<Model, PipelineError> {
        let source = self.source(self.grays(volume)?)?;
        self.finish(self.weighed(&source, Values::Written, monitor)?, monitor)
    }

    /// The shape of scattered points.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn run_points(&self, points: Points) -> Result<Model, PipelineError> {
        self.run_points_monitored(points, &Monitor::noop())
    }

    /// With a monitor, which hears of each stage and can cancel it.
    ///
    /// # Errors
    /// Whatever a stage refuses, and [`PipelineError::Cancelled`].
    pub fn run_points_monitored(
        &self,
        points: Points,
        monitor: &Monitor,
    ) -> Result<Model, PipelineError> {
        let facts = ModelMetadata::default();
        self.finish(self.weighed_points(points, &facts, Values::Written, monitor)?, monitor)
    }

    /// The weighted points of an input, and the volume that they come from. The monitor hears of each stage.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn weigh(
        &self,
        input: Input,
        values: Values,
        monitor: &Monitor,
    ) -> Result<(Weighed, Option<Source>), PipelineError> {
        match input {
            Input::Points(points, facts) => {
                Ok((self.weighed_points(points, &facts, values, monitor)?, None))
            }
            Input::Volume(grays) => {
                let source = self.source(grays)?;
                Ok((self.weighed(&source, values, monitor)?, Some(source)))
            }
        }
    }

    /// The weighted points of a volume. The monitor hears of each stage.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn weighed(
        &self,
        source: &Source,
        values: Values,
        monitor: &Monitor,
    ) -> Result<Weighed, PipelineError> {
        let Source { volume, units, range, written } = source;
        let (dims, frame, units) = (volume.dims(), *volume.frame(), *units);
        let parameter = self.alpha.of_frame(&frame, units)?;
        Stage::Haar.begin(monitor)?;
        let (smoothed, truncation) = smooth_monitored(volume, &self.haar, monitor)?;
        Stage::Points.begin(monitor)?;
        let choice = self.choice.at_least(self.value_min.map(|value| range.gray(value)));
        let Chosen { points, importance, ended } =
            choice.points(volume, &smoothed, units, monitor)?;
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
        weighed.recipe = Some(self.to_json());
        if let Some(to) = self.refit {
            self.fit(&mut weighed, source, to, monitor)?;
        }
        if let (Values::Written, Some(values)) = (values, &mut weighed.points.values) {
            values.iter_mut().for_each(|value| *value = written.value(*value));
        }
        Ok(weighed)
    }

    /// The points of a file, weighted, with what it states about them: α by default is the one there. The monitor
    /// hears of each stage.
    ///
    /// # Errors
    /// Whatever a stage refuses.
    pub fn weighed_points(
        &self,
        mut points: Points,
        facts: &ModelMetadata,
        values: Values,
        monitor: &Monitor,
    ) -> Result<Weighed, PipelineError> {
        if let (Values::Gray, Some(range)) = (values, &facts.range) {
            to_gray(&mut points, range);
        }
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
        if let (Some(cell), None) = (facts.cell, self.periodic) {
            tracing::warn!(
                "the file states a cell in which points repeat, and it is not used: {cell}"
            );
        }
        let unit = origin.coordinates.unit;
        let stored = facts.alpha.filter(|_| self.alpha == AlphaRule::Default);
        let stored = stored.map(|alpha| Parameter { alpha, unit, origin: ParameterOrigin::Stored });
        let parameter = stored.or_else(|| self.alpha.given(unit));
        let mut weighed = Weighed::new(points, origin, parameter, monitor)?;
        weighed.recipe = Some(facts.recipe.clone().unwrap_or_else(|| self.to_json()));
        Ok(weighed)
    }

    /// The shape of weighted points. The monitor hears of each stage.
    ///
    /// # Errors
    /// Whatever the stage refuses, and [`PipelineError::Radii`].
    pub fn finish(&self, mut weighed: Weighed, monitor: &Monitor) -> Result<Model, PipelineError> {
        weighed.on_torus(self.periodic)?;
        let parameter = weighed.find_on(self.periodic, monitor)?;
        let options = self.shape_of(parameter)?;
        Stage::Shape.begin(monitor)?;
        let Weighed { points, origin, .. } = weighed;
        let shape =
            alpha_shape_monitored(points, &options, monitor)?.with_coordinates(origin.coordinates);
        Ok(Model { shape, parameter, origin })
    }

    /// Fits the values of weighted points to their volume.
    fn fit(
        &self,
        weighed: &mut Weighed,
        source: &Source,
        to: Refit,
        monitor: &Monitor,
    ) -> Result<(), PipelineError> {
        let parameter = weighed.find_parameter(monitor)?;
        Stage::Refit.begin(monitor)?;
        let options = self.shape_of(parameter)?;
        let shape = alpha_shape_monitored(weighed.points.clone(), &options, &monitor.unreported())?;
        let fitted = refit_monitored(&shape, &source.volume, source.units, to, monitor)?;
        weighed.points.values = Some(fitted.values);
        weighed.origin.fit = Some(fitted.fit);
        Ok(())
    }
}
