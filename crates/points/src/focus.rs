use std::path::Path;

use serde::{Deserialize, Serialize};
use walpha_base::advice::{Setting, advice};

use super::{Points, PointsError};
use crate::read::format as in_file;
use walpha_volume::Reason;

/// A box, including its boundary, in the units of the points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "Ends", from = "Ends")]
pub struct Region {
    /// The smallest coordinates, (x, y, z).
    pub low: [f64; 3],
    /// The largest coordinates, (x, y, z).
    pub high: [f64; 3],
}

/// The ends of a region along x, y and z, without those that are infinite.
type Ends = [[Option<f64>; 2]; 3];

impl From<Region> for Ends {
    fn from(Region { low, high }: Region) -> Self {
        let end = |number: f64| Some(number).filter(|number| number.is_finite());
        [0, 1, 2].map(|k| [end(low[k]), end(high[k])])
    }
}

impl From<Ends> for Region {
    fn from(ends: Ends) -> Self {
        let all = Self::EVERYWHERE;
        let [low, high] = [0, 1].map(|side| ends.map(|range| range[side]));
        Self {
            low: [0, 1, 2].map(|k| low[k].unwrap_or(all.low[k])),
            high: [0, 1, 2].map(|k| high[k].unwrap_or(all.high[k])),
        }
    }
}

impl Region {
    /// The box of all positions.
    pub const EVERYWHERE: Self = Self { low: [f64::NEG_INFINITY; 3], high: [f64::INFINITY; 3] };

    /// Whether a position is in the box.
    pub fn contains(&self, position: [f64; 3]) -> bool {
        (0..3).all(|k| (self.low[k]..=self.high[k]).contains(&position[k]))
    }

    /// The error for a file none of whose points, with these least and greatest coordinates, is in the box.
    pub(crate) fn without_points(&self, path: &Path, [low, high]: [[f64; 3]; 2]) -> PointsError {
        let ranges = |low: [f64; 3], high: [f64; 3]| {
            let range = |k: usize| format!("{}:{}", low[k], high[k]);
            [0, 1, 2].map(range).join(",")
        };
        let what = format!("has no point in {}", ranges(self.low, self.high));
        let there = ranges(low, high);
        let advice = advice!["give ", Setting::Region, format!(" a box that meets {there}")];
        in_file(path, Reason::choice(Setting::Region, what, advice))
    }
}

/// Combines fine points in a region with coarse points everywhere, ascending in z, then y, then x, like selected voxels. If both
/// have a point at one position, the fine one is kept. The region also keeps its coarse points, so it is never coarser than its
/// surroundings.
///
/// Only this one set is triangulated, so there is no seam between two meshes: cells across the border of the region join fine
/// points to coarse ones. A column (values, differences, weights) is kept if both sets have it. O(n log n).
pub fn focus(fine: &Points, coarse: &Points, region: &Region) -> Points {
    let inside = (0..fine.len()).filter(|&i| region.contains(fine.positions[i]));
    let coarse_ones = (0..coarse.len()).map(|i| (coarse, i));
    let mut chosen: Vec<(&Points, usize)> = inside.map(|i| (fine, i)).chain(coarse_ones).collect();
    let key = |&(points, i): &(&Points, usize)| {
        // −0 becomes 0, at the same position.
        let [x, y, z] = points.positions[i].map(|x| x + 0.0);
        [z, y, x]
    };
    chosen.sort_by(|a, b| {
        let (a, b) = (key(a), key(b));
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
    });
    // The sort is stable: of two points at one position, the fine one comes first.
    chosen.dedup_by_key(|&mut (points, i)| points.positions[i]);
    let column = |of: fn(&Points) -> Option<&Vec<f64>>| {
        let both = of(fine).is_some() && of(coarse).is_some();
        both.then(|| chosen.iter().filter_map(|&(points, i)| Some(of(points)?[i])).collect())
    };
    Points {
        positions: chosen.iter().map(|&(points, i)| points.positions[i]).collect(),
        values: column(|points| points.values.as_ref()),
        differences: column(|points| points.differences.as_ref()),
        weights: column(|points| points.weights.as_ref()),
        of_radii: fine.of_radii && coarse.of_radii,
        molecule: None,
        columns: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fine_inside_and_coarse_outside() {
        let points = |xs: &[f64], value: f64| Points {
            positions: xs.iter().map(|&x| [x, 0.0, 0.0]).collect(),
            values: Some(vec![value; xs.len()]),
            ..Points::default()
        };
        let (fine, coarse) =
            (points(&[0.0, 1.0, 2.0, 3.0, 4.0], 1.0), points(&[0.0, 2.0, 4.0], 2.0));
        let region = Region { low: [1.0, -1.0, 0.0], high: [3.0, 1.0, 0.0] };
        let both = focus(&fine, &coarse, &region);
        assert_eq!(both.positions, fine.positions);
        assert_eq!(both.values, Some(vec![2.0, 1.0, 1.0, 1.0, 2.0]));
        assert_eq!(both.differences, None);
    }

    #[test]
    fn a_region_is_never_coarser_than_what_is_around_it() {
        let points = |xs: &[f64]| Points {
            positions: xs.iter().map(|&x| [x, 0.0, 0.0]).collect(),
            ..Points::default()
        };
        let (few, many) = (points(&[1.0, 2.5]), points(&[0.0, 1.0, 2.0, 3.0, 4.0]));
        let region = Region { low: [1.0, -1.0, 0.0], high: [3.0, 1.0, 0.0] };
        let xs: Vec<f64> = focus(&few, &many, &region).positions.iter().map(|p| p[0]).collect();
        assert_eq!(xs, [0.0, 1.0, 2.0, 2.5, 3.0, 4.0]);
    }

    #[test]
    fn zeros_of_either_sign_are_one_position() {
        let point = |y: f64, value: f64| Points {
            positions: vec![[2.0, y, 0.0]],
            values: Some(vec![value]),
            ..Points::default()
        };
        let region = Region { low: [1.0, -1.0, 0.0], high: [3.0, 1.0, 0.0] };
        for (fine, coarse) in [(0.0, -0.0), (-0.0, 0.0)] {
            let both = focus(&point(fine, 1.0), &point(coarse, 2.0), &region);
            assert_eq!(both.values, Some(vec![1.0]));
        }
    }
}
