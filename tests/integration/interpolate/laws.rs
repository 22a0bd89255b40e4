//! What holds of F whatever the points are.

use ndarray::Array3;
use proptest::prelude::*;
use walpha::interpolate::{Grid, Interpolant};
use walpha::{AlphaShape, Class, Coordinates, Dims, Frame, Units, Volume};

use super::{Place, anywhere, cross, dot, lattice, linear, minus, points, shape, wild};

/// The points of a simplex with these shares, rounded.
fn within(shape: &AlphaShape, simplex: &[u32], shares: [f64; 4]) -> Place {
    let whole: f64 = shares[..simplex.len()].iter().sum();
    [0, 1, 2].map(|k| {
        let at =
            |(&v, share): (&u32, &f64)| shape.points().positions[v as usize][k] * share / whole;
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
                    let place = shape.points().positions[vertex as usize];
                    let expected = shape.points().values.as_ref().unwrap()[vertex as usize];
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
        let values = shape.points().values.as_ref().unwrap();
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
            let grid = Grid::over(&volume, Dims::new(x, y, z).unwrap(), Units::World);
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
        let grid = Grid::spanning([0.0; 3], [4.0; 3], Dims::new(9, 9, 9).unwrap());
        let samples = |shape: AlphaShape| {
            Interpolant::new(&shape).unwrap().resample(&grid).unwrap().volume().clone()
        };
        prop_assert_eq!(samples(make(sites.clone())), samples(make(shuffled)));
    }
}

/// The least height of the cells on a facet.
fn thinnest(shape: &AlphaShape, facet: &[u32; 3]) -> f64 {
    let at = |v: u32| shape.points().positions[v as usize];
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
