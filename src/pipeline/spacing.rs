//! α from the spacing of points, which a few strays do not decide.

use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::GeomWithData;
use walpha_base::random::Random;

use crate::points::WeightedPoints;
use crate::shape::{Alpha, Torus};

/// How many neighbours the ball of a point reaches. Where points are scattered at random, with m of them in a unit of
/// area or volume, the largest empty disc or ball has about the radius that nine of ten points need for this many:
/// √(ln n / π m) and ∛(3 ln n / 4π m), against 1.9/√m and 1.4/∛m, for n of 10⁴ to 10⁶. So the rule closes surfaces and
/// fills solids alike.
const NEIGHBOURS: usize = 8;
/// The share of points whose balls reach that many neighbours. The rest may be strays.
const SHARE: f64 = 0.9;
/// Number of points that are looked at, if there are more. The quantile varies by less than one percent.
const LOOKED_AT: usize = 20_000;

type Neighbour = GeomWithData<[f64; 3], f64>;

/// The α at which the balls of nine of ten points reach their eighth neighbours' centres: the quantile of r² − ω over
/// points, r being the distance to the eighth of the other places (or to the farthest, where these are fewer) and
/// ω the weight. On a torus distances are those of the nearest copies. 0 for a single place without weight.
///
/// A function of the set of points alone, not of their order. O(n log n).
pub(super) fn spacing_alpha(points: &WeightedPoints, torus: Option<Torus>) -> Alpha {
    let places = places(points, torus);
    let mut random = Random::new(0);
    let looked_at: Vec<usize> = if places.len() <= LOOKED_AT {
        (0..places.len()).collect()
    } else {
        (0..LOOKED_AT).map(|_| random.below(places.len())).collect()
    };
    let tree = RTree::bulk_load(places.clone());
    let reach = |&at: &usize| eighth(&tree, places[at].geom(), torus) - places[at].data;
    let mut reaches: Vec<f64> = looked_at.par_iter().map(reach).collect();
    reaches.sort_unstable_by(f64::total_cmp);
    let rank = (SHARE * reaches.len() as f64).ceil() as usize;
    let squared = reaches.get(rank.saturating_sub(1)).copied().unwrap_or_default();
    // Coordinates may be so large that a square is not finite.
    Alpha::from_squared(squared.min(f64::MAX)).expect("a number")
}

/// The distinct places of points, in order, each with the largest weight there.
fn places(points: &WeightedPoints, torus: Option<Torus>) -> Vec<Neighbour> {
    let place = |&place: &[f64; 3]| torus.map_or(place, |torus| torus.wrap(place));
    let mut places: Vec<([f64; 3], f64)> = points
        .positions()
        .par_iter()
        .map(place)
        .zip(points.weights().par_iter().copied())
        .collect();
    let order = |a: &[f64; 3], b: &[f64; 3]| {
        let axes =
            [0, 1, 2].map(|axis| a[axis].partial_cmp(&b[axis]).expect("coordinates are numbers"));
        axes[0].then(axes[1]).then(axes[2])
    };
    places.par_sort_unstable_by(|(a, ω), (b, weight)| order(a, b).then(weight.total_cmp(ω)));
    places.dedup_by(|(a, _), (b, _)| a == b);
    places.into_iter().map(|(place, weight)| Neighbour::new(place, weight)).collect()
}

/// The squared distance from a place to the eighth of the others.
fn eighth(tree: &RTree<Neighbour>, from: &[f64; 3], torus: Option<Torus>) -> f64 {
    let nearest = |from: [f64; 3]| {
        let neighbours = tree.nearest_neighbor_iter_with_distance_2(&from);
        neighbours.map(|(_, squared)| squared).take(NEIGHBOURS + 1)
    };
    let mut squares: Vec<f64> = nearest(*from).collect();
    if let Some(torus) = torus {
        let steps = || -1..=1;
        let copies =
            steps().flat_map(|x| steps().flat_map(move |y| steps().map(move |z| [x, y, z])));
        for windings in copies.filter(|&windings| windings != [0; 3]) {
            squares.extend(nearest(torus.moved(*from, windings)));
        }
        squares.sort_unstable_by(f64::total_cmp);
    }
    // The first is the place itself.
    squares.get(NEIGHBOURS).or(squares.last()).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn alpha(positions: &[[f64; 3]], torus: Option<Torus>) -> f64 {
        spacing_alpha(&WeightedPoints::unweighted(positions.to_vec()), torus).squared()
    }

    fn lattice(side: usize) -> Vec<[f64; 3]> {
        let at = |i: usize| [i % side, i / side % side, i / side / side].map(|x| x as f64);
        (0..side.pow(3)).map(at).collect()
    }

    /// On random points of one to a unit of area or volume, √α is the radius that the eighth neighbour has for nine of ten.
    #[test]
    fn random_points_have_the_expected_spacing() {
        let mut random = Random::new(1);
        let (square, cube) = (200.0, 30.0);
        let mut at = |side: f64| side * random.unit();
        let surface: Vec<[f64; 3]> = (0..40_000).map(|_| [at(square), at(square), 0.0]).collect();
        let solid: Vec<[f64; 3]> = (0..27_000).map(|_| [at(cube), at(cube), at(cube)]).collect();
        let torus = Torus::new([cube; 3]).unwrap();
        // 11.77 is the ninth decile of the gamma distribution of shape 8: π r² and 4 π r³ / 3 are distributed so.
        let ball = (11.77 * 3.0 / (4.0 * std::f64::consts::PI)).cbrt();
        for (found, expected) in [
            (alpha(&surface, None), (11.77 / std::f64::consts::PI).sqrt()),
            (alpha(&solid, Some(torus)), ball),
        ] {
            assert!(
                (found.sqrt() / expected - 1.0).abs() < 0.02,
                "{} and {expected}",
                found.sqrt()
            );
        }
        // At the faces of the cube half of the neighbours are missing.
        assert!(alpha(&solid, None).sqrt() > 1.02 * ball);
    }

    #[test]
    fn lattices_and_few_points() {
        // 6 at distance 1, 12 at √2; on faces 5 and then 8.
        assert_eq!(alpha(&lattice(30), None), 2.0);
        assert_eq!(alpha(&lattice(4), Some(Torus::new([4.0; 3]).unwrap())), 2.0);
        assert_eq!(alpha(&[[1.0; 3]], None), 0.0);
        assert_eq!(alpha(&[[0.0; 3], [3.0, 0.0, 0.0], [3.0, 0.0, 0.0]], None), 9.0);
        assert_eq!(alpha(&[[0.0; 3]], Some(Torus::new([2.0, 3.0, 4.0]).unwrap())), 13.0);
        // Distances whose squares are no doubles.
        assert_eq!(alpha(&[[-1e150, 0.0, 0.0], [3e155, 0.0, 0.0]], None), f64::MAX);
    }

    /// Neither strays, duplicates nor the order of points matter.
    #[test]
    fn strays_do_not_decide() {
        let mut random = Random::new(2);
        let mut points: Vec<[f64; 3]> = (0..3000).map(|_| [0; 3].map(|_| random.unit())).collect();
        let without = alpha(&points, None);
        let again = points[..500].to_vec();
        points.extend(again);
        random.shuffle(&mut points);
        assert_eq!(alpha(&points, None), without);
        points.extend([[30.0, 0.0, 0.0], [0.0, -500.0, 3.0], [1e6; 3]]);
        assert!((alpha(&points, None) / without - 1.0).abs() < 0.01);
    }

    /// Equal weights shift α.
    #[test]
    fn weights_are_taken_off() {
        let mut points = WeightedPoints::unweighted(lattice(12));
        let without = spacing_alpha(&points, None).squared();
        points.weights_mut().iter_mut().for_each(|weight| *weight = 3.0);
        assert_eq!(spacing_alpha(&points, None).squared(), without - 3.0);
    }
}
