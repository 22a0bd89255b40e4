use walpha_base::keep;
use walpha_base::parallel::prelude::*;

use super::{AlphaRule, Parameter, PipelineError};
use crate::interpolate::{Adaptive, Fit};
use crate::progress::Stage;
use walpha_points::haar::Truncation;
use walpha_points::{
    ModelMetadata, Points, SampleGrid, WeightedPoints, Weighting, scattered_difference, weigh,
    weights,
};
use walpha_shape::{Alpha, Torus};
use walpha_volume::{Coordinates, GrayRange};

/// Weighted points, with a record of how they were made.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Weighed {
    /// The points, with the values that [`Values`](super::Values) requested.
    pub points: WeightedPoints,
    /// The origin of the points.
    pub origin: Origin,
    /// The value of α; `None` while it must still be found ([`Weighed::find_parameter`]), as weights do not need it.
    pub parameter: Option<Parameter>,
    /// The rule that finds α if it must still be found.
    pub rule: AlphaRule,
    /// The recipe that made the points ([`Recipe::to_json`](super::Recipe::to_json)), or else that of the file they were read
    /// from.
    pub recipe: Option<String>,
    /// The order of importance of the points, if they were selected from a volume.
    pub(super) importance: Option<Importance>,
}

/// The order of importance of points.
#[derive(Clone, Debug)]
pub(super) enum Importance {
    /// The points are ordered by their differences L.
    Differences(Vec<f64>),
    /// The points are in this order, given by their indices.
    Order(Vec<u32>),
}

/// The origin of points.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Origin {
    /// The axes and unit of the coordinates.
    pub coordinates: Coordinates,
    /// The source of the weights.
    pub weighting: Weighting,
    /// The truncation of the volume.
    pub truncation: Option<Truncation>,
    /// The grid whose samples the points are, if known.
    pub grid: Option<SampleGrid>,
    /// The values that were gray 0 and 255, if a file of points states them.
    pub range: Option<GrayRange>,
    /// The goal of adaptive selection, if it was reached with fewer points than allowed.
    pub ended: Option<Adaptive>,
    /// Whether the weights are squares of radii.
    pub of_radii: bool,
    /// The periodic box that the points lie in.
    pub torus: Option<Torus>,
    /// The number of points outside the periodic box, which are moved to their copies inside; `None` without a box.
    pub folded: Option<usize>,
    /// The fit of values to the volume; `None` if they are those of its samples.
    pub fit: Option<Fit>,
}

impl Origin {
    /// The origin of points that were not selected, in these coordinates: of labels or of an isosurface.
    pub(super) fn without_alpha(coordinates: Coordinates) -> Self {
        Self {
            coordinates,
            weighting: Weighting::Common(0.0),
            truncation: None,
            grid: None,
            range: None,
            ended: None,
            of_radii: false,
            torus: None,
            folded: None,
            fit: None,
        }
    }
}

impl Weighed {
    /// Gives points their weights, and finds α first if the weights are proportional to it.
    pub(super) fn new(
        mut points: Points,
        origin: Origin,
        rule: AlphaRule,
        mut parameter: Option<Parameter>,
    ) -> Result<Self, PipelineError> {
        Stage::Points.begin()?;
        let Origin { weighting, coordinates, .. } = origin;
        let scattered = points.differences.is_none() && points.values.is_some();
        if scattered && weighting.needs_differences() {
            points.differences = Some(scattered_difference(&points)?);
        }
        if parameter.is_none() && weighting.needs_differences() {
            // This checks the weights before the costly search for α.
            weights(&points, weighting, Alpha::ZERO)?;
            Stage::Alpha.begin()?;
            parameter = Some(Parameter::find_unweighted(rule, &points, coordinates.unit)?);
            Stage::Points.begin()?;
        }
        // Weights that do not depend on α are computed with ∞.
        let alpha = parameter.map_or(Alpha::INFINITE, |parameter| parameter.alpha);
        let points = weigh(points, weighting, alpha)?;
        Ok(Self { points, origin, parameter, rule, recipe: None, importance: None })
    }

    /// Sets the order of importance of the points.
    pub(super) fn ordered(self, importance: Importance) -> Self {
        Self { importance: Some(importance), ..self }
    }

    /// Some of the points, without their order of importance.
    pub(super) fn only(&self, is_kept: &[bool]) -> Self {
        let (mut positions, mut weights, mut values) = self.points.clone().into_parts();
        keep(&mut positions, is_kept);
        keep(&mut weights, is_kept);
        values.iter_mut().for_each(|values| keep(values, is_kept));
        let points = WeightedPoints::new(positions, weights);
        let points = points.and_then(|points| points.with_values(values));
        let points = points.expect("a weight and a value for each point");
        let recipe = self.recipe.clone();
        Self {
            points,
            origin: self.origin,
            parameter: self.parameter,
            rule: self.rule,
            recipe,
            importance: None,
        }
    }

    /// The indices of the points, the most important first, if they were selected from a volume. The first k are those that a
    /// count of k would have selected, unless points were exchanged. O(n log n).
    pub fn order(&self) -> Option<Vec<u32>> {
        Some(match self.importance.as_ref()? {
            Importance::Differences(differences) => largest_first(differences),
            Importance::Order(order) => order.clone(),
        })
    }

    /// The metadata of these points for a file, except their order. `written` maps the gray levels of the volume that they were
    /// selected from to written values ([`PlacedVolume::written`](super::PlacedVolume::written)).
    pub fn metadata(&self, written: Option<GrayRange>) -> ModelMetadata {
        let origin = self.origin;
        ModelMetadata::default()
            .grid(origin.grid)
            .coordinates(origin.coordinates)
            .alpha(self.parameter.map(|parameter| parameter.alpha))
            .range(written.or(origin.range))
            .recipe(self.recipe.clone())
    }

    /// The value of α, which is found now if weights did not need it.
    ///
    /// # Errors
    /// For [`AlphaRule::Connected`], the errors of a [`Filtration`](walpha_shape::ladder::Filtration).
    pub fn find_parameter(&mut self) -> Result<Parameter, PipelineError> {
        if let Some(parameter) = self.parameter {
            return Ok(parameter);
        }
        Stage::Alpha.begin()?;
        let unit = self.origin.coordinates.unit;
        let found = Parameter::find(self.rule, &self.points, self.origin.torus, unit)?;
        self.parameter = Some(found);
        Ok(found)
    }

    /// Places the points on a torus, if there is one, and counts the points outside its box.
    ///
    /// # Errors
    /// [`PipelineError::PeriodicWeights`]: differences to neighbours of scattered points do not take the copies across the sides
    /// of the box into account.
    pub(super) fn place_on(&mut self, torus: Option<Torus>) -> Result<(), PipelineError> {
        self.origin.torus = torus;
        let Some(torus) = torus else { return Ok(()) };
        let Origin { weighting, truncation, .. } = self.origin;
        if truncation.is_none() && weighting.needs_differences() {
            return Err(PipelineError::PeriodicWeights);
        }
        let is_outside = |place: &&[f64; 3]| !torus.holds(**place);
        self.origin.folded = Some(self.points.positions().par_iter().filter(is_outside).count());
        Ok(())
    }
}

/// The indices of numbers, the largest first, with ties in order of the index.
fn largest_first(numbers: &[f64]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..numbers.len() as u32).collect();
    let number = |index: u32| numbers[index as usize];
    order.par_sort_unstable_by(|&a, &b| number(b).total_cmp(&number(a)).then(a.cmp(&b)));
    order
}
