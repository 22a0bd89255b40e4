use std::num::NonZeroU64;

use serde::Serialize;
use walpha_base::parallel::join;
use walpha_base::parallel::prelude::*;

use super::levels::ByLevel;
use super::values::Value;
use super::{Filtration, Levels};
use crate::{Alpha, Betti};

/// The topology of a filtration at every critical value: every α at which a simplex enters.
///
/// Critical values are distinguished exactly; values with the same smallest double that is not below them are one entry, because
/// no double separates them. On a voxel grid, where thousands of values are equal, this leaves few entries.
#[derive(Clone, Debug)]
pub struct Curve {
    pub(super) values: Vec<Value>,
    /// The Betti numbers from each value on.
    pub betti: Vec<Betti>,
    /// The number of voids from each value on.
    pub voids: Vec<u64>,
    /// The solid components from each value on.
    pub solid_components: Vec<u64>,
    /// Number of vertices of the triangulation that are in no cell of the shape, from each value on; if points span no volume, in
    /// no triangle, or in no edge.
    pub loose: Vec<u64>,
    /// The visible simplices from each value on.
    pub(super) visible: Vec<Visible>,
    largest_weight: f64,
}

/// Suggested values of α, squared lengths, each the smallest double at which the shape has the property.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Suggestions {
    /// Every vertex of the triangulation is a vertex of a cell: MATLAB's `criticalAlpha(shp, 'all-points')`, CGAL's
    /// `Alpha_shape_3::find_alpha_solid`.
    pub all_points: Alpha,
    /// In addition, the cells are one solid component: MATLAB's `criticalAlpha(shp, 'one-region')`, CGAL's
    /// `Alpha_shape_3::find_optimal_alpha(1)`, which bisects and may find a larger one. This is the smallest α with the property,
    /// not one from which it lasts: the number of components rises and falls.
    pub one_region: Alpha,
    /// In addition, there are no voids.
    pub no_void: Alpha,
    /// The longest interval from `all_points` on in which the Betti numbers do not change, measured by the ratio of the
    /// squared radii of the largest balls. The second is the α at which they change again; ∞, the string "inf" in
    /// JSON, if from `all_points` on they never change.
    pub plateau: [Alpha; 2],
}

impl Filtration {
    /// The topology at all critical values. O(n log n).
    pub fn curve(&self) -> Curve {
        self.curve_of(self.values())
    }

    /// The topology at about `most` of the critical values, spread evenly over their ranks and including the first and the last.
    /// It is meant for pictures, for which all values would take several times as long. Each value of α is a double just above
    /// the critical value, and its topology is exact. O(n log n).
    ///
    /// # Panics
    /// When `most` is less than 2.
    pub fn coarse_curve(&self, most: usize) -> Curve {
        assert!(most >= 2, "two ends are needed");
        self.curve_of(self.some_values(most))
    }

    /// The α of [`coarse_curve`](Self::coarse_curve) alone, ascending, in about half of its time. O(n log n).
    ///
    /// # Panics
    /// When `most` is less than 2.
    pub fn coarse_alphas(&self, most: usize) -> Vec<Alpha> {
        assert!(most >= 2, "two ends are needed");
        self.some_values(most).iter().map(alpha_above).collect()
    }

    fn curve_of(&self, values: Vec<Value>) -> Curve {
        let levels = self.levels_of(&values);
        let ((betti, voids), solid_components) =
            join(levels.cells.len(), || levels.betti_and_voids(), || levels.solid_components());
        let weights = &self.points().weights;
        Curve {
            betti,
            voids,
            solid_components,
            loose: self.loose(&levels),
            visible: levels.visible(),
            largest_weight: weights.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            values,
        }
    }

    /// The smallest α at which all points are in one solid component ([`Levels::solid_components`]): [`Suggestions::one_region`],
    /// in less than half of the time of a [`Curve`]. O(n log n).
    pub fn one_region(&self) -> Alpha {
        self.optimal_alpha(NonZeroU64::MIN)
    }

    /// The smallest α at which all points are in at most this many solid components; like [`Filtration::one_region`], the
    /// counterpart of CGAL's `Alpha_shape_3::find_optimal_alpha`. O(n log n).
    #[expect(clippy::missing_panics_doc, reason = "an invariant")]
    pub fn optimal_alpha(&self, components: NonZeroU64) -> Alpha {
        let values = self.values();
        let levels = self.levels_of(&values);
        let (loose, solid) =
            join(levels.cells.len(), || self.loose(&levels), || levels.solid_components());
        let first = (0..values.len()).find(|&k| loose[k] == 0 && solid[k] <= components.get());
        let first = values[first.expect("the whole triangulation is one solid")];
        self.first_alpha(first)
    }

    /// A level for each critical value.
    fn levels_of(&self, values: &[Value]) -> Levels<'_> {
        let levels = self.levels(&values.iter().map(alpha_above).collect::<Vec<_>>());
        assert_eq!(levels.len(), values.len(), "one level for each value");
        levels
    }

    /// The number of vertices in no maximal simplex, at each level.
    fn loose(&self, levels: &Levels<'_>) -> Vec<u64> {
        let (firsts, levels) = (levels.firsts_of_maximal(), levels.len());
        let vertices = self.whole.complex().vertices.len();
        let mut covered = vec![levels as u32; vertices];
        for (row, &level) in firsts.iter().enumerate() {
            for &v in self.maximal_simplex(row) {
                let at = &mut covered[self.incidence.vertex_rows[v as usize] as usize];
                *at = level.min(*at);
            }
        }
        let by_level = ByLevel::new(levels, covered.iter().copied());
        let mut loose = vertices as u64;
        let less = |level| {
            loose -= by_level.at(level).len() as u64;
            loose
        };
        (0..levels).map(less).collect()
    }

    /// Suggests values of α. O(n).
    #[expect(clippy::missing_panics_doc, reason = "an invariant")]
    pub fn suggest(&self, curve: &Curve) -> Suggestions {
        let last = curve.values.len() - 1;
        let from = |start: usize, holds: &dyn Fn(usize) -> bool| {
            (start..=last).find(|&k| holds(k)).expect("the whole triangulation is one solid")
        };
        let all_points = from(0, &|k| curve.loose[k] == 0);
        let one_region = from(all_points, &|k| curve.solid_components[k] == 1);
        let no_void = from(one_region, &|k| curve.voids[k] == 0);
        let (from, to) = curve.plateau(all_points);
        let [all_points, one_region, no_void, low] =
            [all_points, one_region, no_void, from].map(|k| self.first_alpha(curve.values[k]));
        let high = to.map_or(Alpha::INFINITE, |to| self.first_alpha(curve.values[to]));
        Suggestions { all_points, one_region, no_void, plateau: [low, high] }
    }

    /// At most `count` critical values at which Betti numbers change, as evenly spaced as possible in the logarithm of the
    /// squared radius α + max ω of the largest balls. Each is the smallest double at which the shape is the new one. O(n·count).
    ///
    /// # Panics
    /// When `count` is less than 2.
    pub fn readable(&self, curve: &Curve, count: usize) -> Vec<Alpha> {
        assert!(count >= 2, "two ends are needed");
        let changes: Vec<usize> = (0..curve.values.len())
            .filter(|&k| curve.size(k) > 0.0 && (k == 0 || curve.betti[k] != curve.betti[k - 1]))
            .collect();
        let (Some(&first), Some(&last)) = (changes.first(), changes.last()) else {
            return Vec::new();
        };
        let (low, high) = (curve.size(first).ln(), curve.size(last).ln());
        let nearest = |step: usize| {
            let wanted = low + (high - low) * step as f64 / (count - 1) as f64;
            let away = |k: usize| (curve.size(k).ln() - wanted).abs();
            let above = changes.partition_point(|&k| curve.size(k).ln() < wanted);
            let sides = [above.saturating_sub(1), above.min(changes.len() - 1)];
            let [a, b] = sides.map(|at| changes[at]);
            if away(a) <= away(b) { a } else { b }
        };
        let mut chosen: Vec<usize> = (0..count).map(nearest).collect();
        chosen.dedup();
        chosen.par_iter().map(|&k| self.first_alpha(curve.values[k])).collect()
    }
}

/// An α at or just above a critical value.
fn alpha_above(value: &Value) -> Alpha {
    Alpha::from_squared(value.above()).expect("radii are numbers")
}

impl Curve {
    /// The number of critical values.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there are no critical values.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// A double α at or just above each critical value and below the next, ascending.
    pub fn alphas(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.values.iter().map(|value| value.above())
    }

    /// The largest weight ω: α + ω is the squared radius of the largest balls.
    pub fn largest_weight(&self) -> f64 {
        self.largest_weight
    }

    /// The squared radius of the largest balls at a value.
    pub(super) fn size(&self, k: usize) -> f64 {
        self.values[k].above() + self.largest_weight
    }

    /// The values at which the longest plateau starts and ends; without an end if nothing changes from the start on. If
    /// something does, the last plateau, which has no end, does not count.
    fn plateau(&self, start: usize) -> (usize, Option<usize>) {
        let ratio = |(a, b): (usize, usize)| self.size(b) / self.size(a);
        let mut best: Option<(usize, usize)> = None;
        let mut begin = start;
        for k in start + 1..self.values.len() {
            if self.betti[k] != self.betti[begin] {
                if best.is_none_or(|best| ratio((begin, k)) > ratio(best)) {
                    best = Some((begin, k));
                }
                begin = k;
            }
        }
        best.map_or((start, None), |(from, to)| (from, Some(to)))
    }
}

/// The visible simplices of a level: boundary and singular facets, and singular edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Visible {
    /// Their number.
    pub count: u64,
    /// The number of simplices that appear, disappear, or turn from singular to regular at this level.
    pub changed: u64,
}

impl Levels<'_> {
    /// The visible simplices of each level. O(n).
    pub(super) fn visible(&self) -> Vec<Visible> {
        let mut change = vec![(0i64, 0u64); self.len() + 1];
        let mut event = |level: u32, more: i64| {
            let (count, changed) = &mut change[level as usize];
            (*count, *changed) = (*count + more, *changed + 1);
        };
        for span in &self.facets {
            if span.first < span.interior {
                event(span.first, 1);
                if span.first < span.regular && span.regular < span.interior {
                    event(span.regular, 0);
                }
                event(span.interior, -1);
            }
        }
        for span in self.edges.iter().filter(|span| span.first < span.regular) {
            event(span.first, 1);
            event(span.regular, -1);
        }
        change.pop();
        let mut count = 0;
        let sight = |(more, changed): (i64, u64)| {
            count += more;
            Visible { count: count as u64, changed }
        };
        change.into_iter().map(sight).collect()
    }

    /// The levels with visible simplices that differ from those of the level before. Of several equal levels, `wanted` is kept if
    /// it is one of them, otherwise the first. O(n).
    pub fn distinct(&self, wanted: Alpha) -> Vec<Alpha> {
        let mut kept: Vec<Alpha> = Vec::new();
        let mut has_visible = false;
        for (&alpha, visible) in self.alphas().iter().zip(self.visible()) {
            let same = has_visible && visible.changed == 0;
            has_visible = visible.count > 0;
            if same && alpha == wanted {
                kept.pop();
            }
            if has_visible && (!same || alpha == wanted) {
                kept.push(alpha);
            }
        }
        kept
    }
}

impl Filtration {
    /// At most `count` critical values for pictures, ascending: each has visible simplices, and different ones from the value
    /// before.
    ///
    /// They are evenly spaced in the mean of three measures, so that neither few large simplices nor many small ones dominate:
    /// the logarithm of the squared radius of the largest balls, the facets and edges that appear and disappear, and the Betti
    /// numbers that change. The last two put most levels where the shape forms. O(n).
    pub fn stops(&self, curve: &Curve, count: usize) -> Vec<Alpha> {
        let shows = |&k: &usize| {
            let Visible { count, changed } = curve.visible[k];
            count > 0 && changed > 0 && curve.size(k) > 0.0
        };
        let all: Vec<usize> = (0..curve.len()).filter(shows).collect();
        let (Some(&first), Some(&last)) = (all.first(), all.last()) else { return Vec::new() };
        let measures = [
            (first..=last).map(|k| curve.size(k).max(curve.size(first)).ln()).collect(),
            sums((first..=last).map(|k| curve.visible[k].changed)),
            sums((first..=last).map(|k| curve.betti_change(k))),
        ];
        let coordinate = |k: usize| -> f64 {
            let share = |sums: &Vec<f64>| {
                let (low, high) = (sums[0], sums[sums.len() - 1]);
                if high > low { (sums[k - first] - low) / (high - low) } else { 0.0 }
            };
            measures.iter().map(share).sum()
        };
        let whole = coordinate(last);
        let mut chosen: Vec<usize> = Vec::new();
        for step in 0..count {
            let wanted = whole * step as f64 / (count.max(2) - 1) as f64;
            let at = all.partition_point(|&k| coordinate(k) < wanted).min(all.len() - 1);
            if chosen.last().is_none_or(|&before| before < all[at]) {
                chosen.push(all[at]);
            }
        }
        chosen.into_iter().map(|k| self.first_alpha(curve.values[k])).collect()
    }
}

impl Curve {
    /// The sum of the changes of the Betti numbers from the value before.
    fn betti_change(&self, k: usize) -> u64 {
        let of = |k: usize| <[u64; 3]>::from(self.betti[k]);
        let before = if k == 0 { [0; 3] } else { of(k - 1) };
        of(k).into_iter().zip(before).map(|(now, before)| now.abs_diff(before)).sum()
    }
}

/// Prefix sums.
fn sums(numbers: impl Iterator<Item = u64>) -> Vec<f64> {
    let mut sum = 0;
    let add = |number| {
        sum += number;
        sum as f64
    };
    numbers.map(add).collect()
}
