//! Finds α from the spacing of points, without the influence of a few strays.

use rstar::RTree;
use rstar::primitives::GeomWithData;
use walpha_base::parallel::prelude::*;
use walpha_base::random::Random;
use walpha_regular::internals::check_numbers;

use walpha_points::WeightedPoints;
use walpha_shape::{Alpha, ShapeError, Torus};

/// The number of neighbours that the ball of a point reaches. For points that are scattered at random, with m of them in a unit
/// of area or volume, the largest empty disc or ball has about the radius at which nine of ten points reach this many neighbours:
/// √(ln n / π m) and ∛(3 ln n / 4π m), compared with 1.9/√m and 1.4/∛m, for n of 10⁴ to 10⁶. So the rule closes surfaces and
/// fills solids alike.
const NEIGHBOURS: usize = 8;
/// The share of points whose balls reach that many neighbours. The others may be strays.
const SHARE: f64 = 0.9;
/// The number of points that are examined, if there are more. The quantile varies by less than one percent.
const LOOKED_AT: usize = 20_000;

type Neighbour = GeomWithData<[f64; 3], f64>;

/// The α at which the balls of nine of ten points reach their eighth neighbours' centres: the quantile of r² − ω over points,
/// where r is the distance to the eighth of the other positions (or to the farthest, if there are fewer) and ω the weight. On a
/// torus, distances are those of the nearest copies. 0 for a single position without weight.
///
/// The result depends only on the set of points, not on their order. O(n log n).
///
/// # Errors
/// Numbers are not finite or are too large.
pub(super) fn spacing_alpha(
    points: &WeightedPoints,
    torus: Option<Torus>,
) -> Result<Alpha, ShapeError> {
    check_numbers(points.positions(), points.weights())?;
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
    Ok(Alpha::from_squared(squared).expect("squares of coordinates in range are numbers"))
}

/// The distinct positions of points, in order, each with the largest weight there.
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

/// The squared distance from a position to the eighth of the others. On a torus these are all copies of positions, including its
/// own.
fn eighth(tree: &RTree<Neighbour>, from: &[f64; 3], torus: Option<Torus>) -> f64 {
    let nearest = |from: [f64; 3]| {
        let neighbours = tree.nearest_neighbor_iter_with_distance_2(&from);
        // The first is the position itself.
        neighbours.map(|(_, squared)| squared).take(NEIGHBOURS + 1)
    };
    let mut squares: Vec<f64> = nearest(*from).collect();
    let Some(torus) = torus else {
        return squares.get(NEIGHBOURS).or(squares.last()).copied().unwrap_or_default();
    };
    // Within this distance along the shortest vector, in both directions, there are eight copies of the position itself.
    let lengths = torus.vectors().map(|[x, y, z]| x.hypot(y).hypot(z));
    let shortest = lengths.into_iter().filter(|length| *length > 0.0).fold(f64::INFINITY, f64::min);
    let enough = (NEIGHBOURS / 2) as f64 * shortest;
    let steps = |k: usize| {
        if !torus.repeats()[k] {
            return 0..=0;
        }
        let [below, above] = torus.part_range(k, [-enough; 3], [enough; 3]);
        below.floor() as i32 - 1..=above.ceil() as i32 + 1
    };
    let envelope = tree.root().envelope();
    let extent = [envelope.lower(), envelope.upper()];
    let copies =
        steps(0).flat_map(|x| steps(1).flat_map(move |y| steps(2).map(move |z| [x, y, z])));
    for windings in copies.filter(|&windings| windings != [0; 3]) {
        let copy = torus.moved(*from, windings);
        let known = squares.get(NEIGHBOURS).copied().unwrap_or(f64::INFINITY);
        if squared_distance_to_box(copy, extent) <= known.min(enough * enough) {
            squares.extend(nearest(copy));
            squares.sort_unstable_by(f64::total_cmp);
            squares.truncate(NEIGHBOURS + 1);
        }
    }
    squares[NEIGHBOURS]
}

/// The squared distance from a position to a box between two corners.
fn squared_distance_to_box(place: [f64; 3], [low, high]: [[f64; 3]; 2]) -> f64 {
    let outside = |k: usize| (low[k] - place[k]).max(place[k] - high[k]).max(0.0);
    (0..3).map(|k| outside(k) * outside(k)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn alpha(positions: &[[f64; 3]], torus: Option<Torus>) -> f64 {
        let points = WeightedPoints::unweighted(positions.to_vec());
        spacing_alpha(&points, torus).unwrap().squared()
    }

    fn lattice(side: usize) -> Vec<[f64; 3]> {
        let at = |i: usize| [i % side, i / side % side, i / side / side].map(|x| x as f64);
        (0..side.pow(3)).map(at).collect()
    }

    /// For random points, one to a unit of area or volume, √α is the distance of the eighth neighbour for nine of ten points.
    #[test]
    fn random_points_have_the_expected_spacing() {
        let mut random = Random::new(1);
        let (square, cube) = (200.0, 30.0);
        let mut at = |side: f64| side * random.unit();
        let surface: Vec<[f64; 3]> = (0..40_000).map(|_| [at(square), at(square), 0.0]).collect();
        let solid: Vec<[f64; 3]> = (0..27_000).map(|_| [at(cube), at(cube), at(cube)]).collect();
        let torus = Torus::new([cube; 3]).unwrap();
        // 11.77 is the ninth decile of the gamma distribution of shape 8, which is that of π r² and 4 π r³ / 3.
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
        // At the faces of the cube, half of the neighbours are missing.
        assert!(alpha(&solid, None).sqrt() > 1.02 * ball);
    }

    #[test]
    fn lattices_and_few_points() {
        // There are 6 neighbours at distance 1 and 12 at √2; on faces, 5 and 8.
        assert_eq!(alpha(&lattice(30), None), 2.0);
        assert_eq!(alpha(&lattice(4), Some(Torus::new([4.0; 3]).unwrap())), 2.0);
        assert_eq!(alpha(&[[1.0; 3]], None), 0.0);
        assert_eq!(alpha(&[[0.0; 3], [3.0, 0.0, 0.0], [3.0, 0.0, 0.0]], None), 9.0);
        assert_eq!(alpha(&[[0.0; 3]], Some(Torus::new([2.0, 3.0, 4.0]).unwrap())), 13.0);
        // These are the longest distances whose squares are examined.
        assert!(alpha(&[[-3e150; 3], [3e150; 3]], None).is_finite());
    }

    /// Along a short side, copies several sides away are neighbours.
    #[test]
    fn copies_are_as_far_away_as_they_must_be() {
        let along = |axis: usize, short: f64, long: f64| {
            let mut sides = [long; 3];
            sides[axis] = short;
            let at = |x: f64| [0, 1, 2].map(|k| if k == axis { x } else { 0.0 });
            alpha(&[at(0.0), at(1.0), at(2.0)], Some(Torus::new(sides).unwrap()))
        };
        for axis in 0..3 {
            assert_eq!(along(axis, 3.0, 300.0), 16.0);
            assert_eq!(along(axis, 3.0, 3.0), 9.0);
        }
        // For a single position, this is the fourth copy in either direction.
        assert_eq!(alpha(&[[0.5; 3]], Some(Torus::new([1.0, 1000.0, 1000.0]).unwrap())), 16.0);

        // The result equals that for copies laid out in space.
        let mut random = Random::new(3);
        for sides in [[1.0, 4.0, 9.0], [2.0, 2.0, 1.0], [1.0, 1.0, 8.0]] {
            let places: Vec<[f64; 3]> =
                (0..5).map(|_| sides.map(|side| side * random.unit())).collect();
            let torus = Torus::new(sides).unwrap();
            let places: Vec<[f64; 3]> = places.iter().map(|&place| torus.wrap(place)).collect();
            let steps = |k: usize| -> std::ops::RangeInclusive<i32> {
                let most = (4.0 / sides[k]) as i32 + 1;
                -most..=most
            };
            let laid_out: Vec<[f64; 3]> = steps(0)
                .flat_map(|x| steps(1).flat_map(move |y| steps(2).map(move |z| [x, y, z])))
                .flat_map(|windings| places.iter().map(move |&place| torus.moved(place, windings)))
                .collect();
            let mut reaches: Vec<f64> = (places.iter())
                .map(|from| {
                    let square = |to: &[f64; 3]| (0..3).map(|k| (to[k] - from[k]).powi(2)).sum();
                    let mut squares: Vec<f64> = laid_out.iter().map(square).collect();
                    squares.sort_unstable_by(f64::total_cmp);
                    squares[8]
                })
                .collect();
            reaches.sort_unstable_by(f64::total_cmp);
            assert_eq!(alpha(&places, Some(torus)), reaches[4], "{sides:?}");
        }
    }

    #[test]
    fn numbers_out_of_range_are_refused_by_their_point() {
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308] {
            let mut points = WeightedPoints::unweighted(lattice(2));
            points.positions_mut()[5][1] = wrong;
            let error = spacing_alpha(&points, None).unwrap_err().to_string();
            assert!(error.starts_with("point 5 has y "), "{error}");
            let mut points = WeightedPoints::unweighted(lattice(2));
            points.weights_mut()[3] = wrong;
            let error = spacing_alpha(&points, None).unwrap_err().to_string();
            assert!(error.starts_with("point 3 has weight "), "{error}");
        }
    }

    /// Strays, duplicates and the order of points do not matter.
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

    /// Equal weights shift α by their value.
    #[test]
    fn weights_are_taken_off() {
        let mut points = WeightedPoints::unweighted(lattice(12));
        let squared = |points: &WeightedPoints| spacing_alpha(points, None).unwrap().squared();
        let without = squared(&points);
        points.weights_mut().iter_mut().for_each(|weight| *weight = 3.0);
        assert_eq!(squared(&points), without - 3.0);
    }
}
