//! For each rule of certification, a wrong complex that breaks it.

mod check_common;

use check_common::{Answer, Case, closed, engine, grid, shape_of};
use walpha::check::{Claim, Extent, Finding};
use walpha::{Class, Complex};

const HIDDEN: u32 = 28;
const DUPLICATE: u32 = 29;

/// A 3×3×3 grid at its critical α, a far point, a hidden point and a lighter duplicate of point 0:
/// all classes occur.
fn base() -> (Case, Answer) {
    let mut positions = grid(3);
    positions.extend([[9.0, 1.0, 1.0], [0.5, 0.5, 0.5], [0.0, 0.0, 0.0]]);
    let mut weights = vec![0.0; 30];
    weights[HIDDEN as usize] = -2.0;
    weights[DUPLICATE as usize] = -1.0;
    let case = Case { positions, weights, alpha: 0.75 };
    let answer = engine(&case).unwrap();
    assert_eq!(answer.hidden, [HIDDEN]);
    assert_eq!(answer.duplicates, [[DUPLICATE, 0]]);
    assert_eq!(findings(&case, &answer, Extent::Whole), []);
    (case, answer)
}

fn findings(case: &Case, answer: &Answer, extent: Extent) -> Vec<Finding> {
    let claim = Claim {
        positions: &case.positions,
        weights: &case.weights,
        alpha: case.alpha,
        complex: &answer.complex,
        extent,
        hidden: Some(&answer.hidden),
        duplicates: Some(&answer.duplicates),
    };
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
    found!(|_, a| a.complex.edges.vertices[3][1] = 99, Finding::Index { points: 30, .. });
}

#[test]
fn a_vertex_named_twice() {
    found!(
        |_, a| {
            let row = &mut a.complex.facets.vertices[0];
            row[1] = row[0];
        },
        Finding::RepeatedVertex { .. }
    );
}

#[test]
fn a_facet_listed_twice() {
    found!(
        |_, a| {
            a.complex.facets.vertices.push(a.complex.facets.vertices[5]);
            a.complex.facets.classes.push(a.complex.facets.classes[5]);
        },
        Finding::RepeatedSimplex { .. }
    );
}

#[test]
fn a_cell_listed_twice_crowds_facets_and_fills_too_much() {
    let twice: fn(&mut Case, &mut Answer) = |_, a| {
        a.complex.cells.vertices.push(a.complex.cells.vertices[5]);
        a.complex.cells.classes.push(a.complex.cells.classes[5]);
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
            let all = findings(&case, &with(&answer, mutated), Extent::Whole);
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
        let all = findings(&case, &with(&answer, mutated), Extent::Whole);
        assert!(is_missing(&all, &dropped), "{dropped:?}: {all:?}");
    }
    let shape = shape_of(&answer);
    for row in 0..shape.complex.cells.len() {
        let mut mutated = shape.complex.clone();
        let dropped = drop_row(&mut mutated.cells, row).unwrap();
        let all = findings(&case, &with(&answer, mutated), Extent::Shape);
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
    use walpha::check::schema::ComplexFile;
    let (case, answer) = base();
    let shape = shape_of(&answer);
    let (positions, weights) = (&case.positions, &case.weights);
    let mut whole = ComplexFile::new(positions, weights, case.alpha, &shape.complex, None, None);
    whole.classes = Default::default();
    for row in 0..shape.complex.cells.len() {
        let mut file = whole.clone();
        let dropped = sorted(&file.cells.as_mut().unwrap().remove(row));
        let complex = file.into_complex().unwrap().complex;
        let all = findings(&case, &with(&answer, complex), Extent::Shape);
        assert!(is_missing(&all, &dropped), "{dropped:?}: {all:?}");
    }
}

/// A cell that α leaves out is no gap, and nor are several cells that only look like one.
#[test]
fn facets_around_nothing_are_no_gap() {
    let (mut case, answer) = base();
    case.alpha = 0.74;
    let facets = answer.complex.facets.vertices.clone();
    let mut complex = Complex::default();
    for facet in facets {
        complex.facets.vertices.push(facet);
        complex.facets.classes.push(Class::Singular);
    }
    let all = findings(&case, &with(&answer, complex), Extent::Shape);
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
    let row = shape.complex.vertices.vertices.iter().position(|v| *v == [27]).unwrap();
    assert_eq!(shape.complex.vertices.classes[row], Class::Singular);
    drop_row(&mut shape.complex.vertices, row);
    for hidden in [vec![HIDDEN], vec![HIDDEN, 27]] {
        let listed = Answer { hidden, ..with(&answer, shape.complex.clone()) };
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
    answer.complex = closed(&answer.complex.cells.vertices);
    assert_eq!(findings(&case, &answer, Extent::Whole), []);
    for row in 0..answer.complex.cells.len() {
        let mut cells = answer.complex.cells.vertices.clone();
        cells.remove(row);
        let all = findings(&case, &with(&answer, closed(&cells)), Extent::Whole);
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
                    let all = findings(&case, &with(answer, mutated), extent);
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
            a.complex.edges.vertices.push([0, 26]);
            a.complex.edges.classes.push(Class::Exterior);
        },
        Finding::Stray { .. }
    );
    found!(
        |_, a| {
            a.complex.facets.vertices.push([0, 1, 2]);
            a.complex.facets.classes.push(Class::Exterior);
        },
        Finding::Stray { simplex } if simplex.vertices() == [0, 1, 2]
    );
}

#[test]
fn a_hidden_point_as_vertex() {
    let vertex: fn(&mut Case, &mut Answer) = |_, a| {
        a.complex.vertices.vertices.push([HIDDEN]);
        a.complex.vertices.classes.push(Class::Exterior);
    };
    found!(vertex, Finding::Stray { .. });
    found!(vertex, Finding::NotOnlyHidden { point: HIDDEN });
}

#[test]
fn a_cell_turned_over() {
    found!(|_, a| a.complex.cells.vertices[7].swap(2, 3), Finding::Orientation { .. });
}

#[test]
fn a_boundary_facet_turned_over() {
    found!(
        |_, a| {
            let row = a.complex.facets.classes.iter().position(|c| *c == Class::Regular).unwrap();
            a.complex.facets.vertices[row].swap(1, 2);
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

/// All cells, exterior, of a triangulation of points without weights.
fn triangulation(positions: Vec<[f64; 3]>, cells: &[[u32; 4]]) -> (Case, Answer) {
    let weights = vec![0.0; positions.len()];
    let answer = Answer { complex: closed(cells), hidden: Vec::new(), duplicates: Vec::new() };
    (Case { positions, weights, alpha: f64::NEG_INFINITY }, answer)
}

/// The cube cut along the diagonals of its mirror image: a Delaunay triangulation too, but not the
/// one that the perturbation chooses.
#[test]
fn a_cube_with_other_diagonals() {
    let positions = grid(2);
    let mirrored = positions.iter().map(|p| [-p[0], p[1], p[2]]).collect();
    let alpha = f64::NEG_INFINITY;
    let mirror = engine(&Case { positions: mirrored, weights: vec![0.0; 8], alpha }).unwrap();
    let cells: Vec<_> =
        mirror.complex.cells.vertices.iter().map(|&[a, b, c, d]| [a, b, d, c]).collect();
    let (case, answer) = triangulation(positions, &cells);
    let all = findings(&case, &answer, Extent::Whole);
    let tied = |f: &Finding| matches!(f, Finding::NotRegular { power, .. } if power.is_zero());
    assert!(!all.is_empty() && all.iter().all(tied), "{all:?}");

    // The shape alone is judged by the same rule.
    let whole_cube = Case { alpha: 0.75, ..case };
    let mut complex = closed(&cells);
    for class in complex.cells.classes.iter_mut() {
        *class = Class::Interior;
    }
    let all = findings(&whole_cube, &with(&answer, complex), Extent::Shape);
    assert!(all.iter().any(tied), "{all:?}");
}

/// Two cells around the wrong one of two diagonals, far from any tie.
#[test]
fn a_cell_that_is_not_regular() {
    let positions = vec![
        [0.0, 0.0, 3.0],
        [0.0, 0.0, -3.0],
        [2.0, 0.0, 0.0],
        [-1.0, 2.0, 0.0],
        [-1.0, -2.0, 0.0],
    ];
    let (case, answer) = triangulation(positions, &[[2, 3, 4, 0], [2, 4, 3, 1]]);
    assert_eq!(findings(&case, &answer, Extent::Whole), []);
    let (case, answer) = triangulation(case.positions, &[[0, 1, 3, 2], [0, 1, 4, 3], [0, 1, 2, 4]]);
    let all = findings(&case, &answer, Extent::Whole);
    assert!(
        all.iter().any(|f| matches!(f, Finding::NotRegular { power, .. } if !power.is_zero())),
        "{all:?}"
    );
}

#[test]
fn two_cells_on_one_side_of_a_facet() {
    let positions =
        vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 4.0], [1.0, 1.0, 9.0]];
    let (case, answer) = triangulation(positions, &[[0, 1, 2, 3], [0, 1, 2, 4]]);
    let all = findings(&case, &answer, Extent::Whole);
    assert!(all.iter().any(|f| matches!(f, Finding::Overlap { .. })), "{all:?}");
}

#[test]
fn a_hull_pinched_at_an_edge() {
    let positions = vec![
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 4.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [-1.0, 0.0, 0.0],
        [-1.0, -1.0, 0.0],
    ];
    let (case, answer) = triangulation(positions, &[[0, 2, 3, 1], [0, 4, 5, 1]]);
    let all = findings(&case, &answer, Extent::Whole);
    assert!(all.iter().any(|f| matches!(f, Finding::HullEdge { facets: 4, .. })), "{all:?}");
}

#[test]
fn a_hull_that_bends_inwards() {
    let mut positions = grid(2);
    positions.truncate(4);
    positions.extend([[0.25, 0.25, 1.0], [0.5, 0.5, 9.0]]);
    let (case, answer) = triangulation(positions, &[[0, 1, 2, 4], [1, 2, 4, 5]]);
    let all = findings(&case, &answer, Extent::Whole);
    assert!(all.iter().any(|f| matches!(f, Finding::HullBends { .. })), "{all:?}");
}

/// Five cells along the edges of a pentagram, twice around their common edge: convex everywhere,
/// but a double cover.
#[test]
fn a_hull_that_goes_around_twice() {
    let positions = vec![
        [0.0, 0.0, 9.0],
        [0.0, 0.0, -9.0],
        [0.0, 10.0, 0.0],
        [-6.0, -8.0, 0.0],
        [10.0, 3.0, 0.0],
        [-10.0, 3.0, 0.0],
        [6.0, -8.0, 0.0],
    ];
    let cells = [[1, 0, 2, 3], [1, 0, 3, 4], [1, 0, 4, 5], [1, 0, 5, 6], [1, 0, 6, 2]];
    let (case, answer) = triangulation(positions, &cells);
    let all = findings(&case, &answer, Extent::Whole);
    assert!(all.iter().any(|f| matches!(f, Finding::HullWraps { .. })), "{all:?}");
    assert!(!all.iter().any(|f| matches!(f, Finding::HullBends { .. })), "{all:?}");
}

/// A cell of the right size in the shape, with a point inside its sphere that no facet leads to.
#[test]
fn a_cell_of_the_shape_with_a_point_inside() {
    let mut positions = grid(2);
    positions.truncate(5);
    positions.push([0.9, 0.9, 0.9]);
    let weights = vec![0.0; 6];
    let case = Case { positions, weights, alpha: 0.75 };
    let mut complex = closed(&[[0, 1, 2, 4]]);
    complex.cells.classes[0] = Class::Interior;
    complex.facets.classes.fill(Class::Regular);
    complex.edges.classes.fill(Class::Regular);
    complex.vertices.classes.fill(Class::Regular);
    let answer = Answer { complex, hidden: Vec::new(), duplicates: Vec::new() };
    let all = findings(&case, &answer, Extent::Shape);
    assert!(all.iter().any(|f| matches!(f, Finding::NotRegular { point: 5, .. })), "{all:?}");
}

fn with(answer: &Answer, complex: Complex) -> Answer {
    let (hidden, duplicates) = (answer.hidden.clone(), answer.duplicates.clone());
    Answer { complex, hidden, duplicates }
}

fn drop_row<const N: usize>(s: &mut walpha::Simplices<N>, row: usize) -> Option<Vec<u32>> {
    (row < s.len()).then(|| {
        s.classes.remove(row);
        sorted(&s.vertices.remove(row))
    })
}

fn class_of<const N: usize>(s: &mut walpha::Simplices<N>, row: usize) -> (&mut Class, Vec<u32>) {
    (&mut s.classes[row], s.vertices[row].to_vec())
}

fn sorted(row: &[u32]) -> Vec<u32> {
    let mut row = row.to_vec();
    row.sort_unstable();
    row
}
