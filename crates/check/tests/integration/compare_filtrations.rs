//! Comparison of filtrations: each difference alone.

use walpha_check::schema::{FiltrationFile, SchemaError};
use walpha_check::{
    Alpha, CompareFiltrationsError, FiltrationComparison, Simplex, compare_filtrations,
};

/// A corner of a cube, with a value for each simplex, in order.
fn corner() -> FiltrationFile {
    let json = r#"{ "points": [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]],
        "weights": [0, 0, 0, 0],
        "vertices": [0, 1, 2, 3],
        "edges": [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]],
        "facets": [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]],
        "cells": [[0, 1, 2, 3]],
        "values": { "vertices": [0, 0, 0, 0], "edges": [1, 1, 1, 2, 2, 2],
                    "facets": [2, 2, 2, 3], "cells": [3] },
        "order": [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14] }"#;
    FiltrationFile::read_json(json.as_bytes()).unwrap()
}

fn against_corner(change: impl Fn(&mut FiltrationFile)) -> FiltrationComparison {
    let mut other = corner();
    change(&mut other);
    compare_filtrations(&corner(), &other).unwrap()
}

#[test]
fn a_filtration_equals_itself() {
    let same = against_corner(|_| ());
    assert!(same.is_equal() && same.order_compared);
    assert_eq!((same.equal, same.largest_share), (15, 0.0));
}

#[test]
fn points_may_be_numbered_otherwise() {
    let turned = against_corner(|b| {
        b.points.swap(0, 3);
        let turn = |v: &mut u32| *v = [3, 1, 2, 0][*v as usize];
        b.vertices.iter_mut().for_each(turn);
        b.edges.as_flattened_mut().iter_mut().for_each(turn);
        b.facets.as_flattened_mut().iter_mut().for_each(turn);
        b.cells.as_flattened_mut().iter_mut().for_each(turn);
    });
    assert!(turned.is_equal() && !turned.order_compared);
    assert_eq!(turned.equal, 15);
}

#[test]
fn values_differ_by_a_share_of_the_larger() {
    let differs = against_corner(|b| {
        b.values.cells[0] = Alpha::from_squared(4.0).unwrap();
        b.values.facets[3] = Alpha::from_squared(2.5).unwrap();
    });
    assert_eq!((differs.equal, differs.largest_share), (13, 0.25));
    let named: Vec<_> = differs.values.iter().map(|value| value.simplex.vertices()).collect();
    assert_eq!(named, [&[0, 1, 2, 3][..], &[1, 2, 3]]);
    assert!(!differs.is_equal());
}

#[test]
fn simplices_of_one_alone_leave_the_order_alone() {
    for here in [true, false] {
        let (mut more, mut less) = (corner(), corner());
        less.cells.clear();
        less.values.cells.clear();
        less.order.pop();
        more.order.swap(0, 1);
        let [a, b] = if here { [&more, &less] } else { [&less, &more] };
        let found = compare_filtrations(a, b).unwrap();
        let only = [&found.only_a, &found.only_b].map(Vec::len);
        assert_eq!(only, [usize::from(here), usize::from(!here)]);
        assert!(!found.is_equal() && !found.order_compared && found.order.is_none());
    }
}

#[test]
fn the_first_simplex_out_of_order_is_named() {
    let found = against_corner(|b| b.order.swap(4, 6));
    assert_eq!(found.order.as_ref().map(Simplex::vertices), Some(&[0, 1][..]));
    assert!(found.order_compared && !found.is_equal() && found.values.is_empty());
}

#[test]
fn points_and_weights_of_one_alone_are_named() {
    let mut more = corner();
    more.points.push([9.0; 3]);
    more.weights.as_mut().unwrap().push(0.0);
    let found = compare_filtrations(&more, &corner()).unwrap();
    assert_eq!((&found.points_only_a[..], &found.points_only_b[..]), (&[4][..], &[][..]));
    let found = compare_filtrations(&corner(), &more).unwrap();
    assert_eq!((&found.points_only_a[..], &found.points_only_b[..]), (&[][..], &[4][..]));
    let found = against_corner(|b| b.weights.as_mut().unwrap()[2] = 0.5);
    assert_eq!((found.weights.len(), found.weights[0].point, found.weights[0].b), (1, 2, 0.5));
    assert!(!found.is_equal());
}

#[test]
fn numbers_are_finite() {
    for [place, weight] in [[f64::NAN, 0.0], [0.0, f64::INFINITY]] {
        let mut wrong = corner();
        wrong.points[1][2] = place;
        wrong.weights.as_mut().unwrap()[3] = weight;
        for (a, b) in [(&wrong, &corner()), (&corner(), &wrong)] {
            let error = compare_filtrations(a, b).unwrap_err();
            let CompareFiltrationsError::Schema(error) = error else { panic!("{error}") };
            assert!(matches!(error, SchemaError::Value { name: "points", .. }), "{error}");
        }
    }
}
