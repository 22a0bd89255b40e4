//! Measures the differences of two shapes or pictures.

use std::collections::BTreeSet;

use crate::render::Picture;
use crate::shape::{AlphaShape, Class, Complex, Simplices};

/// Simplices that two shapes over the same points do not share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Difference {
    /// Cells in only one of them.
    pub cells: usize,
    /// Boundary facets, regular or singular, in only one of them.
    pub boundary: usize,
}

impl Difference {
    pub(super) fn between(a: &Complex, b: &Complex) -> Self {
        let boundary = [Class::Regular, Class::Singular];
        Self {
            cells: not_shared(&a.cells, &b.cells, &[Class::Interior]),
            boundary: not_shared(&a.facets, &b.facets, &boundary),
        }
    }
}

/// Number of rows of these classes that are in only one of the lists. Both lists ascend.
fn not_shared<const N: usize>(a: &Simplices<N>, b: &Simplices<N>, classes: &[Class]) -> usize {
    let rows = |list: &Simplices<N>| -> Vec<([u32; N], Class)> {
        let rows = list.iter().filter(|(_, class)| classes.contains(class));
        rows.map(|(&row, class)| (row, class)).collect()
    };
    let (a, b) = (rows(a), rows(b));
    let shared = a.iter().filter(|row| b.binary_search(row).is_ok()).count();
    a.len() + b.len() - 2 * shared
}

/// Whether two shapes over the same lattice points are the same set in space, however their
/// boundaries are cut into triangles.
///
/// The eight corners of a voxel lie on one sphere, so the least change of weights may cut a square
/// of the boundary along its other diagonal. In each plane of the boundary the edges that its
/// triangles share cancel, and what is left is the outline of the part of the plane that belongs
/// to the boundary: equal outlines, equal sets. Exact for coordinates that are whole numbers below
/// 10⁵. A point that splits an edge of the outline in only one shape makes the outlines differ: `true` is
/// always right, `false` may not be.
pub(super) fn same_set(a: &AlphaShape, b: &AlphaShape) -> bool {
    let singular = |shape: &AlphaShape| {
        let complex = shape.complex();
        let edges: Vec<[u32; 2]> = complex.edges.of(Class::Singular).copied().collect();
        let vertices: Vec<[u32; 1]> = complex.vertices.of(Class::Singular).copied().collect();
        (edges, vertices)
    };
    let both = [Class::Regular, Class::Singular];
    both.iter().all(|&class| outlines(a, class) == outlines(b, class)) && singular(a) == singular(b)
}

/// A plane by its primitive normal and its offset along it.
type Plane = ([i64; 3], i64);

/// In each plane of the boundary, the edges that are on an odd number of its facets. Planes of regular facets have an outer side,
/// those of singular facets do not.
fn outlines(shape: &AlphaShape, class: Class) -> BTreeSet<(Plane, [u32; 2])> {
    let positions = shape.points().positions();
    let mut odd = BTreeSet::new();
    for &facet in shape.complex().facets.of(class) {
        let corners = facet.map(|v| positions[v as usize].map(|c| c as i64));
        let plane = plane(corners, class == Class::Regular);
        for k in 0..3 {
            let [p, q] = [facet[k], facet[(k + 1) % 3]];
            let edge = (plane, [p.min(q), p.max(q)]);
            if !odd.remove(&edge) {
                odd.insert(edge);
            }
        }
    }
    odd
}

fn plane([a, b, c]: [[i64; 3]; 3], oriented: bool) -> Plane {
    let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    let mut normal =
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let mut divisor = normal.iter().fold(0, |d, &n| gcd(d, n.abs()));
    if !oriented && normal.iter().find(|&&n| n != 0).is_some_and(|&n| n < 0) {
        divisor = -divisor;
    }
    normal = normal.map(|n| n / divisor);
    (normal, normal[0] * a[0] + normal[1] * a[1] + normal[2] * a[2])
}

fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The differences of two pictures of the same size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PixelDifference {
    /// Pixels that are not the same.
    pub pixels: usize,
    /// The largest difference in a colour channel, of 255.
    pub largest: u8,
}

impl PixelDifference {
    pub(super) fn between(a: &Picture, b: &Picture) -> Self {
        let pairs = a.pixels().iter().zip(b.pixels());
        pairs.filter(|(a, b)| a != b).fold(Self::default(), |difference, (a, b)| {
            let largest = (0..4).map(|k| a[k].abs_diff(b[k])).max().unwrap_or(0);
            Self { pixels: difference.pixels + 1, largest: difference.largest.max(largest) }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::WeightedPoints;
    use crate::shape::{Alpha, ShapeOptions, alpha_shape};

    fn simplices(rows: &[([u32; 3], Class)]) -> Simplices<3> {
        rows.iter().copied().collect()
    }

    #[test]
    fn rows_and_classes_must_both_agree() {
        use Class::{Interior, Regular, Singular};
        let a = simplices(&[([0, 1, 2], Regular), ([0, 2, 3], Regular), ([1, 2, 3], Interior)]);
        let b = simplices(&[([0, 1, 2], Singular), ([0, 2, 3], Regular), ([1, 2, 4], Regular)]);
        assert_eq!(not_shared(&a, &b, &[Regular, Singular]), 3);
        assert_eq!(not_shared(&a, &a, &[Regular, Singular]), 0);
        assert_eq!(not_shared(&a, &b, &[Interior]), 1);
    }

    /// Cubes whose corner 0 weighs a little more or less: each square there has its diagonal to it
    /// or away from it.
    #[test]
    fn other_diagonals_are_the_same_set() {
        let shape = |weight: f64, alpha: f64| {
            let positions: Vec<_> =
                (0..12).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect();
            let mut weights = vec![0.0; positions.len()];
            weights[0] = weight;
            let points = WeightedPoints::new(positions, weights).unwrap();
            let options = ShapeOptions::new(Alpha::from_squared(alpha).unwrap());
            alpha_shape(points, &options).unwrap()
        };
        let (heavy, light) = (shape(0.01, 1.0), shape(-0.01, 1.0));
        assert!(Difference::between(heavy.complex(), light.complex()).boundary > 0);
        assert!(same_set(&heavy, &light));
        // The heavy corner's cube is cut into cells of squared radius 0.745; of the light one's
        // only the corner itself is.
        let (heavy, light) = (shape(0.01, 0.747), shape(-0.01, 0.747));
        assert!((heavy.measures().volume - 1.0).abs() < 1e-9, "{:?}", heavy.measures());
        assert!((light.measures().volume - 1.0 / 6.0).abs() < 1e-9, "{:?}", light.measures());
        assert!(!same_set(&heavy, &light));
    }
}
