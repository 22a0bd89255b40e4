//! Shapes in the plane against their definitions, degenerate sets above all; hulls of arcs, and laws.

mod brute;
mod weighted;

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use proptest::prelude::*;
use walpha::Alpha;
use walpha::reproduce::plane::{
    Curvature, EksShape, OutlinePiece, WeightedPlaneShape, eks_shape, sample_discs, sample_points,
    weighted_plane_shape,
};

use brute::Point;

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
    // One ulp decides whether the angle is right, and therefore on which side the disc lies.
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

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, ..ProptestConfig::default() })]

    #[test]
    fn the_convex_hull_of_arcs_holds_all_points(points in lattice(), share in 0.05..1.0f64) {
        let points = places(&points);
        let Some(why) = eks(&points, 1e3).no_disc().copied() else { return Ok(()) };
        let shape = eks(&points, share * (1.0 - 1e-9) / why.enclosing);
        let hull = shape.hull();
        prop_assert!(hull.points.is_empty());
        let ends: BTreeSet<_> = hull.outline.iter().map(|p| p.ends()[0].map(f64::to_bits)).collect();
        let extreme: BTreeSet<_> =
            shape.extreme().iter().map(|&v| points[v as usize].map(f64::to_bits)).collect();
        prop_assert_eq!(ends, extreme);
        for (k, piece) in hull.outline.iter().enumerate() {
            let next = &hull.outline[(k + 1) % hull.outline.len()];
            prop_assert_eq!(piece.ends()[1], next.ends()[0]);
            let OutlinePiece::Arc(arc) = piece else { panic!("{piece:?} should be an arc") };
            prop_assert!(arc.counter_clockwise && arc.sweep() <= TAU / 2.0 + 1e-6);
            for p in &points {
                let apart = (p[0] - arc.centre[0]).hypot(p[1] - arc.centre[1]);
                prop_assert!(apart < arc.radius * (1.0 + 1e-9));
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn the_hull_is_what_no_empty_disc_covers(points in lattice(), radius in 0.6..4.0f64, seed in 0..41usize) {
        let points = places(&points);
        let outline = eks(&points, -1.0 / radius).hull().outline;
        const STEP: f64 = 0.125;
        let lattice = |from: i32, to: i32, shift: f64| {
            (from..to).flat_map(move |i| {
                (from..to).map(move |j| [f64::from(i) * STEP + shift, f64::from(j) * STEP + shift])
            })
        };
        let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        let room = |&centre: &[f64; 2]| {
            points.iter().map(|&p| distance(p, centre)).fold(f64::INFINITY, f64::min)
        };
        let centres: Vec<_> =
            lattice(-40, 88, 0.0).map(|c| (c, room(&c))).filter(|c| c.1 > radius - STEP).collect();
        for place in lattice(-4, 45, 0.03125 + 1e-3).skip(seed).step_by(41) {
            if winding(&outline, place) == 1 {
                let by = centres.iter().find(|c| c.1 >= radius && distance(c.0, place) < radius - 1e-3);
                prop_assert!(by.is_none(), "{place:?} is in the hull, but covered from {by:?}");
            } else {
                let by = centres.iter().any(|c| distance(c.0, place) < radius + STEP);
                prop_assert!(by, "{place:?} is not in the hull, but no disc covers it");
            }
        }
    }
}

/// The number of times an outline winds around a place.
fn winding(outline: &[OutlinePiece], place: [f64; 2]) -> i32 {
    let step = |a: [f64; 2], b: [f64; 2]| {
        let (a, b) = ([a[0] - place[0], a[1] - place[1]], [b[0] - place[0], b[1] - place[1]]);
        (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
    };
    let angle: f64 = outline
        .iter()
        .map(|piece| {
            let OutlinePiece::Arc(arc) = piece else { panic!("{piece:?} should be an arc") };
            (0..128)
                .map(|k| step(arc.at(f64::from(k) / 128.0), arc.at(f64::from(k + 1) / 128.0)))
                .sum::<f64>()
        })
        .sum();
    (angle / TAU).round() as i32
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, ..ProptestConfig::default() })]

    #[test]
    fn lattice_sets_agree_with_the_definition(points in lattice(), alpha in -64..64i32) {
        let alpha = f64::from(alpha) / 32.0;
        agrees(&points, alpha);
        agrees(&points, alpha * (1.0 + f64::EPSILON));
        agrees(&points, alpha * (1.0 - f64::EPSILON));
    }

    #[test]
    fn scattered_sets_agree_with_the_definition(points in scattered(), alpha in -1.0..1f64) {
        // From radii far below the distances to radii far above them, and near 1/ρ.
        let alpha = alpha * alpha * alpha / 8.0 + f64::from(f32::EPSILON);
        agrees(&points, alpha);
        agrees(&points, 1.0 / 512.0);
    }

    #[test]
    fn the_enclosing_circle_is_where_the_shape_ends(points in scattered()) {
        let points = places(&points);
        if let Some(why) = eks(&points, 1e3).no_disc() {
            prop_assert!(eks(&points, (1.0 - 1e-12) / why.enclosing).no_disc().is_none());
            prop_assert!(eks(&points, (1.0 + 1e-12) / why.enclosing).no_disc().is_some());
        }
    }

    #[test]
    fn shaded_triangles_end_at_edges(points in lattice(), alpha in -64..64i32) {
        let shape = eks(&places(&points), f64::from(alpha) / 32.0);
        let mut sides: Vec<[u32; 2]> = (shape.triangles().iter())
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        sides.sort_unstable();
        for same in sides.chunk_by(|a, b| a == b).filter(|same| same.len() == 1) {
            prop_assert!(shape.edges().contains(&same[0]), "{same:?}");
        }
    }

    #[test]
    fn translation_scaling_and_order_change_nothing(
        (points, order) in lattice().prop_flat_map(|points| {
            let order = Just((0..points.len()).collect::<Vec<_>>()).prop_shuffle();
            (Just(points), order)
        }),
        by in [-99..99i64, -99..99i64],
        exponent in -60..60i32,
        alpha in -64..64i32,
    ) {
        let alpha = f64::from(alpha) / 32.0;
        let (here, factor) = (eks(&places(&points), alpha), 2f64.powi(exponent));
        let other = |points: Vec<[f64; 2]>, alpha| {
            let other = eks(&points, alpha);
            (other.edges().to_vec(), other.extreme().to_vec(), other.triangles().to_vec())
        };
        let expected = (here.edges().to_vec(), here.extreme().to_vec(), here.triangles().to_vec());
        let moved: Vec<Point> = points.iter().map(|p| [p[0] + by[0], p[1] + by[1]]).collect();
        prop_assert_eq!(&other(places(&moved), alpha), &expected);
        let scaled = places(&points).iter().map(|p| p.map(|v| v * factor)).collect();
        prop_assert_eq!(&other(scaled, alpha / factor), &expected);

        // Indices change with the order, places do not.
        let shuffled: Vec<Point> = order.iter().map(|&k| points[k]).collect();
        let there = eks(&places(&shuffled), alpha);
        let triangles = |shape: &EksShape, points: &[Point]| -> BTreeSet<_> {
            let sorted = |row: &[u32; 3]| {
                let mut row = row.map(|v| points[v as usize]);
                row.sort_unstable();
                row
            };
            shape.triangles().iter().map(sorted).collect()
        };
        prop_assert_eq!(triangles(&there, &shuffled), triangles(&here, &points));
        agrees(&shuffled, alpha);
    }
}
