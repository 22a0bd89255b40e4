//! The filtration simplex by simplex: against shapes made one by one and the exact checker, flat points included,
//! and its pairs against a plain reduction of matrices.

mod files;

use std::collections::{BTreeMap, HashMap};

use walpha::check::enumerate;
use walpha::ladder::{Entry, Filtration, Ordered};
use walpha::shape::{Engine, ShapeOptions};
use walpha::{Alpha, AlphaShape, Class, WeightedPoints, alpha_shape};
use walpha_base::random::Random;

use crate::common;

/// Makes a place and a weight.
type Family = fn(&mut Random) -> ([f64; 3], f64);

/// Makes the points of a set, by its number.
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

/// Sets of up to `most` points that span a volume.
fn sets(count: usize, most: usize) -> impl Iterator<Item = WeightedPoints> {
    let mut random = Random::new(17);
    let sets = (0..).map(move |k| {
        let family = FAMILIES[k % FAMILIES.len()];
        let size = 4 + random.below(most - 3);
        let (positions, weights) = (0..size).map(|_| family(&mut random)).unzip();
        WeightedPoints::new(positions, weights).unwrap()
    });
    sets.filter(|points| common::spans_a_volume(points.positions())).take(count)
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

/// If doubles cannot distinguish two values, the order still does: a point is off the middle of an edge by less than its square
/// can show.
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

fn alpha(squared: f64) -> Alpha {
    Alpha::from_squared(squared).unwrap()
}

fn shape(points: &WeightedPoints, squared: f64) -> AlphaShape {
    let options = ShapeOptions::new(alpha(squared)).engine(Engine::Native).exterior(true);
    alpha_shape(points.clone(), &options).unwrap()
}

/// The class at an α, which must not be the double of a value.
fn class(simplex: &Entry<'_>, squared: f64) -> Class {
    if squared < simplex.value {
        Class::Exterior
    } else if squared < simplex.regular.min(simplex.interior) {
        Class::Singular
    } else if squared < simplex.interior {
        Class::Regular
    } else {
        Class::Interior
    }
}

fn classes(shape: &AlphaShape) -> HashMap<Vec<u32>, Class> {
    fn sorted(row: &[u32]) -> Vec<u32> {
        let mut row = row.to_vec();
        row.sort_unstable();
        row
    }
    let complex = shape.complex();
    let cells = complex.cells.iter().map(|(row, class)| (sorted(row), class));
    let facets = complex.facets.iter().map(|(row, class)| (sorted(row), class));
    let edges = complex.edges.iter().map(|(row, class)| (sorted(row), class));
    let vertices = complex.vertices.iter().map(|(row, class)| (sorted(row), class));
    cells.chain(facets).chain(edges).chain(vertices).collect()
}

/// Doubles between the values, and on both sides of all.
fn between(ordered: &Ordered<'_>) -> Vec<f64> {
    let mut values: Vec<f64> = ordered.values().iter().map(|value| value.squared()).collect();
    values.dedup();
    let middles = values.windows(2).map(|pair| pair[0] + (pair[1] - pair[0]) / 2.0);
    let inside: Vec<f64> = middles
        .filter(|middle| values.binary_search_by(|v| v.total_cmp(middle)).is_err())
        .collect();
    let beyond = |value: f64, sign: f64| value + sign * (value.abs() + 1.0);
    let ends = [beyond(values[0], -1.0), beyond(values[values.len() - 1], 1.0)];
    inside.into_iter().chain(ends).collect()
}

#[test]
fn classes_are_those_of_shapes_made_one_by_one() {
    let mut compared = 0;
    for points in sets(60, 24) {
        let filtration = Filtration::new(points.clone()).unwrap();
        let ordered = filtration.simplices().unwrap();
        let all = between(&ordered);
        for squared in all.iter().copied().step_by(1 + all.len() / 12) {
            let shape = shape(&points, squared);
            let expected = classes(&shape);
            assert_eq!(expected.len(), ordered.len());
            for simplex in ordered.iter() {
                let wanted = expected[simplex.vertices];
                assert_eq!(
                    class(&simplex, squared),
                    wanted,
                    "{simplex:?} at {squared}\n{points:?}"
                );
                compared += 1;
            }
            assert_eq!(filtration.shape(alpha(squared)).betti(), shape.betti());
        }
    }
    assert!(compared > 50_000);
}

/// Lattice points that span no volume, many at one place, on one circle, or hidden.
fn set(random: &mut Random) -> WeightedPoints {
    let steps = [0, 1].map(|_| [0; 3].map(|_| random.whole(-2, 2)));
    let (line, weighted) = (random.below(4) == 0, random.below(2) == 0);
    let count = 1 + random.below(12);
    let point = |random: &mut Random| {
        let (u, v) = (random.whole(-2, 2), if line { 0.0 } else { random.whole(-2, 2) });
        let weight = if weighted { random.whole(-2, 40) / 2.0 } else { 0.0 };
        ([0, 1, 2].map(|k| 1.0 + u * steps[0][k] + v * steps[1][k]), weight)
    };
    let (positions, weights) = (0..count).map(|_| point(random)).unzip();
    WeightedPoints::new(positions, weights).unwrap()
}

#[test]
fn flat_filtrations_are_those_of_the_definition() {
    let mut random = Random::new(29);
    let (mut done, mut dimensions, mut hidden, mut attached) = (0, [0; 3], 0, 0);
    while done < 200 {
        let points = set(&mut random);
        if common::spans_a_volume(points.positions()) {
            continue;
        }
        done += 1;
        let filtration = Filtration::new(points.clone()).unwrap();
        let ordered = filtration.simplices().unwrap();
        let curve = filtration.curve();
        let top = (0..3).rev().find(|&dimension| ordered.count(dimension) > 0).unwrap();
        dimensions[top] += 1;
        hidden += usize::from(filtration.whole().hidden().is_some_and(|hidden| !hidden.is_empty()));
        attached += (0..top).filter(|&k| ordered.gabriel(k) < ordered.count(k)).count();
        assert_eq!((ordered.count(3), ordered.gabriel(top)), (0, ordered.count(top)));
        for (alpha, &betti) in curve.alphas().zip(&curve.betti) {
            // At the value, and below it.
            for alpha in [alpha, alpha.next_down()].map(|alpha| Alpha::from_squared(alpha).unwrap())
            {
                let made = enumerate(points.positions(), points.weights(), alpha).unwrap();
                let levels = filtration.levels(&[alpha]);
                let shape = levels.shape(0, true, levels.betti()[0]);
                assert_eq!(*shape.complex(), made.complex, "{alpha:?}: {points:?}");
                let options = ShapeOptions::new(alpha);
                let alone = alpha_shape(points.clone(), &options).unwrap();
                assert_eq!(alone.betti(), shape.betti(), "{alpha:?}: {points:?}");
                assert_eq!(*filtration.shape(alpha).complex(), *alone.complex());
            }
            assert_eq!(betti.b2, 0);
        }
        // Every simplex comes once, when its faces are there; nothing is ever inside.
        let mut seen = HashMap::new();
        for simplex in ordered.iter() {
            let n = simplex.vertices.len();
            for gone in (0..n).filter(|_| n > 1) {
                let mut face = simplex.vertices.to_vec();
                face.remove(gone);
                assert!(seen[&face] <= simplex.rank);
            }
            assert!(seen.insert(simplex.vertices.to_vec(), simplex.rank).is_none());
            assert_eq!(simplex.interior, f64::INFINITY);
            assert_eq!(simplex.regular == f64::INFINITY, n == top + 1, "{simplex:?}");
        }
        let pairs = ordered.pairs();
        assert_eq!((pairs.components.len(), pairs.lasting.len()), (ordered.count(0) - 1, 1));
        assert!(pairs.voids.is_empty() && pairs.lasting_voids.is_empty() && pairs.last.is_none());
        let suggested = filtration.suggest(&curve);
        assert_eq!(suggested.one_region, filtration.one_region());
        assert_eq!(filtration.shape(suggested.one_region).betti().unwrap().b0, 1);
    }
    assert!(dimensions.iter().all(|&sets| sets > 10), "{dimensions:?}");
    assert!(hidden > 5 && attached > 50, "{hidden}, {attached}");
}

/// Pairs of all dimensions by numbers of simplices, and the simplices without one: columns of the
/// boundary matrix over Z/2, reduced from the left.
fn reduced(ordered: &Ordered<'_>) -> (Vec<Vec<[u32; 2]>>, Vec<u32>) {
    let place: HashMap<Vec<u32>, usize> =
        ordered.iter().enumerate().map(|(at, simplex)| (simplex.vertices.to_vec(), at)).collect();
    let mut with_low: HashMap<usize, Vec<usize>> = HashMap::new();
    let mut pairs = vec![Vec::new(); 3];
    let mut alone: Vec<bool> = vec![true; ordered.len()];
    for (at, simplex) in ordered.iter().enumerate() {
        let n = simplex.vertices.len();
        let mut column: Vec<usize> = (0..n)
            .filter(|_| n > 1)
            .map(|gone| {
                let mut face = simplex.vertices.to_vec();
                face.remove(gone);
                place[&face]
            })
            .collect();
        column.sort_unstable();
        while let Some(other) = column.last().and_then(|low| with_low.get(low)) {
            let mut sum: BTreeMap<usize, bool> = BTreeMap::new();
            column.iter().chain(other).for_each(|&row| *sum.entry(row).or_default() ^= true);
            column = sum.into_iter().filter(|(_, odd)| *odd).map(|(row, _)| row).collect();
        }
        if let Some(&low) = column.last() {
            pairs[n - 2].push([ordered.order()[low], ordered.order()[at]]);
            (alone[low], alone[at]) = (false, false);
            with_low.insert(low, column);
        }
    }
    let alone = (0..ordered.len()).filter(|&at| alone[at]).map(|at| ordered.order()[at]).collect();
    (pairs, alone)
}

#[test]
fn pairs_are_those_of_a_matrix() {
    let mut lasting = [0; 3];
    for points in sets(240, 40) {
        let filtration = Filtration::new(points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let pairs = ordered.pairs();
        let (mut expected, alone) = reduced(&ordered);
        let sorted = |pairs: &[[u32; 2]]| {
            let mut pairs = pairs.to_vec();
            pairs.sort_unstable();
            pairs
        };
        expected.iter_mut().for_each(|pairs| pairs.sort_unstable());
        assert_eq!(sorted(&pairs.components), expected[0]);
        assert_eq!(sorted(&pairs.voids), expected[2]);
        assert_eq!(pairs.lasting, alone);
        let loops = ordered.loops().unwrap();
        assert_eq!(sorted(&loops.pairs), expected[1]);
        assert!(loops.lasting.is_empty());
        for (count, pairs) in lasting.iter_mut().zip(&expected) {
            *count += pairs.iter().filter(|&&pair| ordered.lasts(pair)).count();
        }
    }
    assert!(lasting.iter().all(|&count| count > 100), "{lasting:?}");
}
