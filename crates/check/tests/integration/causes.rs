//! What many findings have in common.

use walpha_base::random::Random;
use walpha_check::schema::{FiltrationFile, Values};
use walpha_check::{
    Alpha, Cause, Class, Extent, FiltrationFinding, Finding, LikelyCause, certify_filtration,
    likely_cause, likely_cause_of_values,
};

use crate::common::{Answer, Case, definition};

fn random_case(seed: u64, weights: bool) -> Case {
    let mut random = Random::new(seed);
    let mut number = || random.below(1 << 20) as f64 / f64::from(1 << 20);
    let positions = (0..24).map(|_| [number(), number(), number()]).collect();
    let weights = (0..24).map(|_| if weights { number() / 50.0 } else { 0.0 }).collect();
    Case { positions, weights, alpha: f64::INFINITY }
}

/// The filtration of a case whose values are made from the right ones: `value` is called with the simplex's dimension and value.
fn filtration(case: &Case, value: impl Fn(usize, f64) -> f64) -> FiltrationFile {
    let Answer { complex, hidden, .. } = definition(case).unwrap();
    let counts =
        [complex.vertices.len(), complex.edges.len(), complex.facets.len(), complex.cells.len()];
    let mut file: FiltrationFile = serde_json::from_value(serde_json::json!({
        "points": case.positions,
        "weights": case.weights,
        "vertices": complex.vertices.rows().as_flattened(),
        "edges": complex.edges.rows(),
        "facets": complex.facets.rows(),
        "cells": complex.cells.rows(),
        "values": {"vertices": vec![0.0; counts[0]], "edges": vec![0.0; counts[1]], "facets": vec![0.0; counts[2]], "cells": vec![0.0; counts[3]]},
        "order": (0..counts.iter().sum::<usize>()).collect::<Vec<_>>(),
        "hidden": hidden,
    }))
    .unwrap();
    // Findings name the right values of all that are not 0.
    let (findings, _) = certify_filtration(&file).unwrap();
    let Values { vertices, edges, facets, cells } = &mut file.values;
    for finding in findings {
        let FiltrationFinding::When { simplex, expected, .. } = finding else { continue };
        let row = simplex.vertices();
        let (values, at) = match row.len() {
            1 => (&mut *vertices, complex.vertices.rows().iter().position(|own| own == row)),
            2 => (&mut *edges, complex.edges.rows().iter().position(|own| own == row)),
            3 => (&mut *facets, complex.facets.rows().iter().position(|own| own == row)),
            _ => (&mut *cells, complex.cells.rows().iter().position(|own| own == row)),
        };
        values[at.unwrap()] = expected;
    }
    for (dimension, values) in [vertices, edges, facets, cells].into_iter().enumerate() {
        for given in values {
            *given = Alpha::from_squared(value(dimension, given.squared())).unwrap();
        }
    }
    file
}

fn cause_of(file: &FiltrationFile) -> Option<LikelyCause> {
    let (findings, _) = certify_filtration(file).unwrap();
    likely_cause_of_values(&findings, file)
}

#[test]
fn values_of_another_unit_are_recognised() {
    let case = random_case(1, false);
    let cause = |value: fn(f64) -> f64| cause_of(&filtration(&case, |_, alpha| value(alpha)));
    assert_eq!(cause(|alpha| alpha), None);
    for (value, expected) in [
        (f64::sqrt as fn(f64) -> f64, Cause::Radii),
        (|alpha| 4.0 * alpha, Cause::SquaredDiameters),
        (|alpha| 2.0 * alpha.sqrt(), Cause::Diameters),
    ] {
        let found = cause(value).unwrap();
        assert_eq!((found.cause, found.findings), (expected, found.of));
        assert!(found.to_string().starts_with(&format!("all {} wrong values are", found.of)));
    }
    // No one mistake makes these.
    assert_eq!(cause(|alpha| alpha + 0.125), None);
}

/// Values of attached simplices that are those of their own spheres, weighted or not, in single precision.
#[test]
fn circumradii_of_attached_simplices_are_recognised() {
    for weights in [false, true] {
        let case = random_case(2, weights);
        let right = filtration(&case, |_, alpha| alpha);
        let mut file = right.clone();
        // The squared radius of an edge's own sphere.
        let mut changed = 0;
        for (row, value) in file.edges.iter().zip(&mut file.values.edges) {
            let [a, b] = row.map(|v| case.positions[v as usize]);
            let [v, w] = row.map(|v| case.weights[v as usize]);
            let squared: f64 = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum();
            let from_a = (squared + v - w) / (2.0 * squared.sqrt());
            let own = f64::from((from_a * from_a - v) as f32);
            if (own - value.squared()).abs() > 1e-5 {
                *value = Alpha::from_squared(own).unwrap();
                changed += 1;
            }
        }
        let found = cause_of(&file).unwrap();
        assert_eq!((found.cause, found.findings), (Cause::AttachedByOwnRadius, changed));
        assert_eq!(found.of, changed);
        assert!(changed >= 3, "{changed}");
    }
}

#[test]
fn classes_of_another_alpha_or_by_own_spheres_are_recognised() {
    let mut case = random_case(3, false);
    case.alpha = 0.04;
    let right = definition(&case).unwrap();
    let found = |answer: &Answer| likely_cause(&case.findings(answer, Extent::Whole), case.alpha());
    assert_eq!(found(&right), None);
    let mut other = case.clone();
    other.alpha = 0.2;
    let cause = found(&definition(&other).unwrap()).unwrap();
    let Cause::OtherAlpha { alpha } = cause.cause else { panic!("{cause}") };
    assert!((alpha.squared() - 0.2).abs() < 1e-12, "{cause}");
    // A facet whose own sphere is small is taken for one of the shape, although a point lies in it.
    let mut attached = right.clone();
    let wrong = |finding: &Finding| matches!(finding, Finding::Class { refuted_by: Some(_), .. });
    for class in attached.complex.edges.classes_mut() {
        if *class == Class::Exterior {
            *class = Class::Singular;
        }
    }
    let findings: Vec<_> =
        case.findings(&attached, Extent::Whole).into_iter().filter(wrong).collect();
    assert!(findings.len() >= 3, "{}", findings.len());
    let cause = likely_cause(&findings, case.alpha()).unwrap();
    assert_eq!((cause.cause, cause.findings), (Cause::ClassByOwnRadius, findings.len()));
}
