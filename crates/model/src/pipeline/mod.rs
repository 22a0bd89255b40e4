//! All stages in one call: a [`Recipe`] holds their options, and turns a volume or points into a shape. The crate's
//! first page has an example.

mod choice;
mod error;
mod input;
mod parameter;
mod recipe;
mod spacing;
mod weighed;

pub use choice::{Choice, Goal};
pub use error::PipelineError;
pub use input::{Grays, Input, Opened, Source, Values};
pub use parameter::{AlphaRule, Parameter, ParameterOrigin};
pub use recipe::Recipe;
#[doc(hidden)]
pub use recipe::paper;
pub use weighed::{Origin, Weighed};

use choice::Chosen;
use input::to_gray;
use walpha_base::Monitor;

use crate::interpolate::{Refit, refit_monitored};
use crate::labels::{self, LabelChoice, LabelSizes};
use crate::progress::Stage;
use walpha_points::haar::smooth_monitored;
use walpha_points::{ModelMetadata, Points, SampleGrid};
use walpha_shape::{AlphaShape, alpha_shape_monitored};
use walpha_volume::Volume;

/// A shape, and how it was made.
#[derive(Debug)]
#[non_exhaustive]
pub struct Model {
    /// The shape, with the axes and unit of its coordinates.
    pub shape: AlphaShape,
    /// The α of the shape.
    pub parameter: Parameter,
    /// Where its points come from.
    pub origin: Origin,
    /// The labels that it is the solid of, if it is of labels.
    pub labels: Option<LabelSizes>,
}

impl Recipe {
    /// The shape of a volume: that of its [labels](Recipe::labels), if the recipe names some; otherwise its values are mapped to
    /// gray levels first if needed.
    ///
    /// # Errors
    /// The errors of its stages.
    pub fn run(&self, volume: Volume) -> Result<Model, PipelineError> {
        self.run_monitored(volume, &Monitor::noop())
    }

    /// With a monitor, which receives the progress of each stage and can cancel the work.
    ///
    /// # Errors
    /// The errors of its stages, and [`PipelineError::Cancelled`].
    pub fn run_monitored(&self, volume: Volume, monitor: &Monitor) -> Result<Model, PipelineError> {
        if self.labels.is_some() {
            return self.solid(&volume, monitor);
        }
        let source = self.source(self.grays(volume)?)?;
        self.finish(self.weighed(&source, Values::Written, monitor)?, monitor)
    }

    /// The solid of the labels that the recipe names, of all but 0 if it names none: its cells fill their voxels
    /// ([`labels::solid`]).
    ///
    /// # Errors
    /// [`PipelineError::Labels`], and the errors of [`Recipe::place`].
    pub fn solid(&self, volume: &Volume, monitor: &Monitor) -> Result<Model, PipelineError> {
        let counts = labels::chosen(volume, self.labels.as_ref().unwrap_or(&LabelChoice::All))?;
        self.solid_of(volume, counts, monitor)
    }

    /// The solid of these labels, which have these numbers of voxels.
    #[doc(hidden)]
    pub fn solid_of(
        &self,
        volume: &Volume,
        counts: Vec<(i32, u64)>,
        monitor: &Monitor,
    ) -> Result<Model, PipelineError> {
        Stage::Shape.begin(monitor)?;
        let (frame, units) = self.place(*volume.frame())?;
        let chosen: Vec<i32> = counts.iter().map(|&(label, _)| label).collect();
        let shape = labels::solid(volume, &frame, units, &chosen, monitor)?;
        let sizes = LabelSizes::new(counts, &frame, units);
        let parameter = Parameter::of_labels(sizes.unit);
        let origin = Origin::of_labels(units.coordinates_of(&frame));
        Ok(Model { shape, parameter, origin, labels: Some(sizes) })
    }

    /// The shape of scattered points.
    ///
    /// # Errors
    /// The errors of its stages.
    pub fn run_points(&self, points: Points) -> Result<Model, PipelineError> {
        self.run_points_monitored(points, &Monitor::noop())
    }

    /// With a monitor, which receives the progress of each stage and can cancel the work.
    ///
    /// # Errors
    /// The errors of its stages, and [`PipelineError::Cancelled`].
    pub fn run_points_monitored(
        &self,
        points: Points,
        monitor: &Monitor,
    ) -> Result<Model, PipelineError> {
        let metadata = ModelMetadata::default();
        self.finish(self.weighed_points(points, &metadata, Values::Written, monitor)?, monitor)
    }

    /// The weighted points of an input, and the volume that they come from, if any. Each stage is reported to the
    /// monitor.
    ///
    /// # Errors
    /// The errors of its stages.
    pub fn weigh(
        &self,
        input: Input,
        values: Values,
        monitor: &Monitor,
    ) -> Result<(Weighed, Option<Source>), PipelineError> {
        match input {
            Input::Points(points, metadata) => {
                Ok((self.weighed_points(points, &metadata, values, monitor)?, None))
            }
            Input::Labels(_) => Err(PipelineError::OfLabels),
            Input::Volume(grays) => {
                let source = self.source(grays)?;
                Ok((self.weighed(&source, values, monitor)?, Some(source)))
            }
        }
    }

    /// The weighted points of a volume. Each stage is reported to the monitor.
    ///
    /// # Errors
    /// The errors of its stages.
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
        let chosen =
            choice.points(volume, &smoothed, units, monitor).map_err(|error| match error {
                PipelineError::Points(error) => self.in_its_terms(error, range).into(),
                other => other,
            })?;
        let Chosen { points, importance, ended } = chosen;
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
        let mut weighed =
            Weighed::new(points, origin, self.alpha, parameter, monitor)?.ordered(importance);
        weighed.recipe = Some(self.to_json());
        if let Some(to) = self.refit {
            self.fit(&mut weighed, source, to, monitor)?;
        }
        if let (Values::Written, Some(values)) = (values, weighed.points.values_mut()) {
            values.iter_mut().for_each(|value| *value = written.value(*value));
        }
        Ok(weighed)
    }

    /// The weighted points of a file with this metadata. The default α is the stored one, if any. Each stage is
    /// reported to the monitor.
    ///
    /// # Errors
    /// The errors of its stages.
    pub fn weighed_points(
        &self,
        mut points: Points,
        metadata: &ModelMetadata,
        values: Values,
        monitor: &Monitor,
    ) -> Result<Weighed, PipelineError> {
        if let (Values::Gray, Some(range)) = (values, &metadata.range) {
            to_gray(&mut points, range);
        }
        let origin = Origin {
            coordinates: metadata.coordinates,
            weighting: self.weighting_of(&points),
            truncation: None,
            grid: metadata.grid,
            range: metadata.range,
            ended: None,
            of_radii: points.of_radii,
            folded: None,
            fit: None,
        };
        if let (Some(cell), None) = (metadata.cell, self.periodic) {
            tracing::warn!(
                "the file states a cell in which points repeat, and it is not used: {cell}"
            );
        }
        let unit = origin.coordinates.unit;
        let stored = metadata.alpha.filter(|_| self.alpha == AlphaRule::Default);
        let stored = stored.map(|alpha| Parameter { alpha, unit, origin: ParameterOrigin::Stored });
        let parameter = stored.or_else(|| self.alpha.given(unit));
        let mut weighed = Weighed::new(points, origin, self.alpha, parameter, monitor)?;
        weighed.recipe = Some(metadata.recipe.clone().unwrap_or_else(|| self.to_json()));
        Ok(weighed)
    }

    /// The shape of weighted points. Each stage is reported to the monitor.
    ///
    /// # Errors
    /// The errors of its stages, and [`PipelineError::Radii`].
    pub fn finish(&self, mut weighed: Weighed, monitor: &Monitor) -> Result<Model, PipelineError> {
        weighed.on_torus(self.periodic)?;
        let parameter = weighed.find_parameter_on(self.periodic, monitor)?;
        let options = self.shape_of(parameter)?;
        Stage::Shape.begin(monitor)?;
        let Weighed { points, origin, .. } = weighed;
        let shape =
            alpha_shape_monitored(points, &options, monitor)?.with_coordinates(origin.coordinates);
        Ok(Model { shape, parameter, origin, labels: None })
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
        let points = std::mem::take(&mut weighed.points);
        weighed.points = points.with_values(fitted.values).expect("a value for each point");
        weighed.origin.fit = Some(fitted.fit);
        Ok(())
    }
}
