//! The interpolant against brute force and by its laws.

mod adaptive;
mod command;
mod definition;
mod laws;
mod volumes;

use proptest::prelude::*;
use walpha::interpolate::{Interpolant, InterpolateError};
use walpha::points::{difference, select, weigh};
use walpha::shape::ShapeOptions;
use walpha::volume;
use walpha::{
    Alpha, AlphaShape, Selection, SelectionRule, Units, Volume, WeightedPoints, Weighting,
    alpha_shape,
};

use crate::common::spans_a_volume;

type Place = [f64; 3];

fn phantom(size: u64) -> Volume {
    volume::phantom(size).unwrap()
}

fn points(positions: Vec<Place>, weights: Vec<f64>, f: impl Fn(Place) -> f64) -> WeightedPoints {
    let values = positions.iter().map(|&p| f(p)).collect();
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
    let places: Vec<Place> = phantom_points(&phantom(8), 60).positions;
    let mut points = points(places, vec![0.0; 60], linear);
    points.values.as_mut().unwrap()[7] = f64::NAN;
    let bad = shape(points.clone(), 10.0);
    let error = Interpolant::new(&bad).unwrap_err();
    assert!(matches!(error, InterpolateError::Value { index: 7, .. }), "{error}");
    points.values = None;
    let error = Interpolant::new(&shape(points, 10.0)).unwrap_err();
    assert!(matches!(error, InterpolateError::NoValues), "{error}");
}
