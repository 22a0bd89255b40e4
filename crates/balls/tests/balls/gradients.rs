//! Derivatives, held to differences.

use walpha_balls::{BallUnion, BallsError};

use crate::random_sets::balls;
use crate::shape;

/// Σ w V and Σ w A.
fn weighted(centers: &[[f64; 3]], radii: &[f64], weights: &[f64]) -> [f64; 2] {
    let squares: Vec<f64> = radii.iter().map(|r| r * r).collect();
    let shape = shape(centers, &squares);
    let union = BallUnion::new(&shape).unwrap();
    let sum = |values: &[f64]| values.iter().zip(weights).map(|(value, w)| value * w).sum();
    [sum(&union.volumes().values), sum(&union.areas().values)]
}

/// Changes centres or radii by a step.
type Change<'a> = dyn Fn(f64, &mut [[f64; 3]], &mut [f64]) + 'a;

#[test]
fn derivatives_are_limits_of_differences() {
    for (seed, n, spread) in [(1, 3, 0.6), (2, 12, 0.8), (3, 30, 0.9), (4, 30, 1.3)] {
        let (centers, squares) = balls(seed, n, spread);
        let radii: Vec<f64> = squares.iter().map(|s| s.sqrt()).collect();
        let weights: Vec<f64> = (0..n).map(|i| 1.0 + (i % 5) as f64).collect();
        let squares: Vec<f64> = radii.iter().map(|r| r * r).collect();
        let shape = shape(&centers, &squares);
        let union = BallUnion::new(&shape).unwrap();
        for weights in [None, Some(&weights[..])] {
            let found = union.gradients(weights).unwrap();
            let ones = vec![1.0; n];
            let weights = weights.unwrap_or(&ones);
            let h = 1e-6;
            let check = |change: &Change<'_>, got: [f64; 2]| {
                let at = |step: f64| {
                    let (mut centers, mut radii) = (centers.clone(), radii.clone());
                    change(step, &mut centers, &mut radii);
                    weighted(&centers, &radii, weights)
                };
                let (up, down) = (at(h), at(-h));
                for k in 0..2 {
                    let difference = (up[k] - down[k]) / (2.0 * h);
                    assert!(
                        (difference - got[k]).abs() < 2e-6,
                        "seed {seed}, {k}: {difference} {}",
                        got[k]
                    );
                }
            };
            for v in 0..n {
                for axis in 0..3 {
                    let row = 3 * v + axis;
                    check(
                        &|step, centers, _| centers[v][axis] += step,
                        [found.volume.by_centers.values[row], found.area.by_centers.values[row]],
                    );
                }
                check(
                    &|step, _, radii| radii[v] += step,
                    [found.volume.by_radii.values[v], found.area.by_radii.values[v]],
                );
            }
        }
    }
}

/// All balls moved together, or all scaled.
#[test]
fn derivatives_sum_up() {
    let (centers, squares) = balls(5, 200, 1.0);
    let shape = shape(&centers, &squares);
    let union = BallUnion::new(&shape).unwrap();
    let found = union.gradients(None).unwrap();
    let cases =
        [(&found.volume, union.volume().value, 3.0), (&found.area, union.area().value, 2.0)];
    for (gradient, whole, power) in cases {
        let (values, bounds) = (&gradient.by_centers.values, &gradient.by_centers.bounds);
        assert!(bounds.iter().chain(&gradient.by_radii.bounds).all(|&bound| bound < 1e-9));
        for axis in 0..3 {
            let sum: f64 = (0..200).map(|v| values[3 * v + axis]).sum();
            assert!(sum.abs() < 1e-9, "{sum}");
        }
        let by_radii = (0..200).map(|v| gradient.by_radii.values[v] * squares[v].sqrt());
        let by_centers = (0..600).map(|row| values[row] * centers[row / 3][row % 3]);
        let scaled: f64 = by_radii.chain(by_centers).sum();
        assert!((scaled - power * whole).abs() < 1e-9 * whole, "{scaled} {whole}");
    }
}

#[test]
fn each_ball_needs_a_weight() {
    let shape = shape(&[[0.0; 3]], &[1.0]);
    let union = BallUnion::new(&shape).unwrap();
    let wrong = union.gradients(Some(&[1.0; 2]));
    assert_eq!(wrong, Err(BallsError::Weights { weights: 2, points: 1 }));
}
