use rayon::prelude::*;
use walpha_base::Monitor;

use super::{Parameter, PipelineError};
use crate::haar::Truncation;
use crate::interpolate::{Adaptive, Fit};
use crate::points::{
    Points, SampleGrid, WeightedPoints, Weighting, scattered_difference, weigh, weights,
};
use crate::progress::Stage;
use crate::shape::{Alpha, Torus};
use crate::volume::{Coordinates, GrayRange};

/// Weighted points, and how they came about.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Weighed {
    /// Their values are those that [`Values`](super::Values) asked for.
    pub points: WeightedPoints,
    /// How it all came about.
    pub origin: Origin,
    /// α; `None` where it is still to be found ([`Weighed::find_parameter`]), because weights do not need it.
    pub parameter: Option<Parameter>,
    /// The recipe that made them ([`Recipe::to_json`](super::Recipe::to_json)), or else that of the file they were read from.
    pub recipe: Option<String>,
    /// By what the points are ordered, where they were selected from a volume.
    importance: Option<Importance>,
}

/// How much points matter.
#[derive(Clone, Debug)]
pub(super) enum Importance {
    /// By their differences L.
    Differences(Vec<f64>),
    /// They are in this order, by their indices.
    Order(Vec<u32>),
}

/// Where points come from.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Origin {
    /// Axes and unit of the coordinates.
    pub coordinates: Coordinates,
    /// Where their weights come from.
    pub weighting: Weighting,
    /// The truncation of the volume.
    pub truncation: Option<Truncation>,
    /// The grid that they are samples of, where that is known.
    pub grid: Option<SampleGrid>,
    /// The values that were gray 0 and 255, where a file of points states them.
    pub range: Option<GrayRange>,
    /// Adaptive selection ended before it had as many points as asked for.
    pub ended: Option<Adaptive>,
    /// Whether their weights are squares of radii.
    pub of_radii: bool,
    /// How many of them lay outside of the periodic box, and were moved to their copies inside; `None` without
    /// a box.
    pub folded: Option<usize>,
    /// How values were fitted to the volume; `None` where they are those of its samples.
    pub fit: Option<Fit>,
}

impl Weighed {
    /// Gives points their weights, and finds α first where these are in proportion to it.
    pub(super) fn new(
        mut points: Points,
        origin: Origin,
        mut parameter: Option<Parameter>,
        monitor: &Monitor,
    ) -> Result<Self, PipelineError> {
        Stage::Points.begin(monitor)?;
        let Origin { weighting, coordinates, .. } = origin;
        let scattered = points.differences.is_none() && points.values.is_some();
        if scattered && weighting.needs_differences() {
            points.differences = Some(scattered_difference(&points)?);
        }
        if parameter.is_none() && weighting.needs_differences() {
            // Weights are checked before the search.
            weights(&points, weighting, Alpha::ZERO)?;
            Stage::Alpha.begin(monitor)?;
            parameter = Some(Parameter::find_unweighted(&points, coordinates.unit, monitor)?);
            Stage::Points.begin(monitor)?;
        }
        // Weights that do not depend on α are the same at ∞.
        let alpha = parameter.map_or(Alpha::INFINITE, |parameter| parameter.alpha);
        let points = weigh(points, weighting, alpha)?;
        Ok(Self { points, origin, parameter, recipe: None, importance: None })
    }

    /// The same points with what they are ordered by.
    pub(super) fn ordered(self, importance: Importance) -> Self {
        Self { importance: Some(importance), ..self }
    }

    /// The points by their indices, the most important first, where they were selected from a volume: the
    /// first so many are what a smaller count would have selected. O(n log n).
    pub fn order(&self) -> Option<Vec<u32>> {
        Some(match self.importance.as_ref()? {
            Importance::Differences(differences) => largest_first(differences),
            Importance::Order(order) => order.clone(),
        })
    }

    /// α, found now if weights did not need it.
    ///
    /// # Errors
    /// What a [`Filtration`](crate::ladder::Filtration) refuses.
    pub fn find_parameter(&mut self, monitor: &Monitor) -> Result<Parameter, PipelineError> {
        self.find_on(None, monitor)
    }

    /// The filtration on a torus, if there is one.
    pub(super) fn find_on(
        &mut self,
        torus: Option<Torus>,
        monitor: &Monitor,
    ) -> Result<Parameter, PipelineError> {
        if let Some(parameter) = self.parameter {
            return Ok(parameter);
        }
        Stage::Alpha.begin(monitor)?;
        let found = Parameter::find(&self.points, torus, self.origin.coordinates.unit, monitor)?;
        self.parameter = Some(found);
        Ok(found)
    }

    /// Says that the points are those of a torus, if there is one, and counts those outside of its box.
    ///
    /// # Errors
    /// [`PipelineError::PeriodicWeights`]: weights of scattered points that come from differences to neighbours
    /// know nothing of the copies beyond the sides of the box.
    pub fn on_torus(&mut self, torus: Option<Torus>) -> Result<(), PipelineError> {
        let Some(torus) = torus else { return Ok(()) };
        let Origin { weighting, truncation, .. } = self.origin;
        if truncation.is_none() && weighting.needs_differences() {
            return Err(PipelineError::PeriodicWeights);
        }
        let is_outside = |place: &&[f64; 3]| !torus.holds(**place);
        self.origin.folded = Some(self.points.positions.par_iter().filter(is_outside).count());
        Ok(())
    }
}

/// The indices of numbers, the largest first, ties by the index.
fn largest_first(numbers: &[f64]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..numbers.len() as u32).collect();
    let number = |index: u32| numbers[index as usize];
    order.par_sort_unstable_by(|&a, &b| number(b).total_cmp(&number(a)).then(a.cmp(&b)));
    order
}
