//! Laws that hold for any input, degenerate lattices above all.

use std::collections::HashSet;

use proptest::prelude::*;
use walpha::shape::ShapeOptions;
use walpha::{Alpha, AlphaShape, Class, Complex, Simplices, WeightedPoints, alpha_shape};

use crate::common;

type Site = ([i32; 3], i32);

/// Lattice points with half-integer weights, not all in one plane: ties everywhere.
fn lattice() -> impl Strategy<Value = Vec<Site>> {
    let site = ([0..4, 0..4, 0..4i32], prop_oneof![3 => Just(0), 1 => 0..12i32]);
    let sites = prop::collection::vec(site, 4..40);
    sites.prop_filter("in one plane", |sites| common::spans_a_volume(points(sites).positions()))
}

fn points(sites: &[Site]) -> WeightedPoints {
    let positions = sites.iter().map(|(p, _)| p.map(f64::from)).collect();
    let weights = sites.iter().map(|&(_, w)| f64::from(w) / 2.0).collect();
    WeightedPoints::new(positions, weights).unwrap()
}

/// The whole triangulation at α.
fn shape(points: WeightedPoints, alpha: f64) -> AlphaShape {
    let alpha = Alpha::from_squared(alpha).unwrap();
    let options = ShapeOptions::new(alpha).exterior(true);
    alpha_shape(points, &options).unwrap()
}

fn inside<const N: usize>(simplices: &Simplices<N>) -> HashSet<[u32; N]> {
    let sorted = |row: &[u32; N]| {
        let mut row = *row;
        row.sort_unstable();
        row
    };
    simplices.iter().filter(|s| s.1 != Class::Exterior).map(|s| sorted(s.0)).collect()
}

fn contains(large: &Complex, small: &Complex) -> bool {
    inside(&large.cells).is_superset(&inside(&small.cells))
        && inside(&large.facets).is_superset(&inside(&small.facets))
        && inside(&large.edges).is_superset(&inside(&small.edges))
        && inside(&large.vertices).is_superset(&inside(&small.vertices))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn a_common_weight_shifts_alpha(sites in lattice(), common in -4..12i32, alpha in -2..20i32) {
        let (common, alpha) = (f64::from(common) / 4.0, f64::from(alpha) / 4.0);
        let plain = points(&sites);
        let mut shifted = plain.clone();
        shifted.weights_mut().iter_mut().for_each(|w| *w += common);
        let shifted = shape(shifted, alpha);
        let plain = shape(plain, alpha + common);
        prop_assert_eq!(shifted.complex(), plain.complex());
        prop_assert_eq!(shifted.betti(), plain.betti());
    }

    #[test]
    fn translation_changes_nothing(sites in lattice(), by in [-9..9i32, -9..9i32, -9..9i32], alpha in 0..20i32) {
        let moved: Vec<Site> =
            sites.iter().map(|&(p, w)| ([p[0] + by[0], p[1] + by[1], p[2] + by[2]], w)).collect();
        let alpha = f64::from(alpha) / 4.0;
        let here = shape(points(&sites), alpha);
        let there = shape(points(&moved), alpha);
        prop_assert_eq!(here.complex(), there.complex());
    }

    #[test]
    fn scaling_by_a_power_of_two_changes_nothing(sites in lattice(), exponent in -40..40i32, alpha in 0..20i32) {
        let alpha = f64::from(alpha) / 4.0;
        let factor = 2f64.powi(exponent);
        let here = points(&sites);
        let positions = here.positions().iter().map(|p| p.map(|v| v * factor)).collect();
        let weights = here.weights().iter().map(|w| w * factor * factor).collect();
        let scaled = WeightedPoints::new(positions, weights).unwrap();
        let here = shape(here, alpha);
        let scaled = shape(scaled, alpha * factor * factor);
        prop_assert_eq!(here.complex(), scaled.complex());
    }

    #[test]
    fn shapes_grow_with_alpha(sites in lattice(), alpha in -8..20i32, more in 0..20i32) {
        let small = shape(points(&sites), f64::from(alpha) / 4.0);
        let large = shape(points(&sites), f64::from(alpha + more) / 4.0);
        prop_assert!(contains(large.complex(), small.complex()));
    }

    #[test]
    fn order_of_input_means_nothing(
        (sites, order) in lattice().prop_flat_map(|sites| {
            let order = Just((0..sites.len()).collect::<Vec<_>>()).prop_shuffle();
            (Just(sites), order)
        }),
        alpha in 0..20i32,
    ) {
        let alpha = f64::from(alpha) / 4.0;
        let shuffled: Vec<Site> = order.iter().map(|&i| sites[i]).collect();
        let (here, there) = (shape(points(&sites), alpha), shape(points(&shuffled), alpha));
        prop_assert_eq!(places(&here, &sites), places(&there, &shuffled));
    }

    #[test]
    fn infinite_alpha_is_the_hull(sites in lattice()) {
        let all = shape(points(&sites), f64::INFINITY);
        // The largest orthogonal sphere of cells on this lattice is far smaller.
        let large = shape(points(&sites), 1e6);
        prop_assert_eq!(all.complex(), large.complex());
        let betti = all.betti().unwrap();
        prop_assert_eq!((betti.b0, betti.b1, betti.b2), (1, 0, 0));
        let nothing = shape(points(&sites), f64::NEG_INFINITY);
        prop_assert_eq!(nothing.points_in_shape(), 0);
    }
}

/// Simplices by the places of their vertices, with classes: what does not depend on indices.
fn places(shape: &AlphaShape, sites: &[Site]) -> HashSet<(Vec<[i32; 3]>, Class)> {
    fn of<const N: usize>(
        simplices: &Simplices<N>,
        sites: &[Site],
    ) -> impl Iterator<Item = (Vec<[i32; 3]>, Class)> {
        simplices.iter().map(|(row, class)| {
            let mut row: Vec<_> = row.iter().map(|&v| sites[v as usize].0).collect();
            row.sort_unstable();
            (row, class)
        })
    }
    let complex = shape.complex();
    of(&complex.cells, sites)
        .chain(of(&complex.facets, sites))
        .chain(of(&complex.edges, sites))
        .chain(of(&complex.vertices, sites))
        .collect()
}
