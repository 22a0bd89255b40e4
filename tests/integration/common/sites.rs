//! Weighted points for tests.

use std::ops::Range;

use proptest::prelude::*;
use walpha::WeightedPoints;

/// Positions with their weights.
pub fn weighted(sites: impl IntoIterator<Item = ([f64; 3], f64)>) -> WeightedPoints {
    let (positions, weights) = sites.into_iter().unzip();
    WeightedPoints::new(positions, weights).unwrap()
}

/// Points of a 4 × 4 × `height` lattice: everything that can be degenerate is.
pub fn lattice(height: i32, count: Range<usize>) -> impl Strategy<Value = WeightedPoints> {
    let weight = prop_oneof![
        4 => Just(0.0),
        2 => (0..8i32).prop_map(|w| f64::from(w) / 2.0),
        1 => -2.0..4.0f64,
    ];
    let site = ([0..4, 0..4, 0..height], weight).prop_map(|(p, w)| (p.map(f64::from), w));
    prop::collection::vec(site, count).prop_map(weighted)
}
