//! Classes against those of shapes made one by one.

use std::collections::HashMap;

use walpha::ladder::{Entry, Filtration, Ordered};
use walpha::shape::{Engine, ShapeOptions};
use walpha::{Alpha, AlphaShape, Class, WeightedPoints, alpha_shape};

use super::sets;

fn alpha(squared: f64) -> Alpha {
    Alpha::from_squared(squared).unwrap()
}

fn shape(points: &WeightedPoints, squared: f64) -> AlphaShape {
    let options = ShapeOptions::new(alpha(squared)).engine(Engine::Native).exterior(true);
    alpha_shape(points.clone(), &options).unwrap()
}

/// The class at an α, which must not be the double of a value.
fn class(simplex: &Entry<'_>, squared: f64) -> Class {
    if squared < simplex.value {
        Class::Exterior
    } else if squared < simplex.regular.min(simplex.interior) {
        Class::Singular
    } else if squared < simplex.interior {
        Class::Regular
    } else {
        Class::Interior
    }
}

fn classes(shape: &AlphaShape) -> HashMap<Vec<u32>, Class> {
    fn sorted(row: &[u32]) -> Vec<u32> {
        let mut row = row.to_vec();
        row.sort_unstable();
        row
    }
    let complex = shape.complex();
    let cells = complex.cells.iter().map(|(row, class)| (sorted(row), class));
    let facets = complex.facets.iter().map(|(row, class)| (sorted(row), class));
    let edges = complex.edges.iter().map(|(row, class)| (sorted(row), class));
    let vertices = complex.vertices.iter().map(|(row, class)| (sorted(row), class));
    cells.chain(facets).chain(edges).chain(vertices).collect()
}

/// Doubles between the values, and on both sides of all.
fn between(ordered: &Ordered<'_>) -> Vec<f64> {
    let mut values: Vec<f64> = ordered.values().iter().map(|value| value.squared()).collect();
    values.dedup();
    let middles = values.windows(2).map(|pair| pair[0] + (pair[1] - pair[0]) / 2.0);
    let inside: Vec<f64> = middles
        .filter(|middle| values.binary_search_by(|v| v.total_cmp(middle)).is_err())
        .collect();
    let beyond = |value: f64, sign: f64| value + sign * (value.abs() + 1.0);
    let ends = [beyond(values[0], -1.0), beyond(values[values.len() - 1], 1.0)];
    inside.into_iter().chain(ends).collect()
}

#[test]
fn classes_are_those_of_shapes_made_one_by_one() {
    let mut compared = 0;
    for points in sets(60, 24) {
        let filtration = Filtration::new(points.clone()).unwrap();
        let ordered = filtration.simplices().unwrap();
        let all = between(&ordered);
        for squared in all.iter().copied().step_by(1 + all.len() / 12) {
            let shape = shape(&points, squared);
            let expected = classes(&shape);
            assert_eq!(expected.len(), ordered.len());
            for simplex in ordered.iter() {
                let wanted = expected[simplex.vertices];
                assert_eq!(
                    class(&simplex, squared),
                    wanted,
                    "{simplex:?} at {squared}\n{points:?}"
                );
                compared += 1;
            }
            assert_eq!(filtration.shape(alpha(squared)).betti(), shape.betti());
        }
    }
    assert!(compared > 50_000);
}
