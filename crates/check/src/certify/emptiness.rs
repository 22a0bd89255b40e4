use std::cell::RefCell;

use super::Points;
use super::near::Grid;
use crate::Alpha;
use crate::exact::{RoundedSphere, Side, WeightedPoint, in_conflict, orientation, side};

/// Answers whether a sphere is empty by testing all points nearby.
///
/// A point of weight ω inside a sphere of squared radius R² ≤ α is less than √(α + ω) away from
/// its centre, and a vertex of weight ω at most as far. So it is enough to test the points within
/// √(α + largest ω) of the centre; where doubles cannot locate the centre, those within twice
/// that distance of a vertex.
pub(super) struct Emptiness<'a> {
    points: Points<'a>,
    grid: Grid,
    heaviest: f64,
    /// √(α + largest ω), rounded up; zero when nothing can be inside.
    reach: f64,
}

impl<'a> Emptiness<'a> {
    /// For spheres of squared radius up to `alpha`; `kept` is, for each point, the one kept at its position.
    pub(super) fn new(points: Points<'a>, alpha: Alpha, kept: &[u32]) -> Self {
        let heaviest = points.weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sites = (0..points.len() as u32).filter(|&i| kept[i as usize] == i).collect();
        let reach = (alpha.squared() + heaviest).next_up().max(0.0).sqrt().next_up();
        Self { points, grid: Grid::new(points.positions, sites), heaviest, reach }
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
        let near = |index: u32| {
            let within = index != point && side([&site], &self.points.get(index)) != Side::Outside;
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
        let sphere =
            RoundedSphere::new(corners.each_ref()).filter(|sphere| sphere.error < self.reach);
        let (center, radius) = match &sphere {
            Some(sphere) => (sphere.center, self.reach + sphere.error),
            None => (corners[0].position, 2.0 * self.reach),
        };
        self.grid.within(center, radius.next_up(), |index| {
            let q = self.points.get(index);
            let outside = sphere.as_ref().is_some_and(|sphere| sphere.surely_outside(&q));
            (!outside && !simplex.contains(&index) && refutes(&q, index)).then_some(index)
        })
    }
}
