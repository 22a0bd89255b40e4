//! Small triangulations by hand that break a rule of geometry.

use walpha_check::{Class, Extent, Finding};

use crate::common::{Answer, Case, closed, definition, grid};

/// A triangulation of points without weights. All cells are exterior.
fn triangulation(positions: Vec<[f64; 3]>, cells: &[[u32; 4]]) -> (Case, Answer) {
    let weights = vec![0.0; positions.len()];
    (Case { positions, weights, alpha: f64::NEG_INFINITY }, Answer::of(closed(cells)))
}

/// The cube cut along the diagonals of its mirror image: a Delaunay triangulation too, but not the
/// one that the perturbation chooses.
#[test]
fn a_cube_with_other_diagonals() {
    let positions = grid(2);
    let mirrored = positions.iter().map(|p| [-p[0], p[1], p[2]]).collect();
    let alpha = f64::NEG_INFINITY;
    let mirror = definition(&Case { positions: mirrored, weights: vec![0.0; 8], alpha }).unwrap();
    let cells: Vec<_> =
        mirror.complex.cells.rows().iter().map(|&[a, b, c, d]| [a, b, d, c]).collect();
    let (case, answer) = triangulation(positions, &cells);
    let all = case.findings(&answer, Extent::Whole);
    let tied = |f: &Finding| matches!(f, Finding::NotRegular { power, .. } if power.is_zero());
    assert!(!all.is_empty() && all.iter().all(tied), "{all:?}");

    // The shape alone is judged by the same rule.
    let whole_cube = Case { alpha: 0.75, ..case };
    let mut complex = closed(&cells);
    complex.cells.classes_mut().fill(Class::Interior);
    let all = whole_cube.findings(&answer.with(complex), Extent::Shape);
    assert!(all.iter().any(tied), "{all:?}");
}

/// Far above and below a triangle.
fn bipyramid() -> Vec<[f64; 3]> {
    vec![[0.0, 0.0, 3.0], [0.0, 0.0, -3.0], [2.0, 0.0, 0.0], [-1.0, 2.0, 0.0], [-1.0, -2.0, 0.0]]
}

/// Two cells around the wrong one of two diagonals, far from any tie.
#[test]
fn a_cell_that_is_not_regular() {
    let (case, answer) = triangulation(bipyramid(), &[[2, 3, 4, 0], [2, 4, 3, 1]]);
    assert_eq!(case.findings(&answer, Extent::Whole), []);
    let (case, answer) = triangulation(case.positions, &[[0, 1, 3, 2], [0, 1, 4, 3], [0, 1, 2, 4]]);
    let all = case.findings(&answer, Extent::Whole);
    assert!(
        all.iter().any(|f| matches!(f, Finding::NotRegular { power, .. } if !power.is_zero())),
        "{all:?}"
    );
}

/// A gap is a missing cell only where the cell would be regular.
#[test]
fn a_gap_that_no_cell_fills() {
    let missing = |cells: &[[u32; 4]]| {
        let (case, mut answer) = triangulation(bipyramid(), cells);
        answer.complex.cells = answer.complex.cells.iter().skip(1).map(|(&c, k)| (c, k)).collect();
        let all = case.findings(&answer, Extent::Whole);
        assert!(!all.is_empty());
        all.iter().filter(|found| matches!(found, Finding::MissingCell { .. })).count()
    };
    assert_eq!(missing(&[[2, 3, 4, 0], [2, 4, 3, 1]]), 1);
    assert_eq!(missing(&[[0, 1, 3, 2], [0, 1, 4, 3], [0, 1, 2, 4]]), 0);
}

#[test]
fn two_cells_on_one_side_of_a_facet() {
    let positions =
        vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 4.0], [1.0, 1.0, 9.0]];
    let (case, answer) = triangulation(positions, &[[0, 1, 2, 3], [0, 1, 2, 4]]);
    let all = case.findings(&answer, Extent::Whole);
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
    let all = case.findings(&answer, Extent::Whole);
    assert!(all.iter().any(|f| matches!(f, Finding::HullEdge { facets: 4, .. })), "{all:?}");
}

#[test]
fn a_hull_that_bends_inwards() {
    let mut positions = grid(2);
    positions.truncate(4);
    positions.extend([[0.25, 0.25, 1.0], [0.5, 0.5, 9.0]]);
    let (case, answer) = triangulation(positions, &[[0, 1, 2, 4], [1, 2, 4, 5]]);
    let all = case.findings(&answer, Extent::Whole);
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
    let all = case.findings(&answer, Extent::Whole);
    assert!(all.iter().any(|f| matches!(f, Finding::HullWraps { .. })), "{all:?}");
    assert!(!all.iter().any(|f| matches!(f, Finding::HullBends { .. })), "{all:?}");
}

/// Each is convex, and the ray from within the first meets nothing of the second.
#[test]
fn two_separate_hulls_are_not_one_hull() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let far = corners.map(|[x, y, z]| [x + 100.0, y + 30.0, z]);
    let (case, answer) = triangulation([corners, far].concat(), &[[0, 1, 2, 3], [4, 5, 6, 7]]);
    let all = case.findings(&answer, Extent::Whole);
    assert!(all.iter().any(|f| matches!(f, Finding::HullWraps { .. })), "{all:?}");
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
    complex.cells.classes_mut()[0] = Class::Interior;
    complex.facets.classes_mut().fill(Class::Regular);
    complex.edges.classes_mut().fill(Class::Regular);
    complex.vertices.classes_mut().fill(Class::Regular);
    let all = case.findings(&Answer::of(complex), Extent::Shape);
    assert!(all.iter().any(|f| matches!(f, Finding::NotRegular { point: 5, .. })), "{all:?}");
}
