//! Whether a surface is the convex hull, from its definition alone.

use walpha_base::vector::{cross, dot, sub};

use crate::shape::{AlphaShape, Class};

/// A closed surface and the points it should be the hull of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hull {
    /// Its facets.
    pub facets: usize,
    /// Points on the wrong side of a facet: none if the surface is convex and holds all points.
    pub outside: usize,
    /// The volume that the facets enclose (divergence theorem), not the sum of the cells.
    pub volume: f64,
}

impl Hull {
    /// Judges the regular facets of a shape. Each point is held against each plane; signs are
    /// exact for coordinates that are whole numbers below 10⁵, as those of voxels are.
    pub(super) fn of(shape: &AlphaShape) -> Self {
        let positions = &shape.points().positions;
        let mut planes: Vec<([f64; 3], f64)> = Vec::new();
        let mut sixfold = 0.0;
        for facet in shape.complex().facets.of(Class::Regular) {
            let [a, b, c] = facet.map(|v| positions[v as usize]);
            let normal = cross(sub(b, a), sub(c, a));
            sixfold += dot(normal, a);
            planes.push((normal, dot(normal, a)));
        }
        let beyond = |p: &&[f64; 3]| planes.iter().any(|&(normal, at)| dot(normal, **p) > at);
        let outside = positions.iter().filter(beyond).count();
        Self { facets: planes.len(), outside, volume: sixfold / 6.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::WeightedPoints;
    use crate::shape::{Alpha, ShapeOptions, alpha_shape};

    /// Arms two squares wide around a notch of two by two, one cube high.
    #[test]
    fn an_l_is_not_its_hull() {
        let lattice = (0..32).map(|i| [i % 4, i / 4 % 4, i / 16]);
        let positions: Vec<_> =
            lattice.filter(|p| p[0] < 2 || p[1] < 2).map(|p| p.map(f64::from)).collect();
        let weights = vec![0.0; positions.len()];
        let points = WeightedPoints { positions, weights, values: None };
        let at = |alpha| {
            let options = ShapeOptions::new(alpha);
            Hull::of(&alpha_shape(points.clone(), &options).unwrap())
        };
        let hull = at(Alpha::INFINITE);
        assert_eq!((hull.outside, hull.volume), (0, 7.0));
        // Five cubes, and half of the one in the inner corner.
        let shape = at(Alpha::from_squared(0.75).unwrap());
        assert_eq!(shape.volume, 5.5);
        assert!(shape.outside > 0);
    }
}
