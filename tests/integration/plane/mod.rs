//! Shapes in the plane against their definitions, degenerate sets above all.

mod brute;
mod hull;
mod laws;
mod union;
mod weighted;

use brute::Point;
use proptest::prelude::*;
use walpha::Alpha;
use walpha::reproduce::plane::{
    Curvature, EksShape, WeightedPlaneShape, eks_shape, sample_discs, sample_points,
    weighted_plane_shape,
};

fn places(points: &[Point]) -> Vec<[f64; 2]> {
    points.iter().map(|p| p.map(|v| v as f64)).collect()
}

fn eks(points: &[[f64; 2]], alpha: f64) -> EksShape {
    eks_shape(points, Curvature::new(alpha).unwrap()).unwrap()
}

fn agrees(points: &[Point], alpha: f64) {
    let expected = brute::eks(points, alpha);
    let shape = eks(&places(points), alpha);
    let found = brute::Eks {
        edges: shape.edges().iter().copied().collect(),
        extreme: shape.extreme().iter().copied().collect(),
    };
    assert_eq!(found, expected, "points {points:?}, α = {alpha}");
    assert_eq!(shape.no_disc().is_some(), expected.extreme.is_empty());
}

fn weighted(points: &[[f64; 2]], weights: &[f64], alpha: f64) -> WeightedPlaneShape {
    weighted_plane_shape(points, weights, Alpha::from_squared(alpha).unwrap()).unwrap()
}

/// Lattice points: collinear runs, cocircular squares, duplicates.
fn lattice() -> impl Strategy<Value = Vec<Point>> {
    prop::collection::vec([0..6i64, 0..6i64], 1..18)
}

/// Points in general position, most of the time.
fn scattered() -> impl Strategy<Value = Vec<Point>> {
    prop::collection::vec([0..1000i64, 0..1000i64], 1..25)
}

#[test]
fn degenerate_sets_agree_with_the_definition() {
    let grid: Vec<Point> = (0..25).map(|k| [k % 5, k / 5]).collect();
    let line: Vec<Point> = (0..6).map(|k| [2 * k, k]).collect();
    let diamond = vec![[1, 0], [0, 1], [-1, 0], [0, -1]];
    let diamonds: Vec<Point> =
        diamond.iter().flat_map(|&[x, y]| [[x, y], [2 * x, 2 * y], [4 * x, 4 * y]]).collect();
    let circle: Vec<Point> = (-5..=5)
        .flat_map(|x| (-5..=5).map(move |y| [x, y]))
        .filter(|&[x, y]| x * x + y * y == 25)
        .collect();
    let centred: Vec<Point> = circle.iter().copied().chain([[0, 0]]).collect();
    let twice: Vec<Point> = diamond.iter().copied().cycle().take(8).collect();
    let sets =
        [grid, line, diamond, diamonds, circle, centred, twice, vec![[3, 4]], vec![[0, 0], [4, 0]]];
    // 1/α is critical for many of them: half of a distance along an axis.
    let critical: [f64; 9] = [0.125, 0.25, 0.5, 1.0, 2.0, 0.2, 0.4, 1.5, 1e-3];
    for points in &sets {
        agrees(points, 0.0);
        for alpha in critical {
            for alpha in [alpha.next_down(), alpha, alpha.next_up()] {
                agrees(points, alpha);
                agrees(points, -alpha);
            }
        }
    }
}

#[test]
fn a_critical_disc_joins_all_it_touches() {
    let diamond = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let all = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    let sides = [[0, 1], [0, 3], [1, 2], [2, 3]];
    assert_eq!(eks(&diamond, 1.0).edges(), all);
    assert_eq!(eks(&diamond, -1.0).edges(), all);
    assert_eq!(eks(&diamond, 1f64.next_down()).edges(), sides);
    assert_eq!(eks(&diamond, (-1f64).next_up()).edges(), sides);
    let empty = eks(&diamond, 1f64.next_up());
    let why = empty.no_disc().expect("no disc holds the diamond");
    assert_eq!(why.enclosing, 1.0);
    assert!(why.to_string().contains("choose α ≤ 1/ρ"), "{why}");
    assert_eq!(empty.hull().outline, []);

    // The inside goes when the disc between the four points fits, and not before.
    assert_eq!(eks(&diamond, -1.0).triangles().len(), 0);
    assert_eq!(eks(&diamond, (-1f64).next_up()).triangles().len(), 2);
    assert_eq!(eks(&diamond, 1.0).triangles().len(), 2);
}

#[test]
fn bad_input_is_refused() {
    let one = Curvature::new(1.0).unwrap();
    assert!(eks_shape(&[], one).unwrap_err().to_string().contains("at least 1"));
    for value in [f64::NAN, f64::INFINITY, -1e300] {
        let error = eks_shape(&[[0.0, 0.0], [0.0, value]], one).unwrap_err();
        assert!(error.to_string().contains("point 1 has y"), "{error}");
        let alpha = Alpha::from_squared(1.0).unwrap();
        assert!(weighted_plane_shape(&[[0.0, value]], &[0.0], alpha).is_err());
    }
    let error = weighted_plane_shape(&[[0.0; 2]], &[0.0], Alpha::INFINITE).unwrap_err();
    assert!(error.to_string().contains("finite α"), "{error}");
    for alpha in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 5e-324, f64::MAX] {
        assert!(Curvature::new(alpha).is_err());
    }
}

#[test]
fn huge_tiny_and_close_numbers_are_told_apart() {
    // One ulp decides whether the angle is right, and so on which side the disc lies.
    let near = 1f64.next_up();
    for scale in [1.0, 2f64.powi(-490), 2f64.powi(490)] {
        let at = |points: [[f64; 2]; 3]| points.map(|p| p.map(|v| v * scale));
        let right = at([[-1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        let acute = at([[-1.0, 0.0], [1.0, 0.0], [0.0, near]]);
        assert_eq!(eks(&right, 1.0 / scale).edges(), [[0, 1], [0, 2], [1, 2]]);
        assert!(eks(&acute, 1.0 / scale).no_disc().is_some());
        assert_eq!(eks(&acute, -1.0 / scale).edges(), [[0, 1], [0, 2], [1, 2]]);
        assert_eq!(eks(&acute, -1.0 / scale).triangles().len(), 0);
    }
    let tiny = 1e-300f64;
    let hull = |y: f64| {
        let shape = eks(&[[0.0, 0.0], [tiny, y], [1e150, tiny], [1e150, 1e150]], 0.0);
        (shape.edges().to_vec(), shape.extreme().to_vec())
    };
    assert_eq!(hull(tiny.next_down()), (vec![[0, 2], [0, 3], [2, 3]], vec![0, 2, 3]));
    let on_side = vec![[0, 1], [0, 2], [0, 3], [1, 3], [2, 3]];
    assert_eq!(hull(tiny), (on_side, vec![0, 1, 2, 3]));
    let corner = vec![[0, 1], [0, 2], [1, 3], [2, 3]];
    assert_eq!(hull(tiny.next_up()), (corner, vec![0, 1, 2, 3]));
}

#[test]
fn samples_show_what_they_promise() {
    let points = sample_points();
    assert_eq!(points.len(), 60);
    let islands = eks(&points, -1.0);
    assert!(!islands.triangles().is_empty() && islands.extreme().len() < 60);
    assert_eq!(eks(&points, 0.0).triangles().len() + 2, 2 * 60 - eks(&points, 0.0).extreme().len());
    assert!(eks(&points, 1.0).no_disc().is_some());
    let (points, weights) = sample_discs();
    let shape = weighted(&points, &weights, 1.0);
    let complex = shape.complex();
    assert_eq!(points.len(), 14);
    assert_eq!(shape.hidden().len(), 1);
    assert!(!complex.triangles.is_empty());
    assert!(complex.edges.counts().singular > 0);
    assert_eq!(complex.vertices.counts().singular, 1);
    assert_eq!(complex.betti(), [2, 1]);
}
