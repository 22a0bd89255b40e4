//! What is suggested, critical values and voids, to the last bit.

use walpha::ladder::Filtration;
use walpha::shape::Engine;
use walpha::{Alpha, WeightedPoints};
use walpha_base::random::Random;

use super::{alpha, alphas, below, check, hollow_lattice, one_by_one};
use crate::common;
use crate::common::sites::weighted;

#[test]
fn a_hollow_block_and_what_is_suggested_for_it() {
    let points = hollow_lattice();
    let squared = [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 2.75, 3.0];
    let filtration = check(&points, &squared, Engine::Cgal);
    let curve = filtration.curve();
    let suggested = filtration.suggest(&curve);
    assert_eq!(suggested.all_points, alpha(0.75));
    assert_eq!(suggested.one_region, alpha(0.75));
    // The hole is a box of three with its corners cut: the sphere in its middle meets (1, 2, 2) and alike.
    assert_eq!(suggested.no_void, alpha(2.75));
    assert_eq!(suggested.plateau, [0.75, 2.75].map(alpha));
    let chosen = filtration.readable(&curve, 24);
    let chosen: Vec<f64> = chosen.iter().map(|alpha| alpha.squared()).collect();
    // Where a corner is missing three points make a triangle: 2/3, rounded up.
    assert_eq!(chosen, [0.25, 0.5, 0.6666666666666667, 0.75, 2.75]);
}

/// (q, q², q³): doubles tell few of the radii apart, with weights or without.
fn cubic(weights: [f64; 4]) -> WeightedPoints {
    let site = |q: i32| ([1, 2, 3].map(|k| f64::from(q).powi(k)), weights[(q + 8) as usize % 4]);
    weighted((-8..=8).map(site))
}

#[test]
fn the_critical_values_of_ill_conditioned_points_are_exact() {
    // Counted, and the last found, with rational numbers.
    for (weights, values, one_region) in
        [([0.0, 0.5, 1.0, 1.5], 158, 67300732.09365807), ([0.0; 4], 82, 67299698.25)]
    {
        let points = cubic(weights);
        let filtration = Filtration::new(points.clone()).unwrap();
        let curve = filtration.curve();
        assert_eq!(curve.len(), values);
        let suggested = filtration.suggest(&curve);
        assert_eq!(suggested.one_region, alpha(one_region));
        let chosen = filtration.readable(&curve, 5000);
        let all = [&chosen[..], &[suggested.all_points, suggested.one_region]].concat();
        assert!(all.len() > 5, "{all:?}");
        for alpha in all {
            let [at, below] = [alpha, below(alpha)]
                .map(|alpha| one_by_one(&points, alpha, true, Engine::Cgal).complex().clone());
            assert!(at != below, "nothing comes at {alpha}");
        }
    }
}

/// What is printed as filling a void fills it, and no smaller double does.
#[test]
fn voids_fill_at_the_first_double() {
    let mut points = hollow_lattice();
    // Off the lattice by less than radii are known in doubles: which comes last is hard to tell.
    let mut random = Random::new(1);
    for x in points.positions.iter_mut().flatten() {
        *x += 1024.0 + random.below(16) as f64 * 2f64.powi(-42);
    }
    let filtration = Filtration::new(points.clone()).unwrap();
    let void = filtration.ladder(&alphas(&[0.8]), 1.0).levels[0].voids[0];
    let voids = |alpha: Alpha| {
        let shape = one_by_one(&points, alpha, true, Engine::Native);
        shape.voids().unwrap()
    };
    assert_eq!(voids(alpha(0.8))[0].filling_alpha, void.filling_alpha);
    assert_eq!(voids(void.filling_alpha), []);
    assert_ne!(voids(below(void.filling_alpha)), []);
}

#[test]
fn where_nothing_changes_any_more_the_stretch_has_no_end() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let filtration = Filtration::new(weighted(corners.map(|p| (p, 0.0)))).unwrap();
    let suggested = filtration.suggest(&filtration.curve());
    assert_eq!(suggested.plateau, [alpha(0.75), Alpha::INFINITE]);
    assert_eq!(serde_json::to_value(suggested).unwrap()["plateau"][1], "inf");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("four.csv"), "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n").unwrap();
    let told =
        common::ok(folder.path(), &["ladder", "four.csv", "--weights", "common=0", "-o", "out"]);
    assert!(told.contains("0.75         to inf: b0, b1, b2 change no more"), "{told}");
}

#[test]
fn a_shift_of_weights_shifts_the_ladder() {
    let mut points = hollow_lattice();
    let plain = Filtration::new(points.clone()).unwrap();
    points.weights.iter_mut().for_each(|weight| *weight = 0.5);
    let shifted = Filtration::new(points).unwrap();
    let (a, b) = (plain.suggest(&plain.curve()), shifted.suggest(&shifted.curve()));
    assert_eq!(a.no_void.squared() - 0.5, b.no_void.squared());
    let ladder = |f: &Filtration, at: f64| f.ladder(&alphas(&[at]), 1.0).levels[0].betti;
    assert_eq!(ladder(&plain, 1.0), ladder(&shifted, 0.5));
}

#[test]
fn huge_and_tiny_units_change_nothing() {
    for factor in [2f64.powi(-120), 2f64.powi(130)] {
        let mut points = hollow_lattice();
        points.positions.iter_mut().flatten().for_each(|x| *x *= factor);
        let filtration = Filtration::new(points).unwrap();
        let suggested = filtration.suggest(&filtration.curve());
        assert_eq!(suggested.no_void, alpha(2.75 * factor * factor));
    }
}
