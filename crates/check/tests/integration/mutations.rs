//! For each rule of certification, a wrong complex that breaks it.

use walpha_check::{Class, Complex, Extent, Finding};

use crate::base::{DUPLICATE, HIDDEN, base, findings};
use crate::common::{Answer, Case, drop_row, shape_of};

/// Asserts that a mutation of the base is found by a given rule.
macro_rules! found {
    ($mutate:expr, $rule:pat $(if $guard:expr)?) => {{
        let (mut case, mut answer) = base();
        let mutate: fn(&mut Case, &mut Answer) = $mutate;
        mutate(&mut case, &mut answer);
        let all = findings(&case, &answer, Extent::Whole);
        assert!(all.iter().any(|finding| matches!(finding, $rule $(if $guard)?)), "{all:?}");
    }};
}

#[test]
fn vertices_that_do_not_exist() {
    found!(|_, a| a.complex.edges.rows_mut()[3][1] = 30, Finding::Index { points: 30, .. });
}

#[test]
fn a_vertex_named_twice() {
    found!(
        |_, a| {
            let row = &mut a.complex.facets.rows_mut()[0];
            row[1] = row[0];
        },
        Finding::RepeatedVertex { .. }
    );
}

#[test]
fn a_facet_listed_twice() {
    found!(
        |_, a| {
            let facets = &mut a.complex.facets;
            facets.push(facets.rows()[5], facets.classes()[5]);
        },
        Finding::RepeatedSimplex { .. }
    );
}

#[test]
fn a_cell_listed_twice_crowds_facets_and_fills_too_much() {
    let twice: fn(&mut Case, &mut Answer) = |_, a| {
        let cells = &mut a.complex.cells;
        cells.push(cells.rows()[5], cells.classes()[5]);
    };
    found!(twice, Finding::RepeatedSimplex { .. });
    found!(twice, Finding::Crowded { .. });
    found!(twice, Finding::Volume { .. });
}

/// A cell that α leaves out is not a gap, nor are several cells that look like one.
#[test]
fn facets_around_nothing_are_no_gap() {
    let (mut case, answer) = base();
    case.alpha = 0.74;
    let facets = answer.complex.facets.rows().iter().map(|&facet| (facet, Class::Singular));
    let complex = Complex { facets: facets.collect(), ..Complex::default() };
    let all = findings(&case, &answer.with(complex), Extent::Shape);
    assert!(!all.iter().any(|f| matches!(f, Finding::MissingCell { .. })), "{all:?}");
}

#[test]
fn a_vertex_of_a_shape_that_is_listed_as_hidden() {
    let (case, answer) = base();
    let mut shape = shape_of(&answer);
    assert_eq!(findings(&case, &shape, Extent::Shape), []);
    shape.hidden.push(4);
    assert_eq!(findings(&case, &shape, Extent::Shape), [Finding::NotOnlyHidden { point: 4 }]);
}

#[test]
fn a_point_with_a_ball_of_its_own_that_is_not_listed() {
    let (case, answer) = base();
    let mut shape = shape_of(&answer);
    // The far point, which the shape has as a singular vertex.
    let row = shape.complex.vertices.rows().iter().position(|v| *v == [27]).unwrap();
    assert_eq!(shape.complex.vertices.classes()[row], Class::Singular);
    drop_row(&mut shape.complex.vertices, row);
    for hidden in [vec![HIDDEN], vec![HIDDEN, 27]] {
        let listed = Answer { hidden, ..answer.with(shape.complex.clone()) };
        let all = findings(&case, &listed, Extent::Shape);
        assert!(
            matches!(&all[..], [Finding::MissingVertex { point: 27, radius_squared }]
                if radius_squared.is_zero()),
            "{all:?}"
        );
    }
}

#[test]
fn a_simplex_that_no_cell_has() {
    found!(
        |_, a| {
            a.complex.edges.push([0, 26], Class::Exterior);
        },
        Finding::Stray { .. }
    );
    found!(
        |_, a| {
            a.complex.facets.push([0, 1, 2], Class::Exterior);
        },
        Finding::Stray { simplex } if simplex.vertices() == [0, 1, 2]
    );
}

#[test]
fn a_hidden_point_as_vertex() {
    let vertex: fn(&mut Case, &mut Answer) = |_, a| {
        a.complex.vertices.push([HIDDEN], Class::Exterior);
    };
    found!(vertex, Finding::Stray { .. });
    found!(vertex, Finding::NotOnlyHidden { point: HIDDEN });
}

#[test]
fn a_cell_turned_over() {
    found!(|_, a| a.complex.cells.rows_mut()[7].swap(2, 3), Finding::Orientation { .. });
}

#[test]
fn a_boundary_facet_turned_over() {
    found!(
        |_, a| {
            let row = a.complex.facets.classes().iter().position(|c| *c == Class::Regular).unwrap();
            a.complex.facets.rows_mut()[row].swap(1, 2);
        },
        Finding::Winding { .. }
    );
}

#[test]
fn no_cells() {
    found!(|_, a| a.complex = Complex::default(), Finding::NoCells);
}

#[test]
fn a_point_unaccounted_for() {
    found!(|_, a| a.hidden.clear(), Finding::Unaccounted { point: HIDDEN });
}

#[test]
fn a_point_hidden_twice_and_one_that_is_none() {
    found!(|_, a| a.hidden.push(HIDDEN), Finding::NotOnlyHidden { point: HIDDEN });
    found!(|_, a| a.hidden.push(77), Finding::NotOnlyHidden { point: 77 });
}

#[test]
fn a_hidden_point_that_is_not() {
    found!(|c, _| c.weights[HIDDEN as usize] = -0.7, Finding::NotHidden { point: HIDDEN, .. });
    // The point is on the sphere, where the perturbation decides.
    found!(
        |c, _| c.weights[HIDDEN as usize] = -0.75,
        Finding::NotHidden { point: HIDDEN, power, .. } if power.to_string() == "0"
    );
}

#[test]
fn a_hidden_point_outside() {
    found!(
        |c, _| c.positions[HIDDEN as usize] = [-1.0, 1.0, 1.0],
        Finding::OutsideHull { point: HIDDEN, .. }
    );
}

#[test]
fn wrong_duplicates() {
    let expected = Some(0);
    found!(
        |_, a| a.duplicates.clear(),
        Finding::Duplicate { point: DUPLICATE, given: None, expected: e } if *e == expected
    );
    found!(
        |_, a| a.duplicates[0][1] = 3,
        Finding::Duplicate { point: DUPLICATE, given: Some(3), .. }
    );
    found!(
        |_, a| a.duplicates.push([4, 5]),
        Finding::Duplicate { point: 4, given: Some(5), expected: None }
    );
    found!(
        |c, _| c.weights[DUPLICATE as usize] = 1.0,
        Finding::DuplicateVertex { point: 0, kept: DUPLICATE }
    );
}
