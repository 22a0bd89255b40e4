//! What holds of every shape, by sets drawn by lot.

use std::collections::BTreeSet;

use proptest::prelude::*;
use walpha::reproduce::plane::EksShape;

use super::brute::Point;
use super::{agrees, eks, lattice, places, scattered};

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
