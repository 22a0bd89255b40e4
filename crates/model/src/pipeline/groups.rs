//! A shape for each group of points: those that have one number in a column, such as the trees of a scan.

use std::collections::BTreeMap;

use walpha_base::Monitor;
use walpha_base::advice::{Advice, Advise};
use walpha_base::parallel::prelude::*;
use walpha_base::shown::number;
use walpha_points::{WeightedPoints, bounding_box};
use walpha_shape::{AlphaShape, Class, alpha_shape};

use super::{PipelineError, Recipe, Weighed};
use crate::progress::Stage;

/// Points in groups, by the whole numbers in a column.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Groups {
    /// The indices of the points of each group, ascending, by its number.
    pub members: BTreeMap<i64, Vec<u32>>,
    /// How many points have no number, and are in no group.
    pub left_out: usize,
}

/// The shape of a group.
#[derive(Debug)]
#[non_exhaustive]
pub struct GroupShape {
    /// The number of the group in the column.
    pub value: i64,
    /// The number of its points. Where only some components of shapes are kept, these are the vertices of those of the group, here and below.
    pub points: usize,
    /// The corners of the box around its points, with the least and with the greatest coordinates; NaN without points.
    pub bounds: [[f64; 3]; 2],
    /// Its shape.
    pub shape: AlphaShape,
    /// The shape, at the same α, of its points seen from above: with z = 0.
    pub from_above: AlphaShape,
}

/// A column that forms no groups.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GroupsError {
    /// A number is not a whole one below 2⁵³.
    #[error(
        "the column {column} has {} at point {point}, and {count} numbers in all that are not whole, or from 2⁵³ on, where doubles do not hold every whole number: they form no groups",
        number(*value)
    )]
    NotWhole {
        /// The name of the column.
        column: String,
        /// The first point with such a number.
        point: usize,
        /// Its number.
        value: f64,
        /// How many such numbers there are.
        count: usize,
    },
    /// There are too many groups.
    #[error(
        "the column {column} has {count} different values for {points} points, more than {most}"
    )]
    TooMany {
        /// The name of the column.
        column: String,
        /// The number of different values.
        count: usize,
        /// The number of points.
        points: usize,
        /// The largest number of groups.
        most: usize,
    },
    /// No point has a number.
    #[error("the column {column} has no number at any point")]
    Nothing {
        /// The name of the column.
        column: String,
    },
}

impl Advise for GroupsError {
    fn advice(&self) -> Option<Advice> {
        Some("name a column that numbers objects, such as treeID, class or label".into())
    }
}

impl Groups {
    /// The largest number of groups.
    pub const MOST: usize = 100_000;

    /// Groups points by the numbers of a column, one for each point. Points without a number (NaN) are left out. O(n log n).
    ///
    /// # Errors
    /// A number is not a whole one, there are more than [`MOST`](Self::MOST) groups, or none.
    pub fn of(column: &str, values: &[f64]) -> Result<Self, GroupsError> {
        /// Whole numbers below this are exact.
        const MOST_WHOLE: f64 = (1u64 << f64::MANTISSA_DIGITS) as f64;
        let is_whole = |value: f64| value.fract() == 0.0 && value.abs() < MOST_WHOLE;
        let is_wrong = |value: &f64| !value.is_nan() && !is_whole(*value);
        let column = column.to_owned();
        if let Some(point) = values.iter().position(is_wrong) {
            let count = values.iter().filter(|&value| is_wrong(value)).count();
            return Err(GroupsError::NotWhole { column, point, value: values[point], count });
        }
        let mut members: BTreeMap<i64, Vec<u32>> = BTreeMap::new();
        let numbered = values.iter().enumerate().filter(|(_, value)| !value.is_nan());
        for (point, &value) in numbered {
            members.entry(value as i64).or_default().push(point as u32);
        }
        let (count, points) = (members.len(), values.len());
        if count > Self::MOST {
            return Err(GroupsError::TooMany { column, count, points, most: Self::MOST });
        }
        if count == 0 {
            return Err(GroupsError::Nothing { column });
        }
        let left_out = values.iter().filter(|value| value.is_nan()).count();
        Ok(Self { members, left_out })
    }
}

impl Recipe {
    /// Computes the shape of each group of weighted points, all at one α: that of the recipe, or the one found for all points.
    /// Groups are computed in parallel, and are in the order of their numbers.
    ///
    /// # Errors
    /// The errors of finding α and of shapes, and [`PipelineError::Cancelled`].
    pub fn finish_groups(
        &self,
        weighed: &mut Weighed,
        groups: &Groups,
    ) -> Result<Vec<GroupShape>, PipelineError> {
        let monitor = &*Monitor::current();
        let parameter = monitor.watch(|| weighed.find_parameter())?;
        let options = self.shape_of(weighed, parameter)?.refuse_flat(false);
        monitor.watch(|| Stage::Shape.begin())?;
        let units = monitor.units(groups.members.len() as u64);
        let (points, coordinates) = (&weighed.points, weighed.origin.coordinates);
        let shape_of = |points: WeightedPoints| -> Result<AlphaShape, PipelineError> {
            let shape = monitor.unreported().watch(|| alpha_shape(points, &options))?;
            Ok(shape.with_coordinates(coordinates))
        };
        let one = |(&value, members): (&i64, &Vec<u32>)| {
            let mut above = chosen(points, members);
            let mut shape = shape_of(above.clone())?;
            let mut count = members.len();
            if !self.keep.is_all() {
                // A group without a component of the least volume is empty.
                shape = shape.keep(&self.keep);
                let vertices = shape.complex().vertices.iter();
                let kept = vertices.filter(|(_, class)| *class != Class::Exterior);
                let kept: Vec<u32> = kept.map(|(row, _)| row[0]).collect();
                count = kept.len();
                // A single point has no outline, as nothing has.
                above = chosen(&above, if kept.is_empty() { &[0] } else { &kept });
            }
            let bounds =
                if count == 0 { [[f64::NAN; 3]; 2] } else { bounding_box(above.positions()) };
            above.positions_mut().iter_mut().for_each(|place| place[2] = 0.0);
            let from_above = shape_of(above)?;
            units.add(1)?;
            Ok(GroupShape { value, points: count, bounds, shape, from_above })
        };
        let members: Vec<_> = groups.members.iter().collect();
        members.into_par_iter().map(one).collect()
    }
}

/// Some of the points.
fn chosen(points: &WeightedPoints, members: &[u32]) -> WeightedPoints {
    let column = |all: &[f64]| members.iter().map(|&point| all[point as usize]).collect::<Vec<_>>();
    let positions = members.iter().map(|&point| points.positions()[point as usize]).collect();
    WeightedPoints::new(positions, column(points.weights()))
        .and_then(|chosen| chosen.with_values(points.values().map(column)))
        .expect("a weight and a value for each point")
}

#[cfg(test)]
mod tests {
    use super::*;
    use walpha_points::Points;
    use walpha_shape::Alpha;

    #[test]
    fn groups_are_by_whole_numbers() {
        let groups = Groups::of("id", &[3.0, -1.0, f64::NAN, 3.0]).unwrap();
        assert_eq!(groups.members, BTreeMap::from([(-1, vec![1]), (3, vec![0, 3])]));
        assert_eq!(groups.left_out, 1);
        let error = Groups::of("id", &[1.0, 0.5, 2.5]).unwrap_err().to_string();
        assert!(
            error.contains("has 0.5 at point 1, and 2 numbers in all that are not whole"),
            "{error}"
        );
        let many: Vec<f64> = (0..=Groups::MOST as u32).map(f64::from).collect();
        let error = Groups::of("id", &many).unwrap_err().to_string();
        assert!(error.contains("100001 different values for 100001 points"), "{error}");
        assert!(Groups::of("id", &[f64::NAN]).is_err());
    }

    /// Two cubes far apart, and the same α for both: that of all points.
    #[test]
    fn shapes_of_groups_share_their_parameter() {
        let corner =
            |k: u32, x: f64| [x + f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)];
        let positions: Vec<_> =
            (0..8).map(|k| corner(k, 0.0)).chain((0..8).map(|k| corner(k, 9.0))).collect();
        let ids: Vec<f64> = (0..16).map(|k| f64::from(k / 8)).collect();
        let groups = Groups::of("id", &ids).unwrap();
        let recipe = Recipe::new();
        let metadata = walpha_points::ModelMetadata::default();
        let points = Points::new(positions);
        let mut weighed =
            recipe.weighed_points(points, &metadata, crate::pipeline::Values::Written).unwrap();
        let shapes = recipe.finish_groups(&mut weighed, &groups).unwrap();
        let alpha: Alpha = weighed.parameter.unwrap().alpha;
        for (value, shape) in shapes.iter().enumerate() {
            assert_eq!((shape.value, shape.points), (value as i64, 8));
            assert_eq!(shape.shape.options().alpha, alpha);
            assert_eq!(shape.shape.measures().volume, 1.0);
            assert_eq!(shape.from_above.outline().unwrap().area, 1.0);
            assert_eq!(shape.bounds[0], [9.0 * value as f64, 0.0, 0.0]);
        }
    }
}
