//! Comparison of complexes.

use walpha_base::random::Random;
use walpha_check::{
    Advise, Alpha, Class, CompareError, Comparison, Domain, Placed, Verdict, compare,
};

use crate::common::{Answer, Case, closed, definition, drop_row, grid, shape_of};

/// A complex without weights, at α = 0.75.
fn placed<'a>(positions: &'a [[f64; 3]], answer: &'a Answer) -> Placed<'a> {
    weighted(positions, &[0.0; 64][..positions.len()], answer)
}

fn weighted<'a>(positions: &'a [[f64; 3]], weights: &'a [f64], answer: &'a Answer) -> Placed<'a> {
    Placed::new(positions, weights, squared(0.75), &answer.complex)
}

fn squared(alpha: f64) -> Alpha {
    Alpha::from_squared(alpha).unwrap()
}

fn only(comparison: &Comparison) -> [[usize; 3]; 4] {
    comparison.dimensions.each_ref().map(|d| [d.only_a.len(), d.only_b.len(), d.classes.len()])
}

#[test]
fn the_order_of_points_does_not_count() {
    let mut random = Random::new(9);
    let mut positions = grid(3);
    let weights = vec![0.0; 27];
    let a_case = Case { positions: positions.clone(), weights: weights.clone(), alpha: 0.75 };
    random.shuffle(&mut positions);
    let b_case = Case { positions, weights, alpha: 0.75 };
    let (a, b) = (definition(&a_case).unwrap(), definition(&b_case).unwrap());
    let comparison = compare(placed(&a_case.positions, &a), placed(&b_case.positions, &b)).unwrap();
    assert!(comparison.is_equal(), "{comparison}");
    assert_eq!(comparison.domain, Domain::SameCells);
}

/// Compares a cube with the same cube cut along other diagonals, also on its faces.
#[test]
fn other_diagonals_cover_the_same() {
    let positions = grid(2);
    let weights = vec![0.0; 8];
    let case = Case { positions: positions.clone(), weights, alpha: 0.75 };
    let a = definition(&case).unwrap();
    let mirrored = positions.iter().map(|p| [-p[0], p[1], p[2]]).collect();
    let b = definition(&Case { positions: mirrored, ..case }).unwrap();
    // B's points are the same corners; only its cells were chosen elsewhere.
    let comparison = compare(placed(&positions, &a), placed(&positions, &b)).unwrap();
    assert!(!comparison.is_equal());
    assert!(
        matches!(&comparison.domain, Domain::SameRegion { six_volumes, tied: true, verdicts: Some([Verdict::Exact, Verdict::Valid]) } if six_volumes.to_string() == "6"),
        "{comparison}"
    );
    assert!(comparison.to_string().contains("same region"));
    assert!(comparison.to_string().contains("as cospherical points allow"), "{comparison}");
}

/// Flat cells between the others cover nothing, but a complex that contains them is not a triangulation.
#[test]
fn flat_cells_are_not_excused() {
    let positions = grid(2);
    let case = Case { positions: positions.clone(), weights: vec![0.0; 8], alpha: 0.75 };
    let a = definition(&case).unwrap();
    let mirrored = positions.iter().map(|p| [-p[0], p[1], p[2]]).collect();
    let b = definition(&Case { positions: mirrored, ..case }).unwrap();
    let mut flat = b.complex.clone();
    flat.cells.push([0, 1, 2, 3], Class::Interior);
    let flat = b.with(flat);
    for (one, other, verdicts, words) in [
        (&a, &flat, [Verdict::Exact, Verdict::Wrong], "but B is wrong by itself"),
        (&flat, &a, [Verdict::Wrong, Verdict::Exact], "but A is wrong by itself"),
    ] {
        let comparison = compare(placed(&positions, one), placed(&positions, other)).unwrap();
        let found = match &comparison.domain {
            Domain::SameRegion { tied: true, verdicts, .. } => *verdicts,
            other => panic!("{other}"),
        };
        assert_eq!(found, Some(verdicts), "{comparison}");
        assert!(comparison.to_string().contains(words), "{comparison}");
        assert!(!comparison.to_string().contains("as cospherical points allow"), "{comparison}");
    }
}

#[test]
fn a_missing_cell_changes_the_domain() {
    let positions = grid(2);
    let case = Case { positions, weights: vec![0.0; 8], alpha: 0.75 };
    let a = definition(&case).unwrap();
    let mut b = shape_of(&a);
    let gone = b.complex.cells.rows()[0];
    drop_row(&mut b.complex.cells, 0).unwrap();
    let comparison = compare(placed(&case.positions, &a), placed(&case.positions, &b)).unwrap();
    assert_eq!(only(&comparison), [[0; 3], [0; 3], [0; 3], [1, 0, 0]]);
    assert_eq!(comparison.dimensions[3].only_a[0].0.vertices(), gone);
    match &comparison.domain {
        Domain::Different { six_volumes_a, six_volumes_b } => {
            assert_eq!(six_volumes_a.to_string(), "6");
            assert!(["4", "5"].contains(&six_volumes_b.to_string().as_str()));
        }
        other => panic!("{other}"),
    }
}

/// Two halves of a cube: the same volume, but not the same region.
#[test]
fn equal_volumes_are_not_enough() {
    let positions = grid(2);
    let half = |cells: &[[u32; 4]]| {
        let mut complex = closed(cells);
        complex.cells.classes_mut().fill(Class::Interior);
        Answer::of(complex)
    };
    let (a, b) = (half(&[[0, 1, 2, 4]]), half(&[[7, 6, 5, 3]]));
    let comparison = compare(placed(&positions, &a), placed(&positions, &b)).unwrap();
    match &comparison.domain {
        Domain::Different { six_volumes_a, six_volumes_b } => {
            assert_eq!(six_volumes_a, six_volumes_b);
        }
        other => panic!("{other}"),
    }
}

#[test]
fn classes_and_points_that_differ() {
    let case = Case { positions: grid(2), weights: vec![0.0; 8], alpha: 0.75 };
    let a = definition(&case).unwrap();
    let mut b = shape_of(&a);
    b.complex.edges.classes_mut()[0] = Class::Singular;
    let mut more = case.positions.clone();
    more.push([5.0; 3]);
    let comparison = compare(placed(&case.positions, &a), placed(&more, &b)).unwrap();
    assert_eq!(only(&comparison), [[0; 3], [0, 0, 1], [0; 3], [0; 3]]);
    assert_eq!(comparison.points_only_b, [8]);
    assert!(!comparison.exterior);
    let json = serde_json::to_value(&comparison).unwrap();
    assert_eq!(json["dimensions"][1]["classes"][0]["b"], "singular");
    assert_eq!(json["domain"], "same_cells");
}

/// Two cells or three around the wrong diagonal of a double pyramid: the same region, and no tie.
#[test]
fn a_flip_that_is_not_delaunay_is_no_tie() {
    let positions =
        [[0.0, 0.0, 3.0], [0.0, 0.0, -3.0], [2.0, 0.0, 0.0], [-1.0, 2.0, 0.0], [-1.0, -2.0, 0.0]];
    let cells = |cells: &[[u32; 4]]| {
        let mut complex = closed(cells);
        complex.cells.classes_mut().fill(Class::Interior);
        Answer::of(complex)
    };
    let two = cells(&[[2, 3, 4, 0], [2, 4, 3, 1]]);
    let three = cells(&[[0, 1, 3, 2], [0, 1, 4, 3], [0, 1, 2, 4]]);
    let comparison = compare(placed(&positions, &two), placed(&positions, &three)).unwrap();
    assert!(matches!(comparison.domain, Domain::SameRegion { tied: false, .. }), "{comparison}");
    assert!(!comparison.to_string().contains("as cospherical points allow"), "{comparison}");
    // Weights that put all five on one sphere make it a tie: 9 − 5, and 4 − 0 and 5 − 1 about 0.
    let weights = [5.0, 5.0, 0.0, 1.0, 1.0];
    let [a, b] = [&two, &three].map(|answer| weighted(&positions, &weights, answer));
    let comparison = compare(a, b).unwrap();
    assert!(matches!(comparison.domain, Domain::SameRegion { tied: true, .. }), "{comparison}");
}

#[test]
fn weights_and_alpha_that_differ() {
    let case = Case { positions: grid(2), weights: vec![0.0; 8], alpha: 0.75 };
    let answer = definition(&case).unwrap();
    let a = placed(&case.positions, &answer);
    let higher = Placed::new(a.positions, a.weights, squared(0.8), a.complex);
    let higher = compare(a, higher).unwrap();
    assert!(!higher.is_equal());
    assert!(higher.to_string().contains("α: 0.75 in A, 0.8 in B"), "{higher}");
    let mut weights = [0.0; 8];
    weights[3] = 0.125;
    let heavier = compare(a, weighted(&case.positions, &weights, &answer)).unwrap();
    assert!(!heavier.is_equal());
    assert!(heavier.to_string().contains("point 3: 0 in A, 0.125 in B"), "{heavier}");
    // Of two points at one place, the heavier one counts.
    let twice = [&case.positions[..], &case.positions[3..4]].concat();
    let lighter = [&[0.0; 8][..], &[-1.0]].concat();
    assert!(compare(a, weighted(&twice, &lighter, &answer)).unwrap().is_equal());
}

/// One of the compared properties differs at a time, on either side.
#[test]
fn each_difference_counts_alone() {
    let case = Case { positions: grid(2), weights: vec![0.0; 8], alpha: 0.75 };
    let shape = shape_of(&definition(&case).unwrap());
    let same = placed(&case.positions, &shape);
    let differ = |other: Placed, what: &str| {
        assert!(!compare(same, other).unwrap().is_equal(), "{what}");
        assert!(!compare(other, same).unwrap().is_equal(), "{what}, on the other side");
    };
    assert!(compare(same, same).unwrap().is_equal());
    differ(Placed::new(&case.positions, &case.weights, squared(0.76), &shape.complex), "α");
    let weights = [0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0];
    differ(weighted(&case.positions, &weights, &shape), "a weight");
    let more = [&case.positions[..], &[[5.0; 3]]].concat();
    differ(placed(&more, &shape), "a point");
    let mut other = shape.clone();
    other.complex.vertices.classes_mut()[7] = Class::Singular;
    differ(placed(&case.positions, &other), "a class");
    let mut other = shape.clone();
    drop_row(&mut other.complex.facets, 2).unwrap();
    differ(placed(&case.positions, &other), "a facet");
}

/// Only where both list exterior simplices does it count that one does not have them.
#[test]
fn exterior_simplices_count_if_both_have_them() {
    let case = Case { positions: grid(2), weights: vec![0.0; 8], alpha: 0.3 };
    let whole = definition(&case).unwrap();
    let shape = shape_of(&whole);
    let (with, without) = (placed(&case.positions, &whole), placed(&case.positions, &shape));
    for (a, b) in [(with, without), (without, with)] {
        let comparison = compare(a, b).unwrap();
        assert!(!comparison.exterior);
        assert_eq!(only(&comparison), [[0; 3]; 4], "{comparison}");
    }
    let mut fewer = whole.clone();
    let cells = fewer.complex.cells.len();
    drop_row(&mut fewer.complex.cells, cells - 1).unwrap();
    let comparison = compare(with, placed(&case.positions, &fewer)).unwrap();
    assert!(comparison.exterior);
    assert_eq!(only(&comparison)[3], [1, 0, 0]);
}

#[test]
fn rows_of_points_that_do_not_exist_are_refused() {
    let case = Case { positions: grid(2), weights: vec![0.0; 8], alpha: 0.75 };
    let shape = shape_of(&definition(&case).unwrap());
    let refused = |change: fn(&mut Answer)| {
        let mut other = shape.clone();
        change(&mut other);
        let error = compare(placed(&case.positions, &shape), placed(&case.positions, &other));
        assert!(matches!(error, Err(CompareError::Index { which: 'B', .. })), "{error:?}");
    };
    refused(|other| other.complex.vertices.push([8], Class::Regular));
    refused(|other| other.complex.edges.push([0, 8], Class::Regular));
    refused(|other| other.complex.facets.push([8, 0, 1], Class::Regular));
    refused(|other| other.complex.cells.push([0, 1, 8, 2], Class::Interior));
}

#[test]
fn numbers_are_finite() {
    let case = Case { positions: grid(2), weights: vec![0.0; 8], alpha: 0.75 };
    let shape = shape_of(&definition(&case).unwrap());
    let right = placed(&case.positions, &shape);
    let (mut positions, mut weights) = (case.positions.clone(), case.weights.clone());
    (positions[5][1], weights[3]) = (f64::NAN, f64::INFINITY);
    for (wrong, number) in [
        (weighted(&positions, &case.weights, &shape), 5),
        (weighted(&case.positions, &weights, &shape), 3),
    ] {
        let error = compare(right, wrong).unwrap_err();
        assert!(matches!(error, CompareError::NotFinite { which: 'B', point } if point == number));
        assert_eq!(error.advice(), Some("remove such points from the input".into()));
    }
    let short = compare(right, weighted(&case.positions, &weights[1..], &shape)).unwrap_err();
    assert!(matches!(short, CompareError::Lengths { which: 'B', positions: 8, weights: 7 }));
    assert_eq!(short.advice(), None);
}
