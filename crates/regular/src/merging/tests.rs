use walpha_base::random::Random;

use super::Along;
use super::numbering::number;
use crate::incremental::{Built, insert_cells};
use crate::{CellArrays, Sites, TriangulationError};

/// The triangulation with leaves of at most `leaf` points, and that of one leaf, or the errors.
fn both(points: &[([f64; 3], f64)], leaf: usize) -> [Result<CellArrays, TriangulationError>; 2] {
    let (positions, weights): (Vec<_>, Vec<_>) = points.iter().copied().unzip();
    let sites = Sites::any(&positions, &weights).unwrap();
    let along = |v: &u32| *v as usize;
    let positions: Vec<_> = sites.curve().iter().map(|v| sites.positions()[along(v)]).collect();
    let weights: Vec<_> = sites.curve().iter().map(|v| sites.weights()[along(v)]).collect();
    let curve = Along::new(&positions, &weights).unwrap();
    let merged = curve.divide_and_merge(leaf, &|_| Ok(()));
    let one = insert_cells(&positions, &weights, |_| Ok(()));
    [
        merged.and_then(|mesh| {
            let at_infinity = positions.len() as u32;
            mesh.map_or_else(
                || one_leaf(insert_cells(&positions, &weights, |_| Ok(()))),
                |mesh| number(mesh.slots, at_infinity),
            )
        }),
        one_leaf(one),
    ]
}

fn one_leaf(built: Result<Built, TriangulationError>) -> Result<CellArrays, TriangulationError> {
    built.and_then(|Built { cells, at_infinity, .. }| CellArrays::of_cells(cells, at_infinity))
}

/// Sets of points, most of them degenerate; each case has a number.
fn set(random: &mut Random, case: usize) -> Vec<([f64; 3], f64)> {
    let count = 5 + random.below(120);
    let mut unit = || random.unit();
    let place = |unit: &mut dyn FnMut() -> f64| [unit(), unit(), unit()];
    (0..count)
        .map(|i| {
            let p = place(&mut unit);
            let t = i as f64;
            let w = unit();
            match case % 10 {
                0 => (p, 0.0),
                1 => (p, w * 0.05),
                // A lattice, without and with weights that hide points.
                2 => (p.map(|x| (x * 5.0).floor()), 0.0),
                3 => (p.map(|x| (x * 6.0).floor()), (w * 4.0).floor()),
                // Points on a sphere of lattice points, and in few planes.
                4 => {
                    let [a, b, c] = [[3.0, 4.0, 0.0], [5.0, 0.0, 0.0], [0.0, 3.0, -4.0]][i % 3];
                    let sign = |x: f64, u: f64| if u < 0.5 { -x } else { x };
                    let q = [sign(a, p[0]), sign(b, p[1]), sign(c, p[2])];
                    ([q[i / 3 % 3], q[(i / 3 + 1) % 3], q[(i / 3 + 2) % 3]], 0.0)
                }
                5 => ([(p[0] * 9.0).floor(), (p[1] * 9.0).floor(), (p[2] * 2.0).floor()], 0.0),
                // A few points of large weight hide many.
                6 => (p, if i % 17 == 0 { 0.3 } else { 0.0 }),
                // The moment curve: all points are neighbours of all.
                7 => ([t, t * t, t * t * t], 0.0),
                // Two lines; a leaf need not span a volume.
                8 if i % 2 == 0 => ([t, 0.0, 0.0], 0.0),
                8 => ([20.0, t - 30.0, 1.0], 0.0),
                // Neighbours that differ in the last bit.
                _ => (p.map(|x| 1.0 + (x * 4.0).floor() * f64::EPSILON), w.floor()),
            }
        })
        .collect()
}

#[test]
fn merged_leaves_are_the_whole() {
    let mut random = Random::new(31);
    let mut merged = 0;
    for case in 0..2000 {
        let points = set(&mut random, case);
        for leaf in [1, 4, 30] {
            match both(&points, leaf) {
                [Ok(a), Ok(b)] => {
                    assert_eq!(a.cells(), b.cells(), "case {case}, leaves of {leaf}");
                    assert_eq!(a.adjacency(), b.adjacency(), "case {case}, leaves of {leaf}");
                    merged += 1;
                }
                [Err(a), Err(b)] => assert_eq!(a.to_string(), b.to_string()),
                [a, b] => panic!("case {case}: {a:?} and {b:?}"),
            }
        }
    }
    assert!(merged > 5000, "{merged}");
}

#[test]
fn threads_do_not_change_the_triangulation() {
    let mut random = Random::new(7);
    let mut unit = move || random.unit();
    let count = super::MIN_POINTS + 5000;
    let sets: [Vec<([f64; 3], f64)>; 2] = [
        (0..count).map(|_| ([unit(), unit(), unit()], 1e-4 * unit())).collect(),
        (0..count as u32)
            .map(|i| [i % 42, i / 42 % 42, i / 1764].map(f64::from))
            .map(|p| (p, (3.0 * unit()).floor()))
            .collect(),
    ];
    for set in sets {
        let (positions, weights): (Vec<_>, Vec<_>) = set.into_iter().unzip();
        let made = [1, 2, 3, 8].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| crate::triangulate(&positions, Some(&weights))).unwrap()
        });
        for other in &made[1..] {
            assert_eq!(other.cells(), made[0].cells());
            assert_eq!(other.adjacency(), made[0].adjacency());
        }
    }
}

/// On a sphere all cells are open: merging would take more work than it saves.
#[test]
fn merging_pays_but_on_a_sphere() {
    let mut random = Random::new(3);
    let mut unit = move || random.unit();
    let filled: Vec<_> = (0..50_000).map(|_| [unit(), unit(), unit()]).collect();
    let on_sphere = |i: u32| {
        let (turn, z) = (f64::from(i) * 2.4, f64::from(2 * i) / 50_000.0 - 1.0);
        let radius = (1.0 - z * z).sqrt();
        [radius * turn.cos(), radius * turn.sin(), z]
    };
    let sphere: Vec<_> = (0..50_000).map(on_sphere).collect();
    for (positions, expected) in [(filled, true), (sphere, false)] {
        let weights = vec![0.0; positions.len()];
        let sites = Sites::new(&positions, &weights).unwrap();
        let along: Vec<_> = sites.curve().iter().map(|&v| positions[v as usize]).collect();
        assert_eq!(Along::new(&along, &weights).unwrap().merging_pays().unwrap(), expected);
    }
}
