//! Comparison of complexes.

mod check_common;
mod common;

use check_common::{Answer, Case, Random, closed, engine, grid, shape_of};
use walpha::Class;
use walpha::check::{Comparison, Domain, Placed, compare};

/// Without weights, at α = 0.75.
fn placed<'a>(positions: &'a [[f64; 3]], answer: &'a Answer) -> Placed<'a> {
    Placed {
        positions,
        weights: &[0.0; 64][..positions.len()],
        alpha: 0.75,
        complex: &answer.complex,
    }
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
    let (a, b) = (engine(&a_case).unwrap(), engine(&b_case).unwrap());
    let comparison = compare(placed(&a_case.positions, &a), placed(&b_case.positions, &b)).unwrap();
    assert!(comparison.is_equal(), "{comparison}");
    assert_eq!(comparison.domain, Domain::SameCells);
}

/// The same cube cut along other diagonals, also on its faces.
#[test]
fn other_diagonals_cover_the_same() {
    let positions = grid(2);
    let weights = vec![0.0; 8];
    let case = Case { positions: positions.clone(), weights, alpha: 0.75 };
    let a = engine(&case).unwrap();
    let mirrored = positions.iter().map(|p| [-p[0], p[1], p[2]]).collect();
    let b = engine(&Case { positions: mirrored, ..case }).unwrap();
    // B's points are the same corners; only its cells were chosen elsewhere.
    let comparison = compare(placed(&positions, &a), placed(&positions, &b)).unwrap();
    assert!(!comparison.is_equal());
    assert!(
        matches!(&comparison.domain, Domain::SameRegion { six_volumes, tied: true } if six_volumes.to_string() == "6"),
        "{comparison}"
    );
    assert!(comparison.to_string().contains("same region"));
}

#[test]
fn a_missing_cell_changes_the_domain() {
    let positions = grid(2);
    let case = Case { positions, weights: vec![0.0; 8], alpha: 0.75 };
    let a = engine(&case).unwrap();
    let mut b = shape_of(&a);
    let gone = b.complex.cells.vertices.remove(0);
    b.complex.cells.classes.remove(0);
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
        complex.cells.classes.fill(Class::Interior);
        Answer { complex, hidden: Vec::new(), duplicates: Vec::new() }
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
    let a = engine(&case).unwrap();
    let mut b = shape_of(&a);
    b.complex.edges.classes[0] = Class::Singular;
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
        complex.cells.classes.fill(Class::Interior);
        Answer { complex, hidden: Vec::new(), duplicates: Vec::new() }
    };
    let two = cells(&[[2, 3, 4, 0], [2, 4, 3, 1]]);
    let three = cells(&[[0, 1, 3, 2], [0, 1, 4, 3], [0, 1, 2, 4]]);
    let comparison = compare(placed(&positions, &two), placed(&positions, &three)).unwrap();
    assert!(matches!(comparison.domain, Domain::SameRegion { tied: false, .. }), "{comparison}");
    assert!(!comparison.to_string().contains("as cospherical points allow"), "{comparison}");
    // Weights that put all five on one sphere make it a tie: 9 − 5, and 4 − 0 and 5 − 1 about 0.
    let weights = [5.0, 5.0, 0.0, 1.0, 1.0];
    let [a, b] =
        [&two, &three].map(|answer| Placed { weights: &weights, ..placed(&positions, answer) });
    let comparison = compare(a, b).unwrap();
    assert!(matches!(comparison.domain, Domain::SameRegion { tied: true, .. }), "{comparison}");
}

#[test]
fn weights_and_alpha_that_differ() {
    let case = Case { positions: grid(2), weights: vec![0.0; 8], alpha: 0.75 };
    let answer = engine(&case).unwrap();
    let a = placed(&case.positions, &answer);
    let higher = compare(a, Placed { alpha: 0.8, ..a }).unwrap();
    assert!(!higher.is_equal());
    assert!(higher.to_string().contains("α: 0.75 in A, 0.8 in B"), "{higher}");
    let mut weights = [0.0; 8];
    weights[3] = 0.125;
    let heavier = compare(a, Placed { weights: &weights, ..a }).unwrap();
    assert!(!heavier.is_equal());
    assert!(heavier.to_string().contains("point 3: 0 in A, 0.125 in B"), "{heavier}");
    // Of two points in one place the heavier counts.
    let twice = [&case.positions[..], &case.positions[3..4]].concat();
    let lighter = [&[0.0; 8][..], &[-1.0]].concat();
    let b = Placed { positions: &twice, weights: &lighter, ..a };
    assert!(compare(a, b).unwrap().is_equal());
}

/// The command says what it compared, and fails where that differs.
#[test]
fn the_command_compares_weights_and_alpha() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, weight: f64, alpha: f64| {
        let points = "[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]";
        let text = format!(
            r#"{{"points":{points},"weights":[{weight},0,0,0],"alpha":{alpha},"cells":[[0,1,2,3]]}}"#
        );
        std::fs::write(folder.path().join(name), text).unwrap();
    };
    write("a.json", 0.0, 1.0);
    write("heavy.json", 0.25, 1.0);
    write("high.json", 0.0, 2.0);
    for (other, code, words) in [
        ("a.json", 0, "equal in all that was compared"),
        ("heavy.json", 3, "weights that differ: 1"),
        ("high.json", 3, "α: 1 in A, 2 in B"),
    ] {
        let (got, stdout, _) = common::run(folder.path(), &["compare", "a.json", other]);
        assert_eq!(got, code, "{stdout}");
        assert!(stdout.contains(words), "{stdout}");
        assert!(stdout.contains("not compared: "), "{stdout}");
    }
}
