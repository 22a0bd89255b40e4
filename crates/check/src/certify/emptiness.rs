//! Points near a position, and whether spheres are empty.

use std::cell::RefCell;

use super::grid::Grid;
use super::structure::Points;
use crate::Alpha;
use crate::exact::{RoundedSphere, Side, WeightedPoint, in_conflict, orientation, side};

/// Answers whether a sphere is empty by testing all points nearby.
///
/// A point of weight ω inside a sphere of squared radius R² ≤ α is less than √(α + ω) away from its centre, and a vertex of
/// weight ω is at most as far away. So in a layer of points, of which the heaviest has ω, it is enough to test the points within
/// √(R² + ω) of the centre; if doubles cannot locate the centre, the points within √(α + ω) + √(α + largest ω) of a vertex.
///
/// On a torus, a sphere that is not empty contains a point no farther from a vertex than the diagonal of the box. If the diagonal
/// is less than the latter sum, it replaces that sum.
pub(super) struct Emptiness<'a> {
    points: Points<'a>,
    /// Few points are much heavier than the others, but one of them would require testing all points far around a sphere.
    layers: Vec<Layer>,
}

/// Points of similar weight.
struct Layer {
    grid: Grid,
    heaviest: f64,
    /// The distance from a vertex within which all points inside a sphere are, rounded up.
    around: f64,
}

impl<'a> Emptiness<'a> {
    /// Creates the test for spheres of squared radius up to `alpha`; only the points `tested` are searched for. If any point is
    /// inside a sphere, one point inside must be within 2 `largest` of the first vertex of its simplex; otherwise all points on
    /// the sphere must be there. In space `largest` is ∞.
    pub(super) fn new(points: Points<'a>, alpha: Alpha, largest: f64, tested: Vec<u32>) -> Self {
        let heaviest = |numbers: &mut dyn Iterator<Item = u32>| {
            numbers.map(|i| points.weight(i)).fold(f64::NEG_INFINITY, f64::max)
        };
        let reach =
            |heaviest: f64| (alpha.squared() + heaviest).next_up().max(0.0).sqrt().next_up();
        let of_vertices = reach(heaviest(&mut (0..points.len() as u32)));
        let layer = |tested: Vec<u32>| {
            let heaviest = heaviest(&mut tested.iter().copied());
            let grid = Grid::new(points, tested);
            let around = (reach(heaviest) + of_vertices).next_up().min(2.0 * largest);
            Layer { grid, heaviest, around }
        };
        Self { points, layers: layers(points, tested).into_iter().map(layer).collect() }
    }

    /// The points that are tested.
    pub(super) fn tested(&self) -> impl Iterator<Item = u32> {
        self.layers.iter().flat_map(|layer| layer.grid.points()).copied()
    }

    /// A point that refutes a cell whose squared radius is at most α: a point strictly inside its sphere, or otherwise a point on
    /// it, by the perturbation.
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

    /// All points on the smallest orthogonal sphere of a simplex, including its corners, ascending. The squared radius must be at
    /// most α.
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

    fn find<const N: usize>(
        &self,
        simplex: [u32; N],
        refutes: impl Fn(&WeightedPoint, u32) -> bool,
    ) -> Option<u32> {
        let corners = self.points.corners(simplex);
        let sphere = RoundedSphere::new(corners.each_ref());
        self.layers.iter().find_map(|layer| {
            let around = (corners[0].position, layer.around);
            let near = sphere.as_ref().map(|sphere| (sphere.center, sphere.reach(layer.heaviest)));
            let (center, radius) = near.filter(|(_, radius)| *radius <= around.1).unwrap_or(around);
            layer.grid.within(center, radius.next_up(), |index| {
                let q = &self.points.get(index);
                let outside = sphere.as_ref().is_some_and(|sphere| sphere.surely_outside(q));
                (!outside && !simplex.contains(&index) && refutes(q, index)).then_some(index)
            })
        })
    }
}

/// At most one of this many points goes into a heavier layer.
const HEAVY: usize = 64;

/// Points in layers of similar weight. The heaviest few form a separate layer as long as their weights span more than those of
/// the others.
pub(super) fn layers(points: Points, mut sites: Vec<u32>) -> Vec<Vec<u32>> {
    let weight = |&i: &u32| points.weight(i);
    let mut layers = Vec::new();
    loop {
        let mut weights: Vec<f64> = sites.iter().map(weight).collect();
        let lightest = weights.iter().copied().fold(f64::INFINITY, f64::min);
        let heaviest = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let few = weights.len() / HEAVY;
        let most = weights.len() - few;
        let split = (few > 0).then(|| *weights.select_nth_unstable_by(most, f64::total_cmp).1);
        let Some(split) = split.filter(|split| heaviest - split > split - lightest) else { break };
        let (heavy, light) = sites.into_iter().partition(|i| weight(i) > split);
        layers.push(light);
        sites = heavy;
    }
    layers.push(sites);
    layers
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;
    use crate::exact::radius;

    /// Points with weights of which few are large, and some very large.
    fn points(random: &mut Random) -> Vec<WeightedPoint> {
        let draw = |_| WeightedPoint {
            position: [0; 3].map(|_| random.whole(0, 30)),
            weight: match random.below(200) {
                0 => random.whole(200, 300),
                1..3 => random.whole(20, 40),
                _ => random.whole(-1, 2),
            },
        };
        (0..700).map(draw).collect()
    }

    #[test]
    fn heavy_points_are_in_layers_of_their_own() {
        let sites = points(&mut Random::new(1));
        let points = Points { sites: &sites };
        let layers = layers(points, (0..700).collect());
        assert!(layers.len() > 1, "{}", layers.len());
        let mut all = layers.concat();
        all.sort_unstable();
        assert_eq!(all, (0..700).collect::<Vec<u32>>());
        let heaviest = |layer: &[u32]| layer.iter().map(|&i| points.weight(i)).fold(-1.0, f64::max);
        let lightest = |layer: &[u32]| layer.iter().map(|&i| points.weight(i)).fold(1e9, f64::min);
        for pair in layers.windows(2) {
            assert!(heaviest(&pair[0]) < lightest(&pair[1]));
        }
        let alike: Vec<_> =
            sites.iter().map(|site| WeightedPoint { weight: 5.0, ..*site }).collect();
        assert_eq!(super::layers(Points { sites: &alike }, (0..700).collect()).len(), 1);
    }

    /// Whether any point is inside a sphere, and which points are on it, are the same as in a test of all points.
    #[test]
    fn spheres_are_searched_to_the_last_point() {
        let mut random = Random::new(2);
        let (mut empty, mut full, mut further) = (0, 0, 0);
        for _ in 0..20 {
            let sites = points(&mut random);
            let points = Points { sites: &sites };
            let alpha = Alpha::from_squared(random.whole(0, 40)).unwrap();
            let emptiness = Emptiness::new(points, alpha, f64::INFINITY, (0..700).collect());
            for _ in 0..2000 {
                let mut simplex = [0u32; 3].map(|_| random.below(700) as u32);
                // Points near each other, for there to be small spheres.
                let near = |v: &u32| {
                    let [p, q] = [simplex[0], *v].map(|v| points.position(v));
                    (0..3).map(|k| (p[k] - q[k]).abs()).fold(0.0, f64::max)
                };
                let mut all: Vec<u32> = (0..700).collect();
                all.sort_by(|a, b| near(a).total_cmp(&near(b)));
                (simplex[1], simplex[2]) = (all[1 + random.below(3)], all[4 + random.below(3)]);
                let corners = points.corners(simplex);
                let [a, b, c] = corners.each_ref();
                if crate::exact::collinear(a.position, b.position, c.position)
                    || radius([a, b, c], alpha).is_gt()
                {
                    continue;
                }
                let at = |which: Side| -> Vec<u32> {
                    (0..700).filter(|&q| side([a, b, c], &points.get(q)) == which).collect()
                };
                let inside = at(Side::Inside);
                match emptiness.refuter(simplex) {
                    Some(refuter) => assert!(inside.contains(&refuter)),
                    None => assert_eq!(inside, [0; 0], "{simplex:?}"),
                }
                let on = at(Side::On);
                assert_eq!(emptiness.on_sphere(simplex), on);
                empty += usize::from(inside.is_empty());
                full += usize::from(!inside.is_empty());
                further += usize::from(on.len() > 3);
            }
        }
        assert!(empty > 200 && full > 200 && further > 20, "{empty} {full} {further}");
    }
}
