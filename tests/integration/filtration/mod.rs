//! The filtration simplex by simplex: against shapes made one by one and the exact checker, and its
//! pairs against a plain reduction of matrices.

mod classes;
mod command;
mod damaged;
mod files;
mod flat;
mod pairs;

use std::collections::BTreeMap;

use walpha::WeightedPoints;
use walpha::ladder::Filtration;
use walpha_base::random::Random;

use crate::common;

/// Makes a place and a weight.
type Family = fn(&mut Random) -> ([f64; 3], f64);

/// What a set is made of, by its number.
const FAMILIES: [Family; 6] = [
    |r| ([0; 3].map(|_| r.whole(0, 3)), 0.0),
    |r| ([0; 3].map(|_| r.whole(0, 3)), r.whole(-2, 4) / 2.0),
    |r| ([0; 3].map(|_| r.whole(0, 4)), if r.below(3) == 0 { r.unit() } else { 0.1 }),
    |r| ([0; 3].map(|_| r.unit()), 0.0),
    |r| ([0; 3].map(|_| r.unit()), r.unit() / 8.0),
    |r| {
        // Lattice points moved by one place of their last digit, or not.
        let near = |r: &mut Random| {
            let x = 1.0 + r.whole(0, 2);
            [x, x, x.next_up(), x.next_down()][r.below(4)]
        };
        ([0; 3].map(|_| near(r)), r.whole(0, 1))
    },
];

/// Sets of up to so many points that span a volume.
fn sets(count: usize, most: usize) -> impl Iterator<Item = WeightedPoints> {
    let mut random = Random::new(17);
    let sets = (0..).map(move |k| {
        let family = FAMILIES[k % FAMILIES.len()];
        let size = 4 + random.below(most - 3);
        let (positions, weights) = (0..size).map(|_| family(&mut random)).unzip();
        WeightedPoints::new(positions, weights).unwrap()
    });
    sets.filter(|points| common::spans_a_volume(&points.positions)).take(count)
}

#[test]
fn the_order_is_by_value_dimension_and_vertices() {
    for points in sets(120, 30) {
        let filtration = Filtration::new(points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let mut seen = BTreeMap::new();
        let mut last = None;
        for simplex in ordered.iter() {
            let key = (simplex.rank, simplex.vertices.len(), simplex.vertices.to_vec());
            assert!(last.is_none_or(|last| last < key));
            assert_eq!(ordered.values()[simplex.rank as usize].squared(), simplex.value);
            let n = simplex.vertices.len();
            for gone in (0..n).filter(|_| n > 1) {
                let mut face = simplex.vertices.to_vec();
                face.remove(gone);
                assert!(seen[&face] <= simplex.rank);
            }
            seen.insert(simplex.vertices.to_vec(), simplex.rank);
            last = Some(key);
        }
        assert_eq!(seen.len(), ordered.len());
        assert!(ordered.values().is_sorted());
    }
}

/// Where doubles cannot tell two values apart the order still does: a point off the middle of an edge
/// by less than its square can show.
#[test]
fn values_with_one_double_are_told_apart() {
    let tiny = 2f64.powi(-40);
    let positions =
        vec![[0.0; 3], [2.0, 0.0, 0.0], [9.0, 9.0, 9.0], [9.0, 11.0, 9.0 + tiny], [0.0, 40.0, 7.0]];
    let points = WeightedPoints::unweighted(positions);
    let filtration = Filtration::new(points).unwrap();
    let ordered = filtration.simplices().unwrap();
    let edge = |row: [u32; 2]| ordered.iter().find(|simplex| simplex.vertices == row).unwrap();
    let (exact, longer) = (edge([0, 1]), edge([2, 3]));
    assert_eq!((exact.value, longer.value), (1.0, 1.0));
    assert!(exact.rank < longer.rank);
}

#[test]
fn the_curve_is_the_same_as_that_of_levels() {
    for points in sets(40, 30) {
        let filtration = Filtration::new(points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let curve = filtration.curve();
        let betti = ordered.betti_curve();
        let values = ordered.values();
        for (k, above) in curve.alphas().enumerate() {
            // The last value that is not above that double; several may be between two doubles.
            let rank = values.partition_point(|value| value.squared() <= above);
            let nearest_below = (rank > 0).then(|| betti[rank - 1]);
            let unsure = rank > 0 && values[rank - 1].squared() == above;
            assert!(unsure || nearest_below == Some(curve.betti[k]));
        }
        assert_eq!(betti.last(), curve.betti.last());
    }
}

#[test]
fn fewer_components_take_a_larger_alpha() {
    let two = std::num::NonZeroU64::new(2).unwrap();
    // Two tetrahedra far apart.
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let far = corners.map(|[x, y, z]| [x + 9.0, y, z]);
    let positions = [corners, far].concat();
    let points = WeightedPoints::unweighted(positions);
    let filtration = Filtration::new(points).unwrap();
    assert_eq!(filtration.optimal_alpha(two).squared(), 0.75);
    assert!(filtration.optimal_alpha(std::num::NonZeroU64::MIN) == filtration.one_region());
    assert!(filtration.one_region().squared() > 16.0);
}
