//! For each rule of certification, a wrong complex that breaks it.

mod common;

use std::sync::LazyLock;

use common::{Answer, Case, closed, definition, drop_row, grid, shape_of, sorted};
use walpha_check::schema::ComplexFile;
use walpha_check::{Claim, Class, Complex, Extent, Finding, Simplices};

const HIDDEN: u32 = 28;
const DUPLICATE: u32 = 29;

/// A 3×3×3 grid at its critical α, a far point, a hidden point and a lighter duplicate of point 0:
/// all classes occur.
fn base() -> (Case, Answer) {
    static BASE: LazyLock<(Case, Answer)> = LazyLock::new(make_base);
    BASE.clone()
}

fn make_base() -> (Case, Answer) {
    let mut positions = grid(3);
    positions.extend([[9.0, 1.0, 1.0], [0.5, 0.5, 0.5], [0.0, 0.0, 0.0]]);
    let mut weights = vec![0.0; 30];
    weights[HIDDEN as usize] = -2.0;
    weights[DUPLICATE as usize] = -1.0;
    let case = Case { positions, weights, alpha: 0.75 };
    let answer = definition(&case).unwrap();
    assert_eq!(answer.hidden, [HIDDEN]);
    assert_eq!(answer.duplicates, [[DUPLICATE, 0]]);
    assert_eq!(findings(&case, &answer, Extent::Whole), []);
    (case, answer)
}

fn findings(case: &Case, answer: &Answer, extent: Extent) -> Vec<Finding> {
    let claim = case.claim(answer, extent);
    let (findings, certificate) = claim.findings().unwrap();
    assert_eq!(certificate.findings, findings.len());
    assert_eq!(claim.is_valid().unwrap(), findings.is_empty());
    assert_eq!(claim.first_finding().unwrap().as_ref(), findings.first());
    for finding in &findings {
        let line = finding.to_string();
        assert!(line.len() > 20 && !line.contains('\n'), "{line}");
    }
    findings
}

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
    found!(|_, a| a.complex.edges.rows_mut()[3][1] = 99, Finding::Index { points: 30, .. });
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

#[test]
fn each_missing_face() {
    let (case, answer) = base();
    for dimension in 0..3 {
        for row in 0.. {
            let mut mutated = answer.complex.clone();
            let dropped = match dimension {
                0 => drop_row(&mut mutated.vertices, row),
                1 => drop_row(&mut mutated.edges, row),
                _ => drop_row(&mut mutated.facets, row),
            };
            let Some(dropped) = dropped else {
                assert!(row > 20);
                break;
            };
            let all = findings(&case, &answer.with(mutated), Extent::Whole);
            let is_it = |f: &Finding| matches!(f, Finding::MissingFace { face, .. } if sorted(face.vertices()) == dropped);
            assert!(all.iter().any(is_it), "{dropped:?}: {all:?}");
        }
    }
}

#[test]
fn each_dropped_cell() {
    let (case, answer) = base();
    for row in 0..answer.complex.cells.len() {
        let mut mutated = answer.complex.clone();
        let dropped = drop_row(&mut mutated.cells, row).unwrap();
        let all = findings(&case, &answer.with(mutated), Extent::Whole);
        assert!(is_missing(&all, &dropped), "{dropped:?}: {all:?}");
    }
    let shape = shape_of(&answer);
    for row in 0..shape.complex.cells.len() {
        let mut mutated = shape.complex.clone();
        let dropped = drop_row(&mut mutated.cells, row).unwrap();
        let all = findings(&case, &answer.with(mutated), Extent::Shape);
        assert!(is_missing(&all, &dropped), "{dropped:?}: {all:?}");
    }
}

/// One finding, and the true one.
fn is_missing(all: &[Finding], dropped: &[u32]) -> bool {
    matches!(all, [Finding::MissingCell { cell, .. }] if sorted(cell.vertices()) == dropped)
}

/// Also where classes were made from the cells that are left.
#[test]
fn each_dropped_cell_of_a_file_without_classes() {
    let (case, answer) = base();
    let shape = shape_of(&answer);
    let mut whole = ComplexFile::new(Claim::new(case.placed(&shape.complex)));
    whole.classes = Default::default();
    for row in 0..shape.complex.cells.len() {
        let mut file = whole.clone();
        let dropped = sorted(&file.cells.as_mut().unwrap().remove(row));
        let complex = file.into_complex().unwrap().complex;
        let all = findings(&case, &answer.with(complex), Extent::Shape);
        assert!(is_missing(&all, &dropped), "{dropped:?}: {all:?}");
    }
}

/// A cell that α leaves out is no gap, and nor are several cells that only look like one.
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

/// Also when every face that only the dropped cell had goes with it.
#[test]
fn each_cell_dropped_with_its_faces() {
    let (mut case, mut answer) = base();
    case.alpha = f64::NEG_INFINITY;
    answer.complex = closed(answer.complex.cells.rows());
    assert_eq!(findings(&case, &answer, Extent::Whole), []);
    for row in 0..answer.complex.cells.len() {
        let mut cells = answer.complex.cells.rows().to_vec();
        cells.remove(row);
        let all = findings(&case, &answer.with(closed(&cells)), Extent::Whole);
        let geometric = |f: &Finding| {
            matches!(
                f,
                Finding::HullBends { .. }
                    | Finding::HullEdge { .. }
                    | Finding::HullWraps { .. }
                    | Finding::OutsideHull { .. }
                    | Finding::MissingCell { .. }
            )
        };
        assert!(all.iter().any(geometric), "{all:?}");
    }
}

#[test]
fn each_flipped_class() {
    let (case, answer) = base();
    let shape = shape_of(&answer);
    for (answer, extent) in [(&answer, Extent::Whole), (&shape, Extent::Shape)] {
        let c = &answer.complex;
        let counts = [c.cells.len(), c.facets.len(), c.edges.len(), c.vertices.len()];
        for (kind, count) in counts.into_iter().enumerate() {
            for row in 0..count {
                for class in Class::ALL {
                    let mut mutated = answer.complex.clone();
                    let (slot, simplex) = match kind {
                        0 => class_of(&mut mutated.cells, row),
                        1 => class_of(&mut mutated.facets, row),
                        2 => class_of(&mut mutated.edges, row),
                        _ => class_of(&mut mutated.vertices, row),
                    };
                    let right = std::mem::replace(slot, class);
                    if right == class {
                        continue;
                    }
                    let all = findings(&case, &answer.with(mutated), extent);
                    assert!(
                        matches!(&all[..], [Finding::Class { simplex: s, given, expected, .. }]
                            if s.vertices() == simplex && *given == class && *expected == right),
                        "{all:?}"
                    );
                }
            }
        }
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
    // On the sphere, where the perturbation decides.
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
        Finding::DuplicateVertex { point: 0, stays: DUPLICATE }
    );
}

fn class_of<const N: usize>(s: &mut Simplices<N>, row: usize) -> (&mut Class, Vec<u32>) {
    let simplex = s.rows()[row].to_vec();
    (&mut s.classes_mut()[row], simplex)
}
