//! Unions of balls, held to closed forms, to other formulas and to sampling.

mod cavities;
mod closed_forms;
mod discs;
mod gradients;
mod levels;
mod pores;
mod random_sets;
mod refused;
mod small_boxes;
mod surface;

use walpha_balls::{BallUnion, Bounded, Measured};
use walpha_shape::{Alpha, AlphaShape, ShapeOptions, Torus, WeightedPoints, alpha_shape};

/// The dual complex of balls by centres and squared radii, with its exterior simplices.
fn shape(centers: &[[f64; 3]], squares: &[f64]) -> AlphaShape {
    shape_on(None, centers, squares)
}

fn shape_on(torus: Option<Torus>, centers: &[[f64; 3]], squares: &[f64]) -> AlphaShape {
    let points = WeightedPoints::new(centers.to_vec(), squares.to_vec()).unwrap();
    let options = ShapeOptions::new(Alpha::ZERO).exterior(true).periodic(torus);
    alpha_shape(points, &options).unwrap()
}

/// Asserts that a bound is narrow, and that it holds the true number, which is itself rounded by a few units.
#[track_caller]
fn assert_is(number: Bounded, wanted: f64) {
    let Bounded { value, bound } = number;
    let rounding = 8.0 * f64::EPSILON * wanted.abs();
    assert!((value - wanted).abs() <= bound + rounding, "{value} ± {bound:e}, not {wanted}");
    assert!(bound <= 1e-12 * wanted.abs().max(1.0), "{value} ± {bound:e} is not narrow");
}

/// Asserts that two numbers may be the same.
#[track_caller]
fn assert_same(a: Bounded, b: Bounded) {
    assert!((a.value - b.value).abs() <= a.bound + b.bound, "{a:?} and {b:?}");
}

/// The sum of a column.
fn sum(column: &Measured) -> Bounded {
    let rows = (0..column.len()).map(|row| column.get(row));
    rows.fold(Bounded { value: 0.0, bound: 0.0 }, |sum, row| {
        let value = sum.value + row.value;
        Bounded { value, bound: sum.bound + row.bound + f64::EPSILON * value.abs() }
    })
}

/// Asserts what holds for all unions: the parts sum up to the totals, and the angles to the Euler characteristic.
#[track_caller]
fn assert_consistent(union: &BallUnion<'_>) {
    assert_same(sum(union.volumes()), union.volume());
    assert_same(sum(union.areas()), union.area());
    let whole = 4.0 * std::f64::consts::PI * union.euler_characteristic() as f64;
    let Bounded { value, bound } = union.gaussian_curvature();
    assert!(
        (value - whole).abs() <= bound + 1e-15 * whole.abs(),
        "{value} ± {bound:e}, not {whole}"
    );
    for column in [union.volumes(), union.areas(), union.contacts().sizes] {
        assert!((0..column.len()).all(|row| column.values[row] >= -column.bounds[row]));
    }
}
