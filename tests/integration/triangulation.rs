//! Our triangulation against CGAL's, on small sets where nearly everything is degenerate; and the two
//! engines on the same sets, byte by byte.

use std::collections::BTreeMap;

use rayon::prelude::*;
use walpha::shape::{Engine, ShapeError, ShapeOptions};
use walpha::triangulation::{Triangulation, TriangulationError, triangulate};
use walpha::{Alpha, AlphaShape, WeightedPoints, alpha_shape};
use walpha_base::random::Random;

use crate::common::weighted;

/// Makes the points of a set, by its number.
pub const FAMILIES: [fn(&mut Random) -> WeightedPoints; 9] = [
    |r| lattice(r, |r| r.whole(0, 3)),
    |r| lattice(r, |r| r.whole(-4, 4) / 2.0),
    |r| lattice(r, |r| if r.below(3) == 0 { r.unit() } else { 0.1 }),
    sphere,
    neighbours,
    |r| magnitudes(r, 500),
    |r| magnitudes(r, 60),
    plane_and_a_few,
    line_and_a_few,
];

fn count(r: &mut Random) -> usize {
    4 + r.below(11)
}

fn lattice(r: &mut Random, weight: fn(&mut Random) -> f64) -> WeightedPoints {
    let side = 1 + r.below(3) as i64;
    weighted(
        (0..count(r)).map(|_| ([0; 3].map(|_| r.whole(0, side)), weight(r))).collect::<Vec<_>>(),
    )
}

/// Integer points on one sphere, and perhaps its centre.
fn sphere(r: &mut Random) -> WeightedPoints {
    let squared = [3.0, 9.0, 14.0, 25.0][r.below(4)];
    let all = (0..11 * 11 * 11).map(|i| [i % 11, i / 11 % 11, i / 121].map(|x| f64::from(x) - 5.0));
    let on: Vec<[f64; 3]> =
        all.filter(|p| p.iter().map(|x| x * x).sum::<f64>() == squared).collect();
    let mut points: Vec<_> = (0..count(r)).map(|_| (on[r.below(on.len())], 0.0)).collect();
    if r.below(2) == 0 {
        points.push(([0.0; 3], r.whole(-2, 2)));
    }
    weighted(points)
}

/// Lattice points moved by one place of their last digit, or not.
fn neighbours(r: &mut Random) -> WeightedPoints {
    let coordinate = |r: &mut Random| {
        let x = 1.0 + r.whole(0, 2);
        [x, x.next_up(), x.next_down()][r.below(3)]
    };
    let points = (0..count(r)).map(|_| ([0; 3].map(|_| coordinate(r)), r.whole(0, 1)));
    weighted(points.collect::<Vec<_>>())
}

/// Numbers of any size up to 2^±`most`.
fn magnitudes(r: &mut Random, most: i64) -> WeightedPoints {
    let number = |r: &mut Random, most: i64| {
        (r.whole(-3, 3) + r.unit().round() / 2.0) * 2f64.powi(r.whole(-most, most - 2) as i32)
    };
    let one_size = r.below(2) == 0;
    let scale = 2f64.powi(r.whole(-most, most - 4) as i32);
    let mut point = || {
        if one_size {
            let position = [0; 3].map(|_| r.whole(-2, 2) * scale);
            (position, if most > 400 { 0.0 } else { r.whole(-1, 1) * scale * scale })
        } else {
            ([0; 3].map(|_| number(r, most)), number(r, most))
        }
    };
    weighted((0..9).map(|_| point()).collect::<Vec<_>>())
}

/// Coplanar points, and at times some off the plane.
fn plane_and_a_few(r: &mut Random) -> WeightedPoints {
    let off = r.below(3);
    let mut points: Vec<_> = (0..count(r))
        .map(|_| {
            let (x, y) = (r.whole(0, 3), r.whole(0, 3));
            ([x, y, 3.0 - x - 2.0 * y], r.whole(-1, 1))
        })
        .collect();
    points.extend((0..off).map(|_| ([0; 3].map(|_| r.whole(0, 3)), 0.0)));
    weighted(points)
}

/// Collinear points, and at times some off the line.
fn line_and_a_few(r: &mut Random) -> WeightedPoints {
    let off = r.below(4);
    let mut points: Vec<_> = (0..count(r))
        .map(|_| {
            let x = r.whole(-6, 6);
            ([x, 2.0 * x, -x], r.whole(-2, 2))
        })
        .collect();
    points.extend((0..off).map(|_| ([0; 3].map(|_| r.whole(-3, 3)), 0.0)));
    weighted(points)
}

/// Our triangulation.
fn made(points: &WeightedPoints) -> Result<Triangulation, TriangulationError> {
    triangulate(points.positions(), Some(points.weights()))
}

/// The whole triangulation of CGAL.
fn whole(points: &WeightedPoints) -> Result<AlphaShape, ShapeError> {
    let options = ShapeOptions::new(Alpha::INFINITE).engine(Engine::Cgal).refuse_flat(true);
    alpha_shape(points.clone(), &options.hidden(true))
}

/// Finite cells in an order that does not depend on theirs: from the smallest corner on, oriented.
pub fn cells(triangulation: &Triangulation) -> Vec<[u32; 4]> {
    let canonical = |(_, cell): (u32, [u32; 4])| {
        let mut sorted = cell;
        sorted.sort_unstable();
        let pairs = (0..4).flat_map(|j| (0..j).map(move |i| (i, j)));
        if pairs.filter(|&(i, j)| cell[i] > cell[j]).count() % 2 == 1 {
            sorted.swap(2, 3);
        }
        sorted
    };
    let mut cells: Vec<_> = triangulation.finite_cells().map(canonical).collect();
    cells.sort_unstable();
    cells
}

/// The neighbour across a facet has the same three corners, and refers back to it.
fn check_neighbours(triangulation: &Triangulation) {
    let facet = |side: u32| {
        let mut facet = triangulation.cells()[side as usize / 4].to_vec();
        facet.remove(side as usize % 4);
        facet.sort_unstable();
        facet
    };
    for (side, &across) in (0..).zip(triangulation.adjacency().as_flattened()) {
        assert_eq!(triangulation.adjacency()[across as usize / 4][across as usize % 4], side);
        assert_eq!(facet(side), facet(across));
    }
}

fn check(points: &WeightedPoints, alphas: &[f64]) -> &'static str {
    let (native, cgal) = (made(points), whole(points));
    let (native, cgal) = match (native, cgal) {
        (Ok(native), Ok(cgal)) => (native, cgal),
        (native, cgal) => {
            assert_eq!(native.err().map(ShapeError::from), cgal.err());
            return "refused";
        }
    };
    assert_eq!(cells(&native), cgal.complex().cells.rows());
    assert_eq!(Some(native.hidden()), cgal.hidden());
    assert_eq!(native.duplicates(), cgal.duplicates());
    check_neighbours(&native);
    for &alpha in alphas {
        let alpha = Alpha::from_squared(alpha).unwrap();
        let by = |engine| {
            let options = ShapeOptions::new(alpha).engine(engine);
            alpha_shape(points.clone(), &options).unwrap()
        };
        let (cgal, native) = (by(Engine::Cgal), by(Engine::Native));
        assert_eq!(cgal.complex(), native.complex(), "{alpha:?}");
        assert_eq!(cgal.betti(), native.betti(), "{alpha:?}");
        assert_eq!(cgal.sheets(), native.sheets(), "{alpha:?}");
    }
    "triangulated"
}

#[test]
fn a_hundred_thousand_degenerate_sets() {
    const SETS: u64 = 100_000;
    let one = |seed: u64| {
        let mut random = Random::new(seed);
        let family = (seed % FAMILIES.len() as u64) as usize;
        let points = FAMILIES[family](&mut random);
        // Shapes of every tenth set: triangulations are where engines may differ.
        let scale =
            points.positions().as_flattened().iter().fold(0f64, |most, x| most.max(x.abs()));
        let alphas = [0.0, 0.25, 0.5, 1.0].map(|alpha| alpha * scale * scale);
        let every_tenth = (seed / FAMILIES.len() as u64).is_multiple_of(10);
        let alphas = if every_tenth { &alphas[..] } else { &[] };
        let done = std::panic::catch_unwind(|| check(&points, alphas));
        let what = done.unwrap_or_else(|_| panic!("set {seed}, family {family}: {points:?}"));
        ((family, what), 1u64)
    };
    let counted = (0..SETS).into_par_iter().map(one);
    let counts = counted.fold(BTreeMap::new, |mut counts, (key, one)| {
        *counts.entry(key).or_insert(0) += one;
        counts
    });
    let counts = counts.reduce(BTreeMap::new, |mut counts: BTreeMap<_, u64>, more| {
        more.into_iter().for_each(|(key, count)| *counts.entry(key).or_insert(0) += count);
        counts
    });
    println!("{counts:?}");
    for family in 0..FAMILIES.len() {
        let enough = counts.get(&(family, "triangulated")).copied().unwrap_or(0);
        assert!(enough > SETS / 100, "family {family}: {counts:?}");
    }
}

/// Cavities with more corners than fit the table: all points of two lines are joined.
#[test]
fn two_lines_that_do_not_meet() {
    let line = (0..120).map(f64::from);
    let one = line.clone().map(|x| ([x, 0.0, 0.0], 0.0));
    let points = weighted(one.chain(line.map(|y| ([0.0, y, 500.0], 0.0))));
    assert_eq!(check(&points, &[1.0]), "triangulated");
    assert!(made(&points).unwrap().cells().len() > 119 * 119);
}

/// A line of points and two more: time must not grow with the square of their number.
#[test]
fn a_long_line_and_two_points() {
    let line = (0..200_000).map(|i| ([f64::from(i), 0.0, 0.0], 0.0));
    let more = [([0.0, 1.0, 0.0], 0.0), ([5.0, 0.0, 1.0], 0.0)];
    let points = weighted(line.chain(more));
    assert_eq!(made(&points).unwrap().finite_cells().count(), 199_999);
}
