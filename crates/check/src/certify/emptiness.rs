//! Points near a position, and whether spheres are empty.

use std::cell::RefCell;

use rayon::prelude::*;

use super::structure::Points;
use crate::Alpha;
use crate::exact::{RoundedSphere, Side, WeightedPoint, in_conflict, orientation, side};
use crate::index::starts;

/// Answers whether a sphere is empty by testing all points nearby.
///
/// A point of weight ω inside a sphere of squared radius R² ≤ α is less than √(α + ω) away from
/// its centre, and a vertex of weight ω at most as far. So it is enough to test the points within
/// √(R² + largest ω) of the centre; where doubles cannot locate the centre, those within
/// 2 √(α + largest ω) of a vertex.
///
/// On a torus a sphere that is not empty holds a point no further from a vertex than the diagonal of the box. Where half of
/// that is less, it takes the place of √(α + largest ω).
pub(super) struct Emptiness<'a> {
    points: Points<'a>,
    grid: Grid,
    /// The points in the order of the grid, so that those of a box are beside each other.
    sites: Vec<WeightedPoint>,
    heaviest: f64,
    /// √(α + largest ω), or the bound on a torus, rounded up; zero when nothing can be inside.
    reach: f64,
}

impl<'a> Emptiness<'a> {
    /// For spheres of squared radius up to `alpha`; `kept` is, for each point, the one kept at its position.
    /// If any point is inside a sphere, one within 2 `largest` of its simplex's first vertex must be, and otherwise all
    /// points on it must be there; in space that is ∞.
    pub(super) fn new(points: Points<'a>, alpha: Alpha, largest: f64, kept: &[u32]) -> Self {
        let heaviest = points.weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sites = (0..points.len() as u32).filter(|&i| kept[i as usize] == i).collect();
        let reach = (alpha.squared() + heaviest).next_up().max(0.0).sqrt().next_up().min(largest);
        let grid = Grid::new(points.positions, sites);
        let sites = grid.points.par_iter().map(|&i| points.get(i)).collect();
        Self { points, grid, sites, heaviest, reach }
    }

    /// A point that refutes a cell whose squared radius is at most α: one strictly inside its sphere, or
    /// else one on it, by the perturbation.
    pub(super) fn refuter_of_cell(&self, cell: [u32; 4]) -> Option<u32> {
        let perturbed = self.perturbed_refuter(cell)?;
        let corners = self.points.corners(cell);
        match side(corners.each_ref(), &self.points.get(perturbed)) {
            Side::On => self.refuter(cell).or(Some(perturbed)),
            _ => Some(perturbed),
        }
    }

    fn perturbed_refuter(&self, cell: [u32; 4]) -> Option<u32> {
        let corners = self.points.corners(cell);
        let [a, b, c, d] = corners.each_ref();
        // Another rule reports negatively oriented cells.
        let order = orientation(a.position, b.position, c.position, d.position);
        let positive = if order.is_gt() { [a, b, c, d] } else { [a, b, d, c] };
        self.find(cell, |q, _| in_conflict(positive, q))
    }

    /// A point strictly inside the smallest orthogonal sphere of a simplex, whose squared radius
    /// is at most α.
    pub(super) fn refuter<const N: usize>(&self, simplex: [u32; N]) -> Option<u32> {
        let corners = self.points.corners(simplex);
        self.find(simplex, |q, _| side(corners.each_ref(), q) == Side::Inside)
    }

    /// All points on the smallest orthogonal sphere of a simplex, its corners included, ascending; the
    /// squared radius is at most α.
    pub(super) fn on_sphere<const N: usize>(&self, simplex: [u32; N]) -> Vec<u32> {
        let corners = self.points.corners(simplex);
        let on = RefCell::new(simplex.to_vec());
        self.find(simplex, |q, index| {
            if side(corners.each_ref(), q) == Side::On {
                on.borrow_mut().push(index);
            }
            false
        });
        let mut on = on.into_inner();
        on.sort_unstable();
        on
    }

    /// Whether no other point is inside or on the sphere of a point alone.
    pub(super) fn alone(&self, point: u32) -> bool {
        let site = self.points.get(point);
        // |q − p|² ≤ ω of q − ω of p, whatever α is.
        let reach = (self.heaviest - site.weight).next_up().max(0.0).sqrt().next_up();
        let near = |slot: usize, index: u32| {
            let within = index != point && side([&site], &self.sites[slot]) != Side::Outside;
            within.then_some(())
        };
        self.grid.within(site.position, reach, near).is_none()
    }

    fn find<const N: usize>(
        &self,
        simplex: [u32; N],
        refutes: impl Fn(&WeightedPoint, u32) -> bool,
    ) -> Option<u32> {
        let corners = self.points.corners(simplex);
        let sphere = RoundedSphere::new(corners.each_ref());
        let around = (corners[0].position, 2.0 * self.reach);
        let near = sphere.as_ref().map(|sphere| (sphere.center, sphere.reach(self.heaviest)));
        let (center, radius) = near.filter(|(_, radius)| *radius <= around.1).unwrap_or(around);
        self.grid.within(center, radius.next_up(), |slot, index| {
            let q = &self.sites[slot];
            let outside = sphere.as_ref().is_some_and(|sphere| sphere.surely_outside(q));
            (!outside && !simplex.contains(&index) && refutes(q, index)).then_some(index)
        })
    }
}

/// Points sorted into the boxes of a uniform grid.
pub(super) struct Grid {
    low: [f64; 3],
    step: f64,
    counts: [usize; 3],
    /// Where the points of each box start; x varies fastest.
    starts: Vec<u32>,
    points: Vec<u32>,
}

impl Grid {
    /// Sorts points into about as many boxes as there are points.
    pub(super) fn new(positions: &[[f64; 3]], points: Vec<u32>) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for &i in &points {
            for k in 0..3 {
                low[k] = low[k].min(positions[i as usize][k]);
                high[k] = high[k].max(positions[i as usize][k]);
            }
        }
        let extent: [f64; 3] = std::array::from_fn(|k| high[k] - low[k]);
        let longest = extent.iter().copied().fold(0.0, f64::max);
        let boxes = |step: f64| extent.map(|e| (e / step) as usize + 1);
        let (mut step, mut counts) = (f64::INFINITY, [1; 3]);
        if longest > 0.0 && longest.is_finite() {
            // Halving the step until the boxes outnumber the points; flat sets have flat grids.
            step = longest;
            counts = boxes(step);
            while step > f64::MIN_POSITIVE {
                let finer = boxes(step / 2.0);
                if finer.iter().product::<usize>() > 2 * points.len() {
                    break;
                }
                (step, counts) = (step / 2.0, finer);
            }
        }
        let mut grid = Self { low, step, counts, starts: Vec::new(), points: Vec::new() };
        let boxes = counts.iter().product::<usize>();
        let number = |&i: &u32| grid.number(grid.at(positions[i as usize])) as u32;
        let starts = starts(points.iter().map(number), boxes);
        let mut next = starts.clone();
        let mut sorted = vec![0; points.len()];
        for &i in &points {
            let slot = &mut next[number(&i) as usize];
            sorted[*slot as usize] = i;
            *slot += 1;
        }
        (grid.starts, grid.points) = (starts, sorted);
        grid
    }

    /// Calls `visit` with every point within `radius` of `center`, and some beyond, until it
    /// returns a value: with its place in the order of the grid, and its number.
    pub(super) fn within<T>(
        &self,
        center: [f64; 3],
        radius: f64,
        visit: impl Fn(usize, u32) -> Option<T>,
    ) -> Option<T> {
        // Rounding is monotonic, so a point between two positions is in a box between theirs.
        let from = self.at(center.map(|x| (x - radius).next_down()));
        let to = self.at(center.map(|x| (x + radius).next_up()));
        for z in from[2]..=to[2] {
            for y in from[1]..=to[1] {
                let first = self.number([from[0], y, z]);
                let last = self.number([to[0], y, z]);
                let row = self.starts[first] as usize..self.starts[last + 1] as usize;
                if let Some(found) = row.into_iter().find_map(|slot| visit(slot, self.points[slot]))
                {
                    return Some(found);
                }
            }
        }
        None
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
                (from[1]..=to[1]).find_map(|y| {
                    let first = self.number([from[0], y, z]);
                    let last = self.number([to[0], y, z]);
                    self.points[self.starts[first] as usize..self.starts[last + 1] as usize]
                        .first()
                        .copied()
                })
            })
        })
    }

    fn at(&self, position: [f64; 3]) -> [usize; 3] {
        std::array::from_fn(|k| {
            // The cast turns negative numbers, and the NaN of an infinite box, into 0.
            (((position[k] - self.low[k]) / self.step) as usize).min(self.counts[k] - 1)
        })
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }
}
