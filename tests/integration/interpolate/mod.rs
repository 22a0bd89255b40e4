//! The interpolant against its definition by brute force, and its laws.

mod command;

use ndarray::Array3;
use proptest::prelude::*;
use walpha::interpolate::{Deviation, Grid, Interpolant, InterpolateError, fill};
use walpha::points::{difference, select, weigh};
use walpha::shape::ShapeOptions;
use walpha::{
    Alpha, AlphaShape, Class, Coordinates, Dims, Frame, Selection, SelectionRule, Units, Volume,
    WeightedPoints, Weighting, alpha_shape, volume,
};

use crate::common::spans_a_volume;

type Place = [f64; 3];

fn phantom(size: u64) -> Volume {
    volume::phantom(size).unwrap()
}

fn points(positions: Vec<Place>, weights: Vec<f64>, f: impl Fn(Place) -> f64) -> WeightedPoints {
    let values: Vec<f64> = positions.iter().map(|&p| f(p)).collect();
    WeightedPoints::new(positions, weights).unwrap().with_values(values).unwrap()
}

fn shape(points: WeightedPoints, alpha: f64) -> AlphaShape {
    alpha_shape(points, &ShapeOptions::new(Alpha::from_squared(alpha).unwrap())).unwrap()
}

fn linear([x, y, z]: Place) -> f64 {
    0.75 * x - 2.5 * y + 1.25 * z + 3.0
}

/// Anything but linear, and of many digits.
fn wild([x, y, z]: Place) -> f64 {
    100.0 * (1.3 * x + 0.7).sin() * (0.9 * y - 0.2).cos() + 10.0 * (z * z + x * x + 1.0).sqrt()
}

/// Lattice points, not all in one plane: ties everywhere. Weights, now and then.
fn lattice() -> impl Strategy<Value = (Vec<Place>, Vec<f64>)> {
    let site = ([0..5, 0..5, 0..5i32], prop_oneof![3 => Just(0), 1 => 0..6i32]);
    let sites = prop::collection::vec(site, 5..40).prop_map(|sites| {
        sites.iter().map(|&(p, w)| (p.map(f64::from), f64::from(w) / 2.0)).unzip()
    });
    sites.prop_filter("in one plane", |(places, _): &(Vec<Place>, _)| spans_a_volume(places))
}

fn anywhere() -> impl Strategy<Value = Vec<Place>> {
    let places = prop::collection::vec([-4.0..4.0f64, -4.0..4.0, -4.0..4.0], 5..40);
    places.prop_filter("in one plane", |places| spans_a_volume(places))
}

/// The samples of largest difference, unweighted.
fn phantom_points(volume: &Volume, count: u64) -> WeightedPoints {
    let selection = Selection::default().rule(SelectionRule::Count(count));
    let points = select(volume, volume, &difference(volume), &selection, Units::Voxel).unwrap();
    weigh(points, Weighting::Common(0.0), Alpha::from_squared(1.0).unwrap()).unwrap()
}

fn minus(a: Place, b: Place) -> Place {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: Place, b: Place) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Place, b: Place) -> Place {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[test]
fn what_has_no_values_has_no_interpolant() {
    let places: Vec<Place> = phantom_points(&phantom(8), 60).into_parts().0;
    let points = points(places, vec![0.0; 60], linear);
    let made = shape(points.clone(), 10.0);
    let mut values = vec![0.0; 60];
    values[7] = f64::NAN;
    let error = Interpolant::with_values(&made, &values).unwrap_err();
    assert!(matches!(error, InterpolateError::Value { index: 7, .. }), "{error}");
    let points = points.with_values(None).unwrap();
    let error = Interpolant::new(&shape(points, 10.0)).unwrap_err();
    assert!(matches!(error, InterpolateError::NoValues), "{error}");
}

/// In a tilted frame the coordinates of samples are rounded: many on the sides of the volume are therefore outside of the hull of
/// its corners, and would have no value.
#[test]
fn samples_of_tilted_and_mirrored_volumes_are_located_by_index() {
    for mirror in [1.0, -1.0] {
        let frame = Frame {
            origin: [-3.7, 14.1, 0.3],
            spacing: [0.4883, 0.4883, 0.625],
            direction: [[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, mirror]],
            coordinates: Coordinates::default(),
        };
        let volume = phantom(12).with_frame(frame);
        let selection = Selection::default().rule(SelectionRule::Count(150));
        let points = select(&volume, &volume, &difference(&volume), &selection, Units::World);
        let alpha = Alpha::from_squared(1.0).unwrap();
        let weighted = weigh(points.unwrap(), Weighting::Common(0.0), alpha).unwrap();
        let shape = shape(weighted, 1.0);
        let whole = fill(&shape, Some(&volume), Units::World).unwrap();
        let interpolant = Interpolant::new(&whole).unwrap();
        let grid = Grid::of(&volume, Units::World);
        let resampled = interpolant.resample(&grid).unwrap();
        assert_eq!(resampled.covered(), volume.dims().samples(), "mirrored: {mirror}");
        assert_eq!(resampled.volume().frame(), &frame);
        let mut alone = 0;
        for (sample, &ours) in resampled.volume().as_slice().iter().enumerate() {
            let place = grid.position([sample % 12, sample / 12 % 12, sample / 144]);
            if let Some(value) = interpolant.value_at(place) {
                assert!((value - f64::from(ours)).abs() < 1e-4, "{value}, {ours} at {place:?}");
                alone += 1;
            }
        }
        assert!((900..1728).contains(&alone), "{alone}");
        // Finer grids, too, and the sums around the points.
        let finer = Grid::over(&volume, Dims::new(23, 23, 23).unwrap(), Units::World).unwrap();
        assert_eq!(interpolant.resample(&finer).unwrap().covered(), 23 * 23 * 23);
        let local = interpolant.local_deviations(&volume, &grid, &resampled);
        let rmse = Deviation::of(&volume, &resampled).rmse.unwrap();
        assert!(local.iter().any(|&difference| difference > rmse) && local[..150].contains(&0.0));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn samples_belong_as_definition_says((places, weights) in lattice(), alpha in 0..24i32) {
        let shape = shape(points(places, weights, wild), f64::from(alpha) / 4.0);
        let interpolant = Interpolant::new(&shape).unwrap();
        let grid = Grid::spanning([-0.5; 3], [5.0; 3], Dims::new(12, 12, 12).unwrap()).unwrap();
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
    let values = shape.points().values().unwrap();
    let corner = |v: u32| minus(shape.points().positions()[v as usize], place);
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

/// The points of a simplex with these shares, rounded.
fn within(shape: &AlphaShape, simplex: &[u32], shares: [f64; 4]) -> Place {
    let whole: f64 = shares[..simplex.len()].iter().sum();
    [0, 1, 2].map(|k| {
        let at =
            |(&v, share): (&u32, &f64)| shape.points().positions()[v as usize][k] * share / whole;
        simplex.iter().zip(&shares).map(at).sum()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn linear_functions_are_exact_in_every_cell(
        (places, weights) in lattice(), floats in anywhere(), shares in [0.01..1.0f64, 0.01..1.0, 0.01..1.0, 0.01..1.0],
    ) {
        let zeros = vec![0.0; floats.len()];
        for points in [points(places, weights, linear), points(floats, zeros, linear)] {
            let shape = shape(points, f64::INFINITY);
            let interpolant = Interpolant::new(&shape).unwrap();
            for (cell, _) in shape.complex().cells.iter() {
                let place = within(&shape, cell, shares);
                let value = interpolant.value_at(place);
                let value = value.expect("well within a cell");
                prop_assert!((value - linear(place)).abs() < 1e-12 * 40.0, "{value} at {place:?}");
                for &vertex in cell {
                    let place = shape.points().positions()[vertex as usize];
                    let expected = shape.points().values().unwrap()[vertex as usize];
                    prop_assert_eq!(interpolant.value_at(place).map(f64::to_bits), Some(expected.to_bits()));
                }
            }
        }
    }

    #[test]
    fn it_is_continuous_across_faces(
        floats in anywhere(), shares in [0.1..1.0f64, 0.1..1.0, 0.1..1.0, 0.1..1.0],
        direction in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0],
    ) {
        const STEP: f64 = 1e-9;
        let zeros = vec![0.0; floats.len()];
        let shape = shape(points(floats, zeros, wild), f64::INFINITY);
        let interpolant = Interpolant::new(&shape).unwrap();
        let values = shape.points().values().unwrap();
        for facet in shape.complex().facets.of(Class::Interior) {
            let place = within(&shape, facet, shares);
            let whole: f64 = shares[..3].iter().sum();
            let expected: f64 =
                facet.iter().zip(shares).map(|(&v, s)| values[v as usize] * s / whole).sum();
            let there = interpolant.value_at(place).expect("inside the hull");
            let [before, after] = [-STEP, STEP].map(|step| {
                interpolant.value_at([0, 1, 2].map(|k| place[k] + step * direction[k]))
            });
            // Steps change F by its gradient, which is steep in a flat cell.
            let steepest = [before, after].map(|v| (v.expect("beside a place inside") - there).abs());
            let thickness = thinnest(&shape, facet);
            let bound = 1e-10 + 1e3 * STEP / thickness;
            for change in steepest.into_iter().chain([(there - expected).abs()]) {
                prop_assert!(change <= bound, "{change} at {place:?}, {bound}");
            }
        }
    }

    #[test]
    fn floats_on_any_grid_are_found_both_ways(floats in anywhere(), alpha in 1.0..9.0f64) {
        let zeros = vec![0.0; floats.len()];
        let shape = shape(points(floats, zeros, wild), alpha);
        let interpolant = Interpolant::new(&shape).unwrap();
        let turned = Frame {
            origin: [-3.7, -4.1, -3.3],
            spacing: [0.77, 0.5, 1.3],
            direction: [[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]],
            coordinates: Coordinates::default(),
        };
        let volume = Volume::new(Array3::zeros((7, 9, 8)), turned).unwrap();
        for dims in [[8, 9, 7], [5, 11, 3]] {
            let [x, y, z] = dims;
            let grid = Grid::over(&volume, Dims::new(x, y, z).unwrap(), Units::World).unwrap();
            let resampled = interpolant.resample(&grid).unwrap();
            let [nx, ny, nz] = grid.dims().xyz();
            let places: Vec<Place> = (0..nx * ny * nz)
                .map(|i| grid.position([i % nx, i / nx % ny, i / (nx * ny)]))
                .collect();
            for (i, value) in interpolant.values_at(&places).into_iter().enumerate() {
                prop_assert_eq!(value.is_some(), resampled.is_inside(i));
                prop_assert_eq!(value.unwrap_or(0.0) as f32, resampled.volume().as_slice()[i]);
            }
        }
    }

    #[test]
    fn order_of_points_means_nothing(
        (sites, order) in lattice().prop_flat_map(|(places, weights)| {
            let mut sites: Vec<(Place, f64)> = places.into_iter().zip(weights).collect();
            sites.sort_by(|a, b| a.partial_cmp(b).unwrap());
            sites.dedup_by_key(|site| site.0);
            let order = Just((0..sites.len()).collect::<Vec<_>>()).prop_shuffle();
            (Just(sites), order)
        }),
        alpha in 0..24i32,
    ) {
        let make = |sites: Vec<(Place, f64)>| {
            let (places, weights) = sites.into_iter().unzip();
            shape(points(places, weights, wild), f64::from(alpha) / 4.0)
        };
        let shuffled = order.iter().map(|&i| sites[i]).collect();
        let grid = Grid::spanning([0.0; 3], [4.0; 3], Dims::new(9, 9, 9).unwrap()).unwrap();
        let samples = |shape: AlphaShape| {
            Interpolant::new(&shape).unwrap().resample(&grid).unwrap().volume().clone()
        };
        prop_assert_eq!(samples(make(sites.clone())), samples(make(shuffled)));
    }
}

/// The least height of the cells on a facet.
fn thinnest(shape: &AlphaShape, facet: &[u32; 3]) -> f64 {
    let at = |v: u32| shape.points().positions()[v as usize];
    let on = |cell: &&[u32; 4]| facet.iter().all(|v| cell.contains(v));
    let heights = shape.complex().cells.rows().iter().filter(on).flat_map(|cell| {
        let [a, b, c, d] = cell.map(at);
        [[a, b, c, d], [b, c, d, a], [c, d, a, b], [d, a, b, c]].map(|[a, b, c, apex]| {
            let normal = cross(minus(b, a), minus(c, a));
            dot(normal, minus(apex, a)).abs() / dot(normal, normal).sqrt()
        })
    });
    heights.fold(f64::INFINITY, f64::min)
}
