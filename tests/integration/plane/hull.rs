//! The hull of arcs against discs.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use proptest::prelude::*;
use walpha::reproduce::plane::Piece;

use super::{eks, lattice, places};

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
            let Piece::Arc(arc) = piece else { panic!("{piece:?} should be an arc") };
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

/// How often an outline winds around a place.
fn winding(outline: &[Piece], place: [f64; 2]) -> i32 {
    let step = |a: [f64; 2], b: [f64; 2]| {
        let (a, b) = ([a[0] - place[0], a[1] - place[1]], [b[0] - place[0], b[1] - place[1]]);
        (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
    };
    let angle: f64 = outline
        .iter()
        .map(|piece| {
            let Piece::Arc(arc) = piece else { panic!("{piece:?} should be an arc") };
            (0..128)
                .map(|k| step(arc.at(f64::from(k) / 128.0), arc.at(f64::from(k + 1) / 128.0)))
                .sum::<f64>()
        })
        .sum();
    (angle / TAU).round() as i32
}
