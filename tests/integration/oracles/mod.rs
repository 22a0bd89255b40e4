//! Ours against CGAL's classes, which the module `cgal` binds: triangulations, filtrations, α, periodic boxes.

mod connected;
mod intervals;
mod periodic;
mod triangulation;

use rayon::prelude::*;
use walpha::WeightedPoints;
use walpha_base::random::Random;

use crate::common::weighted;
use crate::triangulation::FAMILIES;

/// Runs a check on small sets of all [`FAMILIES`] (grids, cospherical and nearly equal points, numbers of any size, planes and lines
/// with a few points off them; with hidden points and duplicates) and on [`larger`] ones. Returns how many it did not pass over.
fn on_all_sets(small: u64, check: impl Fn(&WeightedPoints) -> bool + Sync) -> usize {
    let one = |seed: u64| {
        let family = (seed % FAMILIES.len() as u64) as usize;
        let points = FAMILIES[family](&mut Random::new(seed));
        let checked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| check(&points)));
        checked.unwrap_or_else(|_| panic!("set {seed}, family {family}: {points:?}"))
    };
    let small = (0..small).into_par_iter().filter(|&seed| one(seed)).count();
    small + larger().par_iter().filter(|points| check(points)).count()
}

/// Random points with and without weights, a grid, one with weights of which some hide others, points of a sphere and its centre.
fn larger() -> Vec<WeightedPoints> {
    let mut random = Random::new(5);
    let mut places = |count: usize| -> Vec<[f64; 3]> {
        (0..count).map(|_| [0; 3].map(|_| random.unit())).collect()
    };
    let scattered = places(300);
    let heavy = places(300);
    let grid = |side: i32| {
        (0..side.pow(3)).map(move |i| [i % side, i / side % side, i / side / side].map(f64::from))
    };
    let sphere = grid(15).map(|p| p.map(|x| x - 7.0));
    let sphere = sphere.filter(|p| p.iter().map(|x| x * x).sum::<f64>() == 49.0 || *p == [0.0; 3]);
    vec![
        weighted(scattered.into_iter().map(|p| (p, 0.0))),
        weighted(heavy.into_iter().enumerate().map(|(i, p)| (p, (i % 7) as f64 / 200.0))),
        weighted(grid(5).map(|p| (p, 0.0))),
        weighted(grid(5).enumerate().map(|(i, p)| (p, (i * i % 5) as f64 / 2.0))),
        weighted(sphere.map(|p| (p, 0.0))),
    ]
}
