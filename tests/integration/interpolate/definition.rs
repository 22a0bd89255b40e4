//! Values against the definition of F, simplex by simplex.

use proptest::prelude::*;
use walpha::interpolate::{Grid, Interpolant};
use walpha::{AlphaShape, Class, Dims};

use super::{Place, cross, dot, lattice, linear, minus, points, shape, wild};

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn samples_belong_as_definition_says((places, weights) in lattice(), alpha in 0..24i32) {
        let shape = shape(points(places, weights, wild), f64::from(alpha) / 4.0);
        let interpolant = Interpolant::new(&shape).unwrap();
        let grid = Grid::spanning([-0.5; 3], [5.0; 3], Dims::new(12, 12, 12).unwrap());
        let resampled = interpolant.resample(&grid).unwrap();
        for sample in 0..12 * 12 * 12 {
            let index = [sample % 12, sample / 12 % 12, sample / 144];
            let place = grid.position(index);
            let expected = by_definition(&shape, place);
            prop_assert_eq!(resampled.is_inside(sample), expected.is_some(), "{:?}", place);
            let ours = resampled.volume().as_slice()[sample];
            prop_assert!((f64::from(ours) - expected.unwrap_or(0.0)).abs() < 1e-4, "{:?}", place);
            // Another way to find the simplex, the same bits.
            let alone = interpolant.value_at(place);
            prop_assert_eq!(alone.is_some(), expected.is_some());
            prop_assert_eq!((alone.unwrap_or(0.0) as f32).to_bits(), ours.to_bits());
            if let (Some(alone), Some(expected)) = (alone, expected) {
                prop_assert!((alone - expected).abs() < 1e-11);
            }
        }
    }
}

/// F where coordinates are multiples of a half: determinants are exact in doubles then.
fn by_definition(shape: &AlphaShape, place: Place) -> Option<f64> {
    let complex = shape.complex();
    let values = shape.points().values.as_ref().unwrap();
    let corner = |v: u32| minus(shape.points().positions[v as usize], place);
    let sum = |row: &[u32], parts: &[f64]| {
        let whole: f64 = parts.iter().sum();
        let inside = parts.iter().all(|&part| part >= 0.0);
        let term = |(&v, part): (&u32, &f64)| values[v as usize] * part;
        inside.then(|| row.iter().zip(parts).map(term).sum::<f64>() / whole)
    };
    let cell = |row: &[u32; 4]| {
        let [a, b, c, d] = row.map(corner);
        let det = |u, v, w| dot(u, cross(v, w));
        sum(row, &[det(b, c, d), -det(a, c, d), det(a, b, d), -det(a, b, c)])
    };
    let facet = |row: &[u32; 3]| {
        let [a, b, c] = row.map(corner);
        let normal = cross(minus(b, a), minus(c, a));
        let parts = [cross(b, c), cross(c, a), cross(a, b)].map(|part| dot(normal, part));
        (dot(normal, a) == 0.0).then(|| sum(row, &parts))?
    };
    let edge = |row: &[u32; 2]| {
        let [a, b] = row.map(corner);
        let along = minus(b, a);
        (cross(a, b) == [0.0; 3]).then(|| sum(row, &[dot(along, b), -dot(along, a)]))?
    };
    let vertex = |row: &[u32; 1]| (corner(row[0]) == [0.0; 3]).then(|| values[row[0] as usize]);
    (complex.cells.of(Class::Interior).find_map(cell))
        .or_else(|| complex.facets.of(Class::Singular).find_map(facet))
        .or_else(|| complex.edges.of(Class::Singular).find_map(edge))
        .or_else(|| complex.vertices.of(Class::Singular).find_map(vertex))
}

#[test]
fn thin_parts_of_a_shape_have_values() {
    // A triangle, an edge and a point far from one another; the rest is a cell.
    let places = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [20.0, 0.0, 0.0],
        [22.0, 0.0, 0.0],
        [20.0, 2.0, 0.0],
        [0.0, 30.0, 0.0],
        [0.0, 32.0, 0.0],
        [0.0, 0.0, 50.0],
    ];
    let shape = shape(points(places.into(), vec![0.0; 10], linear), 2.0);
    let interpolant = Interpolant::new(&shape).unwrap();
    let value = |place| interpolant.value_at(place);
    let at = |place| interpolant.locate(place).map(|at| at.simplex.len());
    for (place, vertices) in [
        ([0.25, 0.25, 0.25], 4),
        ([20.5, 0.5, 0.0], 3),
        ([0.0, 30.5, 0.0], 2),
        ([0.0, 0.0, 50.0], 1),
    ] {
        assert_eq!((at(place), value(place)), (Some(vertices), Some(linear(place))));
    }
    for outside in [[20.5, 0.5, 1e-9], [0.0, 29.0, 0.0], [1e-9, 0.0, 50.0], [f64::NAN, 0.0, 0.0]] {
        assert_eq!(value(outside), None);
    }
}
