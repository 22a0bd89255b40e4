//! Complexes as files.

use walpha_base::random::Random;
use walpha_check::schema::{Classes, ComplexFile, PlacedComplex, SchemaError};
use walpha_check::{ByClass, Claim, Class, Extent};

use crate::common::{Case, definition, grid, shape_of};

fn parse(json: &str) -> Result<ComplexFile, SchemaError> {
    ComplexFile::read_json(json.as_bytes())
}

fn case() -> Case {
    let mut random = Random::new(5);
    let mut positions = grid(4);
    positions.iter_mut().flatten().step_by(7).for_each(|x| *x += random.unit());
    positions.push(positions[3]);
    let weights = (0..65).map(|_| random.unit()).collect();
    Case { positions, weights, alpha: 0.9 }
}

/// Every double, simplex and class comes back.
#[test]
fn round_trips() {
    for alpha in [0.9, f64::INFINITY, f64::NEG_INFINITY] {
        let case = Case { alpha, ..case() };
        let answer = definition(&case).unwrap();
        let file = ComplexFile::from(case.claim(&answer, Extent::Whole));
        let mut json = Vec::new();
        file.write_json(&mut json).unwrap();
        assert_eq!(ComplexFile::read_json(&json[..]).unwrap(), file);
        let placed = PlacedComplex::try_from(file).unwrap();
        assert_eq!(placed.complex, answer.complex);
        assert_eq!(placed.positions, case.positions);
        assert_eq!(placed.hidden, Some(answer.hidden));
    }
}

/// A file as another program would write it: sorted rows, no classes, no exterior simplices.
#[test]
fn classes_follow_from_a_shape_alone() {
    for alpha in [0.3, 0.6, 0.75, 0.9] {
        let case = Case { alpha, ..case() };
        let answer = definition(&case).unwrap();
        let shape = shape_of(&answer).complex;
        let mut file = ComplexFile::from(Claim::new(case.placed(&shape)));
        file.classes = Classes::default();
        file.cells.iter_mut().flatten().for_each(|row| row.sort_unstable());
        file.facets.iter_mut().flatten().for_each(|row| row.sort_unstable());
        assert_eq!(PlacedComplex::try_from(file.clone()).unwrap().complex, shape, "α = {alpha}");
    }
}

#[test]
fn missing_dimensions_are_faces() {
    let json = r#"{ "points": [[0,0,0],[1,0,0],[0,1,0],[0,0,1],[1,1,1]],
                    "alpha": 3, "cells": [[1,0,2,3],[3,2,1,4]] }"#;
    let placed = PlacedComplex::try_from(parse(json).unwrap()).unwrap();
    let complex = &placed.complex;
    assert_eq!(complex.cells.rows(), [[0, 1, 2, 3], [1, 2, 3, 4]]);
    let facets = ByClass { interior: 1, regular: 6, ..ByClass::default() };
    assert_eq!(complex.facets.counts(), facets);
    assert_eq!(complex.edges.counts(), ByClass { regular: 9, ..ByClass::default() });
    assert_eq!(complex.vertices.counts(), ByClass { regular: 5, ..ByClass::default() });
    assert_eq!(placed.claim().findings().unwrap().0, []);
}

#[test]
fn faces_of_exterior_cells_are_exterior() {
    let json = r#"{ "points": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "alpha": -1,
                    "cells": [[0,1,2,3]], "classes": { "cells": ["exterior"] } }"#;
    let complex = PlacedComplex::try_from(parse(json).unwrap()).unwrap().complex;
    assert_eq!(complex.vertices.classes(), [Class::Exterior; 4]);
}

#[test]
fn errors_name_the_field() {
    let message = |json: &str| match parse(json) {
        Ok(file) => PlacedComplex::try_from(file).unwrap_err().to_string(),
        Err(error) => error.to_string(),
    };
    let points = r#""points": [[0,0,0],[1,0,0]]"#;
    let cases = [
        (format!(r#"{{ {points}, "alpha": 1 }}"#), "no simplices"),
        (format!(r#"{{ {points}, "edges": [[0,1]] }}"#), "missing field `alpha`"),
        (format!(r#"{{ {points}, "alpha": "big", "edges": [[0,1]] }}"#), "\"inf\" or \"-inf\""),
        (format!(r#"{{ {points}, "alpha": 1, "edges": [[0,2]] }}"#), "`edges` names point 2"),
        (format!(r#"{{ {points}, "alpha": 1, "edge": [[0,1]] }}"#), "unknown field `edge`"),
        (format!(r#"{{ {points}, "alpha": 1, "edges": [[0,1]], "weights": [1] }}"#), "`weights`"),
        (
            format!(r#"{{ {points}, "alpha": 1, "edges": [[0,1]], "classes": {{"edges": []}} }}"#),
            "`classes.edges`",
        ),
        (format!(r#"{{ {points}, "alpha": 1, "edges": [[0,1]], "hidden": [7] }}"#), "`hidden`"),
    ];
    for (json, part) in cases {
        let message = message(&json);
        assert!(message.contains(part), "{json}: {message}");
    }
}

/// For derived rows, an empty list of classes has no effect, and any other list is refused.
#[test]
fn classes_of_rows_that_are_not_listed() {
    let cell = |classes: &str| {
        let points = "[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]";
        parse(&format!(
            r#"{{ "points": {points}, "alpha": 1, "cells": [[0,1,2,3]], "classes": {{{classes}}} }}"#
        ))
        .unwrap()
    };
    let expected = PlacedComplex::try_from(cell("")).unwrap();
    assert_eq!(expected.complex.facets.len(), 4);
    let empty = cell(r#""facets": [], "edges": [], "vertices": []"#);
    assert_eq!(PlacedComplex::try_from(empty).unwrap(), expected);
    let one = PlacedComplex::try_from(cell(r#""edges": ["regular"]"#)).unwrap_err();
    assert!(one.to_string().contains("`classes.edges`"), "{one}");
}
