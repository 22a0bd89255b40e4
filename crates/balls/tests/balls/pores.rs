//! The largest spheres between balls of different radii.

use walpha_balls::{PeriodicBalls, ProbedPores};
use walpha_base::random::Random;
use walpha_shape::Torus;

const EPS: f64 = 1e-9;

/// The distance from a place to the surface of the nearest ball, over all copies that may be near.
fn room(torus: Torus, positions: &[[f64; 3]], radii: &[f64], place: [f64; 3]) -> f64 {
    let mut least = f64::INFINITY;
    for (&position, radius) in positions.iter().zip(radii) {
        for i in -2..=2 {
            for j in -2..=2 {
                for k in -2..=2 {
                    let copy = torus.moved(torus.wrap(position), [i, j, k]);
                    let way = [0, 1, 2].map(|axis| copy[axis] - place[axis]);
                    least = least.min(way[0].hypot(way[1]).hypot(way[2]) - radius);
                }
            }
        }
    }
    least
}

/// Just below its radius, a sphere finds place, or a channel, and just above none.
#[test]
fn spheres_vanish_where_balls_are_larger_by_their_radius() {
    let (mut narrower, mut overlapping) = (0, 0);
    for seed in 0..8 {
        let mut random = Random::new(seed);
        let mut number = |low: f64, high: f64| low + (high - low) * random.unit();
        let vectors = [
            [4.0, 0.0, 0.0],
            [number(-1.0, 1.0), 4.0, 0.0],
            [number(-1.0, 1.0), number(-1.0, 1.0), 4.0],
        ];
        let torus = Torus::of_vectors(vectors).unwrap();
        let is_dense = seed % 4 == 3;
        let count = if is_dense { 20 } else { 1 + seed as usize % 8 };
        let positions: Vec<_> = (0..count).map(|_| [0; 3].map(|_| number(0.0, 4.0))).collect();
        let radii: Vec<f64> =
            (0..count).map(|_| number(0.1, if is_dense { 2.0 } else { 1.4 })).collect();
        let balls = PeriodicBalls::new(torus, positions.clone(), radii.clone()).unwrap();
        let found = balls.pores().unwrap();
        let parts = |ProbedPores { channels, pockets, .. }: &ProbedPores| channels.len() + pockets;
        let probed = |diameter: f64, by: f64| balls.probed(diameter / 2.0 + by).unwrap();

        let included = found.included.diameter;
        assert!(
            parts(&probed(included, -EPS)) > 0 && parts(&probed(included, EPS)) == 0,
            "{seed} {found:?}"
        );
        let fits = room(balls.torus(), &positions, &radii, found.included.center);
        assert!((2.0 * fits - included).abs() < EPS, "{seed} {fits} {found:?}");
        let free = found.free.diameter;
        // Where there is no way even between balls that are smaller by the smallest of them, that is all that is known.
        let is_known = free > -2.0 * radii.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(probed(free, EPS).channels.is_empty(), "{seed} {found:?}");
        assert!(!is_known || !probed(free, -EPS).channels.is_empty(), "{seed} {found:?}");
        // The widest way goes along one of the vectors at least, and the others are narrower.
        let along = found.free_along.map(|sphere| sphere.diameter);
        assert!((along.into_iter().fold(f64::NEG_INFINITY, f64::max) - free).abs() < EPS);
        narrower += along.iter().filter(|&&one| one < free - 1e-3).count();
        assert!(
            found.included_along_free.diameter <= included + EPS
                && found.included_along_free.diameter >= free - EPS
        );
        overlapping += usize::from(free < 0.0);
    }
    assert!(narrower > 3 && overlapping > 0, "{narrower} {overlapping}");
}
