//! α of levels of detail, and α that holds other selections together.

use walpha_base::UnionFind;
use walpha_base::parallel::prelude::*;
use walpha_base::vector::{dot, sub};
use walpha_regular::{TriangulationError, triangulate};

use super::weighed::Importance;
use super::{
    AlphaRule, Model, Parameter, ParameterOrigin, PipelineError, PlacedVolume, Recipe, Values,
    Weighed,
};
use walpha_points::{Points, WeightedPoints, spread_order, weigh};
use walpha_shape::{Alpha, ShapeError};

impl Recipe {
    /// The α of a level of detail: of some samples of a volume, with the differences L that weights come from.
    ///
    /// By default it is the greater of two: 10 h², as for the whole volume ([`AlphaRule::Default`]), and α from the spacing of the
    /// points without weights ([`Parameter::of_spacing`]). So few points, which lie further apart than neighbouring samples, hold
    /// together, and many have the shape that [`Recipe::run`] makes of them. `auto` and `auto:connected` are taken for the points of the
    /// level. O(n log n).
    ///
    /// # Errors
    /// The errors of [`AlphaRule::of_volume`] and of the weights.
    pub fn level_parameter(
        &self,
        points: &Points,
        source: &PlacedVolume,
    ) -> Result<Parameter, PipelineError> {
        let unit = source.units.coordinates(&source.volume).unit;
        if let Some(of_grid) = self.alpha.of_volume(&source.volume, source.units)? {
            if self.alpha != AlphaRule::Default {
                return Ok(of_grid);
            }
            let of_spacing = Parameter::find_unweighted(AlphaRule::Auto, points, unit)?;
            return Ok(if of_spacing.alpha > of_grid.alpha { of_spacing } else { of_grid });
        }
        let weighting = self.weighting_of(points);
        if weighting.needs_differences() {
            return Parameter::find_unweighted(self.alpha, points, unit);
        }
        let weighted: WeightedPoints = weigh(points.clone(), weighting, Alpha::INFINITE)?;
        Ok(Parameter::find(self.alpha, &weighted, None, unit)?)
    }

    /// A level of detail: `count` points of a volume, with weights for their own α ([`Recipe::level_parameter`]). They are some of those that this recipe
    /// selects by differences, spread over all of these ([`spread_order`]); where these are fewer, or were selected otherwise, those that the recipe selects
    /// with this count. `weighed` is what [`Recipe::weighed`] makes of the same volume.
    ///
    /// # Errors
    /// The errors of its stages.
    pub fn level(
        &self,
        source: &PlacedVolume,
        weighed: &Weighed,
        count: u64,
    ) -> Result<Weighed, PipelineError> {
        let Some(Importance::Differences(differences)) =
            weighed.importance.as_ref().filter(|_| count <= weighed.points.len() as u64)
        else {
            let recipe = self.clone().choice(self.choice.with_count(count));
            return recipe.weighed(source, Values::Written);
        };
        let (positions, _, values) = weighed.points.clone().into_parts();
        let mut points = Points::new(positions);
        (points.values, points.differences) = (values, Some(differences.clone()));
        let mut is_kept = vec![false; points.len()];
        let order = spread_order(&points)?;
        order[..count as usize].iter().for_each(|&index| is_kept[index as usize] = true);
        points.keep(&is_kept);
        let parameter = self.level_parameter(&points, source)?;
        let recipe = weighed.recipe.clone();
        let level = Weighed::new(points, weighed.origin, weighed.rule, Some(parameter))?;
        Ok(Weighed { recipe, ..level })
    }
}

/// The share of points that one component has unless a shape is in pieces.
const HELD: f64 = 0.95;

impl Model {
    /// The least α at which one component contains 95 % of the points selected from a volume, rounded up to four digits; for shapes that the default
    /// α leaves in pieces. `None` if a component already has that share, if α was given, or if the points have weights.
    ///
    /// Components are those of balls about the points, which touch along edges of the minimum spanning tree first; and these are Delaunay edges. O(n log n).
    ///
    /// # Errors
    /// The errors of a triangulation.
    pub fn joining_alpha(&self) -> Result<Option<Alpha>, ShapeError> {
        let Parameter { alpha, origin, .. } = self.parameter;
        let points = self.shape.points();
        let in_shape = self.shape.points_in_shape();
        let held = |largest: usize| largest as f64 >= HELD * in_shape as f64;
        let sizes = self.shape.components().into_iter().map(|component| component.vertices);
        let is_whole = held(sizes.max().unwrap_or_default());
        let is_weighted = points.weights().iter().any(|&weight| weight != 0.0);
        if origin != ParameterOrigin::Default || is_whole || is_weighted {
            return Ok(None);
        }
        let places = points.positions();
        let squared_length = |[a, b]: [u32; 2]| {
            let away = sub(places[a as usize], places[b as usize]);
            dot(away, away)
        };
        let mesh = match triangulate(places, None) {
            Err(TriangulationError::Sites(_)) => return Ok(None),
            mesh => mesh?,
        };
        let edges = mesh
            .finite_cells()
            .flat_map(|(_, [a, b, c, d])| [[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]]);
        let mut edges: Vec<(f64, [u32; 2])> =
            edges.map(|edge| (squared_length(edge), edge)).collect();
        edges.par_sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let sets = UnionFind::new(places.len());
        let mut sizes = vec![1; places.len()];
        let joins = |edge: &&(f64, [u32; 2])| {
            let [a, b] = edge.1.map(|v| sets.find(v));
            let size = sizes[a as usize] + sizes[b as usize];
            if sets.unite(a, b) {
                sizes[a.min(b) as usize] = size;
            }
            held(sizes[a.min(b) as usize])
        };
        let Some((squared, _)) = edges.iter().find(joins) else { return Ok(None) };
        // A ball about each end reaches the middle of the edge.
        let found = Alpha::from_squared(rounded_up(squared / 4.0));
        Ok(found.ok().filter(|found| *found > alpha))
    }
}

/// A number above 0, rounded up to four digits.
fn rounded_up(number: f64) -> f64 {
    let step = 10f64.powf(number.log10().floor() - 3.0);
    (number / step).ceil() * step
}
