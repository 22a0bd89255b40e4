//! Points sorted into boxes, to find those near a position.

use std::cell::Cell;

use super::structure::Points;
use crate::index::in_buckets;

/// Points sorted into the boxes of a uniform grid.
pub(super) struct Grid {
    low: [f64; 3],
    step: f64,
    /// 1 / `step`.
    scale: f64,
    counts: [usize; 3],
    /// The start of the points of each box; x varies fastest.
    starts: Vec<u32>,
    points: Vec<u32>,
}

impl Grid {
    /// Sorts points into up to four times as many boxes: points of surfaces leave most boxes empty.
    pub(super) fn new(of: Points, points: Vec<u32>) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for &i in &points {
            let position = of.position(i);
            for k in 0..3 {
                low[k] = low[k].min(position[k]);
                high[k] = high[k].max(position[k]);
            }
        }
        let extent: [f64; 3] = std::array::from_fn(|k| high[k] - low[k]);
        let longest = extent.iter().copied().fold(0.0, f64::max);
        let boxes = |step: f64| extent.map(|e| (e / step) as usize + 1);
        let (mut step, mut counts) = (f64::INFINITY, [1; 3]);
        if longest > 0.0 && longest.is_finite() {
            // Halves the step until the boxes outnumber the points; flat sets have flat grids.
            step = longest;
            counts = boxes(step);
            while step > f64::MIN_POSITIVE {
                let finer = boxes(step / 2.0);
                if finer.iter().product::<usize>() > 4 * points.len() {
                    break;
                }
                (step, counts) = (step / 2.0, finer);
            }
        }
        let mut grid =
            Self { low, step, scale: step.recip(), counts, starts: Vec::new(), points: Vec::new() };
        let boxes = counts.iter().product::<usize>();
        let entries = || points.iter().map(|&i| (grid.number(grid.at(of.position(i))) as u32, i));
        (grid.starts, grid.points) = in_buckets(boxes, rayon::current_num_threads(), &entries);
        grid
    }

    /// Calls `visit` with every point within `radius` of `center`, and some beyond, until it
    /// returns a value.
    pub(super) fn within<T>(
        &self,
        center: [f64; 3],
        radius: f64,
        visit: impl Fn(u32) -> Option<T>,
    ) -> Option<T> {
        self.rows_within(center, radius, |row| row.iter().find_map(|&point| visit(point)))
    }

    /// The number of points that [`within`](Self::within) visits.
    pub(super) fn count(&self, center: [f64; 3], radius: f64) -> usize {
        let count = Cell::new(0);
        self.rows_within(center, radius, |row| {
            count.set(count.get() + row.len());
            None::<()>
        });
        count.get()
    }

    /// Calls `visit` with rows of boxes that contain every point within `radius` of `center`, until it returns a value.
    fn rows_within<T>(
        &self,
        center: [f64; 3],
        radius: f64,
        visit: impl Fn(&[u32]) -> Option<T>,
    ) -> Option<T> {
        // Rounding is monotonic, so a point between two positions is in a box between theirs.
        let from = self.at(center.map(|x| (x - radius).next_down()));
        let to = self.at(center.map(|x| (x + radius).next_up()));
        for z in from[2]..=to[2] {
            let flat = self.apart(2, z, center[2]) / radius;
            for y in from[1]..=to[1] {
                let steep = self.apart(1, y, center[1]) / radius;
                // The ball does not reach this row; the last term covers roundings.
                if flat * flat + steep * steep > 1.0 + 4e-15 {
                    continue;
                }
                let found = visit(self.row([from[0], to[0]], y, z));
                if found.is_some() {
                    return found;
                }
            }
        }
        None
    }

    /// Calls `visit` with every point between two corners of an axis-parallel box, and some beyond, until it returns a value.
    pub(super) fn between<T>(
        &self,
        low: [f64; 3],
        high: [f64; 3],
        visit: impl Fn(u32) -> Option<T>,
    ) -> Option<T> {
        let (from, to) = (self.at(low), self.at(high));
        let row = |y: usize, z: usize| self.row([from[0], to[0]], y, z).iter();
        (from[2]..=to[2])
            .find_map(|z| (from[1]..=to[1]).find_map(|y| row(y, z).find_map(|&point| visit(point))))
    }

    /// The points in a row of boxes.
    fn row(&self, [first, last]: [usize; 2], y: usize, z: usize) -> &[u32] {
        let (first, last) = (self.number([first, y, z]), self.number([last, y, z]));
        &self.points[self.starts[first] as usize..self.starts[last + 1] as usize]
    }

    /// A lower bound on the distance, along an axis, between `x` and the points of a slice of boxes. NaN if there is one infinite
    /// box, which is then visited.
    fn apart(&self, axis: usize, slice: usize, x: f64) -> f64 {
        let low = self.low[axis] + slice as f64 * self.step;
        let high = self.low[axis] + (slice + 1) as f64 * self.step;
        // More than the roundings in the sorting of positions, and those of these two numbers.
        let rounded = 8.0 * f64::EPSILON * (self.low[axis].abs() + high.abs()) + f64::MIN_POSITIVE;
        // The last slice also contains the points beyond it.
        let beyond = if slice + 1 == self.counts[axis] { 0.0 } else { x - high };
        (low - x).max(beyond).max(rounded) - rounded
    }

    /// The points in the order of the grid.
    pub(super) fn points(&self) -> &[u32] {
        &self.points
    }

    /// Some point near a position, if there are points.
    pub(super) fn some_near(&self, position: [f64; 3]) -> Option<u32> {
        let center = self.at(position);
        let reach = *self.counts.iter().max().expect("three axes");
        (0..reach).find_map(|ring| {
            let from: [usize; 3] = std::array::from_fn(|k| center[k].saturating_sub(ring));
            let to: [usize; 3] =
                std::array::from_fn(|k| (center[k] + ring).min(self.counts[k] - 1));
            (from[2]..=to[2]).find_map(|z| {
                (from[1]..=to[1]).find_map(|y| self.row([from[0], to[0]], y, z).first().copied())
            })
        })
    }

    fn at(&self, position: [f64; 3]) -> [usize; 3] {
        std::array::from_fn(|k| {
            // The cast turns negative numbers, and the NaN of an infinite box, into 0.
            (((position[k] - self.low[k]) * self.scale) as u32 as usize).min(self.counts[k] - 1)
        })
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use walpha_base::random::Random;

    use super::*;
    use crate::exact::WeightedPoint;

    /// Every point within a radius is visited once, for any unit of length; for small balls only few other points are visited.
    #[test]
    fn all_points_within_are_visited() {
        let mut random = Random::new(11);
        let (mut within, mut visited_in_all, mut points_in_all) = (0, 0, 0);
        for round in 0..300 {
            let unit = 2f64.powi(random.pick(&[-1000, -520, -30, 0, 1, 300, 500]));
            // Also use points of a plane, of a line, and at one place.
            let sides = [0, 1, 2].map(|k| if round % 7 > k { 40 } else { 0 });
            let mut draw = |beyond: i64| sides.map(|side| random.whole(-beyond, side + beyond));
            let positions: Vec<[f64; 3]> = (0..200).map(|_| draw(0)).collect();
            let sites: Vec<WeightedPoint> = (positions.iter())
                .map(|p| WeightedPoint { position: p.map(|x| x * unit), weight: 0.0 })
                .collect();
            // Use only some of them.
            let numbers: Vec<u32> = (0..200).filter(|i| i % 3 != 1).collect();
            let grid = Grid::new(Points { sites: &sites }, numbers.clone());
            for _ in 0..20 {
                let center = draw(3);
                let radius = draw(0)[0].max(1.0) / 4.0;
                let visited = RefCell::new(Vec::new());
                let found = grid.within(center.map(|x| x * unit), radius * unit, |number| {
                    visited.borrow_mut().push(number);
                    None::<()>
                });
                assert_eq!(found, None);
                let mut visited = visited.into_inner();
                visited.sort_unstable();
                assert!(visited.is_sorted_by(|one, next| one < next), "{visited:?}");
                let is_near = |&&i: &&u32| {
                    let apart = (0..3).map(|k| positions[i as usize][k] - center[k]);
                    apart.map(|x| x * x).sum::<f64>() <= radius * radius
                };
                let near: Vec<u32> = numbers.iter().filter(is_near).copied().collect();
                assert!(near.iter().all(|i| visited.binary_search(i).is_ok()), "{near:?}");
                assert!(visited.iter().all(|i| numbers.contains(i)));
                if sides[2] > 0 {
                    within += near.len();
                    visited_in_all += visited.len();
                    points_in_all += numbers.len();
                }
            }
        }
        assert!(within > 3000, "{within}");
        assert!(visited_in_all < points_in_all / 5, "{visited_in_all} of {points_in_all}");
    }
}
