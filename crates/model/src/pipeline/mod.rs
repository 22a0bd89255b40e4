//! All stages in one call: a [`Recipe`] contains their options, and turns a volume or points into a shape. The crate's first page
//! has an example. Each stage is reported to the [`Monitor`] that watches.

mod choice;
mod error;
mod groups;
mod input;
mod level;
mod parameter;
mod periodic;
mod recipe;
mod spacing;
mod weighed;

pub use choice::{Choice, Goal};
pub use error::PipelineError;
pub use groups::{GroupShape, Groups, GroupsError};
pub use input::{Input, Opened, PlacedVolume, Values};
pub use parameter::{AlphaRule, Parameter, ParameterOrigin};
pub use periodic::PeriodicBox;
pub(crate) use periodic::directions;
pub use recipe::Recipe;
#[doc(hidden)]
pub use recipe::paper;
pub use weighed::{Origin, Weighed};

use choice::Chosen;
use input::to_gray;
use walpha_base::shown::rounded;
use walpha_base::{LengthUnit, Monitor};
use walpha_complex::schema::BoxVectors;

use crate::interpolate::{Refit, refit};
use crate::labels::{self, LabelChoice, LabelSizes};
use crate::progress::Stage;
use crate::surface::{self, Isovalue, SurfaceChoice};
use walpha_points::haar::smooth;
use walpha_points::{ModelMetadata, Points, SampleGrid};
use walpha_shape::{Alpha, AlphaShape, Balls, Engine, Kept, NO_COMPONENT, alpha_shape};
use walpha_volume::Volume;

/// A shape, with a record of how it was made.
#[derive(Debug)]
#[non_exhaustive]
pub struct Model {
    /// The shape, with the axes and unit of its coordinates.
    pub shape: AlphaShape,
    /// The α of the shape.
    pub parameter: Parameter,
    /// The origin of its points.
    pub origin: Origin,
    /// The labels whose solid the shape is, if it is a solid of labels.
    pub labels: Option<LabelSizes>,
    /// The value at whose isosurface it ends, if it is the solid inside one.
    pub isovalue: Option<Isovalue>,
}

impl Recipe {
    /// Computes the shape of a volume: the solid of its [labels](Recipe::labels), if the recipe names some, or the solid inside an
    /// [isosurface](Recipe::surface); otherwise its values are first mapped to gray levels if needed.
    ///
    /// # Errors
    /// The errors of its stages, and [`PipelineError::Cancelled`].
    pub fn run(&self, volume: Volume) -> Result<Model, PipelineError> {
        if self.labels.is_some() {
            return self.solid(&volume);
        }
        if let Some(surface) = self.surface {
            return self.solid_inside(&volume, surface);
        }
        let source = self.source(volume)?;
        self.finish(self.weighed(&source, Values::Written)?)
    }

    /// Computes the solid of the labels that the recipe names, or of all labels but 0 if it names none. Its cells fill the voxels
    /// of these labels ([`labels::solid`]).
    ///
    /// # Errors
    /// [`PipelineError::Labels`], and the errors of [`Recipe::place`].
    pub fn solid(&self, volume: &Volume) -> Result<Model, PipelineError> {
        let counts = labels::chosen(volume, self.labels.as_ref().unwrap_or(&LabelChoice::All))?;
        self.solid_of(volume, counts)
    }

    /// Computes the solid of these labels, which have these numbers of voxels.
    #[doc(hidden)]
    pub fn solid_of(
        &self,
        volume: &Volume,
        counts: Vec<(i32, u64)>,
    ) -> Result<Model, PipelineError> {
        Stage::Shape.begin()?;
        let (frame, units) = self.place(*volume.frame())?;
        let chosen: Vec<i32> = counts.iter().map(|&(label, _)| label).collect();
        let shape = labels::solid(volume, &frame, units, &chosen)?;
        let sizes = LabelSizes::new(counts, &frame, units);
        let parameter = Parameter::of_labels(sizes.unit);
        let origin = Origin::without_alpha(units.coordinates_of(&frame));
        let shape = self.kept(shape, parameter.unit)?;
        Ok(Model { shape, parameter, origin, labels: Some(sizes), isovalue: None })
    }

    /// Computes the solid inside an isosurface of a volume ([`surface::solid`]).
    ///
    /// # Errors
    /// [`PipelineError::Shape`], [`PipelineError::Constant`], and the errors of [`Recipe::place`].
    pub fn solid_inside(
        &self,
        volume: &Volume,
        surface: SurfaceChoice,
    ) -> Result<Model, PipelineError> {
        Stage::Shape.begin()?;
        let (frame, units) = self.place(*volume.frame())?;
        let isovalue = Isovalue::of(surface, volume);
        let (low, high) = volume.value_range();
        if isovalue.found && low >= high {
            return Err(PipelineError::Constant { value: low });
        }
        let shape = surface::solid(volume, &frame, units, isovalue.value, surface.extent)?;
        let coordinates = units.coordinates_of(&frame);
        let parameter = Parameter::of_surface(coordinates.unit);
        let origin = Origin::without_alpha(coordinates);
        let shape = self.kept(shape, parameter.unit)?;
        Ok(Model { shape, parameter, origin, labels: None, isovalue: Some(isovalue) })
    }

    /// Computes the shape of scattered points.
    ///
    /// # Errors
    /// The errors of its stages, and [`PipelineError::Cancelled`].
    pub fn run_points(&self, points: Points) -> Result<Model, PipelineError> {
        let metadata = ModelMetadata::default();
        self.finish(self.weighed_points(points, &metadata, Values::Written)?)
    }

    /// Computes the weighted points of an input, and returns the volume that they come from, if any.
    ///
    /// # Errors
    /// The errors of its stages.
    pub fn weigh(
        &self,
        input: Input,
        values: Values,
    ) -> Result<(Weighed, Option<PlacedVolume>), PipelineError> {
        match input {
            Input::Points(points, metadata) => {
                Ok((self.weighed_points(points, &metadata, values)?, None))
            }
            Input::Volume(volume) => {
                let source = self.source(volume)?;
                Ok((self.weighed(&source, values)?, Some(source)))
            }
        }
    }

    /// Computes the weighted points of a volume.
    ///
    /// # Errors
    /// The errors of its stages.
    pub fn weighed(&self, source: &PlacedVolume, values: Values) -> Result<Weighed, PipelineError> {
        let PlacedVolume { volume, units, range, written } = source;
        let (dims, frame, units) = (volume.dims(), *volume.frame(), *units);
        let parameter = self.alpha.of_frame(&frame, units)?;
        Stage::Haar.begin()?;
        let (smoothed, truncation) = smooth(volume, &self.haar)?;
        Stage::Points.begin()?;
        let choice = self.choice.at_least(self.value_min.map(|value| range.gray(value)));
        let chosen = choice.points(volume, &smoothed, units).map_err(|error| match error {
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
            torus: None,
            folded: None,
            fit: None,
        };
        let mut weighed = Weighed::new(points, origin, self.alpha, parameter)?.ordered(importance);
        weighed.place_on(self.periodic.map(|periodic| periodic.of(None)).transpose()?)?;
        weighed.recipe = Some(self.to_json());
        if let Some(to) = self.refit {
            self.fit(&mut weighed, source, to)?;
        }
        if let (Values::Written, Some(values)) = (values, weighed.points.values_mut()) {
            values.iter_mut().for_each(|value| *value = written.value(*value));
        }
        Ok(weighed)
    }

    /// Computes the weighted points of a file with this metadata. The default α is the stored one, if any.
    ///
    /// # Errors
    /// The errors of its stages.
    pub fn weighed_points(
        &self,
        mut points: Points,
        metadata: &ModelMetadata,
        values: Values,
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
            torus: None,
            folded: None,
            fit: None,
        };
        if let (Some(cell), None) = (metadata.cell, self.periodic) {
            tracing::warn!(
                "the file states a cell in which points repeat, {cell}, which is ignored; `periodic` cell uses it"
            );
        }
        self.warn_of_ignored(metadata);
        let unit = origin.coordinates.unit;
        let stored = metadata.alpha.filter(|_| self.alpha == AlphaRule::Default);
        let stored = stored.map(|alpha| Parameter { alpha, unit, origin: ParameterOrigin::Stored });
        let parameter = stored.or_else(|| self.alpha.given(unit));
        let mut weighed = Weighed::new(points, origin, self.alpha, parameter)?;
        weighed.place_on(self.periodic.map(|periodic| periodic.of(metadata.cell)).transpose()?)?;
        weighed.recipe = Some(metadata.recipe.clone().unwrap_or_else(|| self.record_of(&weighed)));
        Ok(weighed)
    }

    /// The record of how points were made: this recipe, with the box that they lie in.
    fn record_of(&self, weighed: &Weighed) -> String {
        let periodic = weighed.origin.torus.map(PeriodicBox::Given);
        self.clone().periodic(periodic.or(self.periodic)).to_json()
    }

    /// Warns of settings that a file of points states and that are to be given again: they say what the shape is of.
    fn warn_of_ignored(&self, metadata: &ModelMetadata) {
        let stated = metadata.recipe.as_deref().and_then(|text| serde_json::from_str(text).ok());
        let Some(Self { periodic, balls, .. }) = stated else { return };
        if let (Some(torus), None) = (periodic.and_then(PeriodicBox::given), self.periodic) {
            let list = |numbers: [f64; 3]| numbers.map(rounded).join(",");
            let vectors = torus.vectors();
            let sides = BoxVectors(vectors).sides();
            let given = sides.map_or_else(|| vectors.map(list).join(","), list);
            tracing::warn!(
                "the file states that its shape is of a periodic box, which is ignored; `periodic` {given} uses it"
            );
        }
        if balls != self.balls && self.balls == Balls::default() {
            tracing::warn!(
                "the file states that its balls have the radius α + weight, which is ignored; `balls` radius uses it"
            );
        }
    }

    /// Computes the shape of weighted points.
    ///
    /// # Errors
    /// The errors of its stages, and [`PipelineError::Radii`].
    pub fn finish(&self, mut weighed: Weighed) -> Result<Model, PipelineError> {
        let parameter = weighed.find_parameter()?;
        let options = self.shape_of(&weighed, parameter)?;
        Stage::Shape.begin()?;
        let Weighed { points, origin, .. } = weighed;
        let shape = alpha_shape(points, &options)?.with_coordinates(origin.coordinates);
        let shape = self.kept(shape, parameter.unit)?;
        Ok(Model { shape, parameter, origin, labels: None, isovalue: None })
    }

    /// The points of the components that are [to be kept](Recipe::keep) of the shape at α, with α as their parameter: at α and below, their shapes consist of
    /// these components. Returns how many were kept, too, and for each point whether it was.
    ///
    /// # Errors
    /// The errors of the shape, and [`PipelineError::NoComponent`].
    pub fn part(
        &self,
        weighed: &Weighed,
        alpha: Alpha,
    ) -> Result<(Weighed, Option<Kept>, Vec<bool>), PipelineError> {
        let options = self.shape_at(alpha).engine(Engine::Native).exterior(false);
        let shape = alpha_shape(weighed.points.clone(), &options)?;
        let shape = self.kept(shape, weighed.origin.coordinates.unit)?;
        // A ball that meets one of a component's simplices is in the component, so no other point decides its simplices.
        let numbers = shape.component_numbers().into_iter();
        let is_kept: Vec<bool> = numbers.map(|number| number != NO_COMPONENT).collect();
        Ok((weighed.only(&is_kept), shape.kept(), is_kept))
    }

    /// The components of a shape that are [to be kept](Recipe::keep). `unit` is that of its points.
    ///
    /// # Errors
    /// [`PipelineError::NoComponent`].
    pub fn kept(&self, shape: AlphaShape, unit: LengthUnit) -> Result<AlphaShape, PipelineError> {
        if self.keep.is_all() {
            return Ok(shape);
        }
        let part = shape.keep(&self.keep);
        match (self.keep.min_volume, part.kept()) {
            (Some(least), Some(Kept { components: 0, of: 1.., largest_volume: largest, .. })) => {
                Err(PipelineError::NoComponent { least, largest, unit })
            }
            _ => Ok(part),
        }
    }

    /// Fits the values of weighted points to their volume.
    fn fit(
        &self,
        weighed: &mut Weighed,
        source: &PlacedVolume,
        to: Refit,
    ) -> Result<(), PipelineError> {
        let parameter = weighed.find_parameter()?;
        Stage::Refit.begin()?;
        let options = self.shape_of(weighed, parameter)?;
        let shape = Monitor::current()
            .unreported()
            .watch(|| alpha_shape(weighed.points.clone(), &options))?;
        let fitted = refit(&shape, &source.volume, source.units, to)?;
        let points = std::mem::take(&mut weighed.points);
        weighed.points = points.with_values(fitted.values).expect("a value for each point");
        weighed.origin.fit = Some(fitted.fit);
        Ok(())
    }
}
