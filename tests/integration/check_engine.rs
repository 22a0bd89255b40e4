//! The CGAL engine against the enumeration, simplex by simplex: extreme numbers and the order of the input, too.

use proptest::prelude::*;
use walpha::Class;
use walpha::shape::Engine;
use walpha_base::random::Random;

use crate::check_command::{Answer, Case, definition, engine, engine_of, grid};
use crate::common;

/// All answers must be equal, and the engines must agree whether there is one.
#[track_caller]
fn agree(case: &Case) -> bool {
    let expected = definition(case);
    for which in [Engine::Cgal, Engine::Native] {
        match (&expected, engine_of(case, which)) {
            (Ok(expected), Ok(got)) => {
                assert!(*expected == got, "{which:?} {case:?}\nexpected {expected:?}\ngot {got:?}");
            }
            (Err(_), Err(_)) => {}
            (expected, got) => {
                panic!("{which:?} {case:?}\nexpected {expected:?}\ngot {:?}", got.err())
            }
        }
    }
    // Flat sets must agree, too, but are not triangulations of space.
    expected.is_ok_and(|answer| !answer.complex.cells.is_empty())
}

/// Checks many cases; all but a few must be triangulations.
#[track_caller]
fn agree_on(count: usize, mut make: impl FnMut(&mut Random) -> Case) {
    let mut random = Random::new(20_260_712);
    let solid = (0..count).filter(|_| agree(&make(&mut random))).count();
    assert!(solid * 4 >= count * 3, "only {solid} of {count} cases span a volume");
}

fn weights(random: &mut Random, n: usize) -> Vec<f64> {
    let kind = random.below(4);
    let draw = |random: &mut Random| match kind {
        0 => 3.0,
        1 => random.below(4) as f64,
        2 => random.below(6) as f64 / 2.0,
        _ => random.unit() * 2.0,
    };
    (0..n).map(|_| draw(random)).collect()
}

fn alpha(random: &mut Random) -> f64 {
    random.pick(&[0.0, 0.5, 0.75, 1.0, 1.25, 2.0, 2.5, 10.0, -1.0, f64::INFINITY, -f64::INFINITY])
}

#[test]
fn subsets_of_a_grid() {
    agree_on(1500, |random| {
        let side = 2 + random.below(3);
        let mut positions = grid(side);
        random.shuffle(&mut positions);
        positions.truncate(5 + random.below(9));
        let weights = weights(random, positions.len());
        Case { positions, weights, alpha: alpha(random) }
    });
}

#[test]
fn whole_grids() {
    let mut random = Random::new(4);
    for n in [2, 3] {
        for _ in 0..20 {
            let positions = grid(n);
            let weights = weights(&mut random, positions.len());
            assert!(agree(&Case { positions, weights, alpha: alpha(&mut random) }));
        }
    }
    for weight in [0.0, 1.5] {
        let positions = grid(4);
        let weights = vec![weight; 64];
        assert!(agree(&Case { positions, weights, alpha: 0.75 }));
    }
}

#[test]
fn random_points() {
    agree_on(300, |random| {
        let n = 5 + random.below(10);
        let positions = (0..n).map(|_| [0; 3].map(|_| random.unit())).collect();
        let weights = (0..n).map(|_| random.unit() * 0.3 - 0.1).collect();
        Case { positions, weights, alpha: random.unit() * 0.3 }
    });
}

#[test]
fn sixty_points() {
    let mut random = Random::new(60);
    let positions: Vec<_> = (0..60).map(|_| [0; 3].map(|_| random.below(5) as f64)).collect();
    let weights = (0..60).map(|_| random.below(3) as f64).collect();
    assert!(agree(&Case { positions, weights, alpha: 1.0 }));
}

/// Integer points on one sphere: x² + y² + z² = 9, 26 or 50, with or without the centre.
#[test]
fn cospherical() {
    let on_sphere = |square: i32| {
        let axis = || -7..=7;
        let points =
            axis().flat_map(move |x| axis().flat_map(move |y| axis().map(move |z| [x, y, z])));
        points.filter(move |p| p.iter().map(|x| x * x).sum::<i32>() == square)
    };
    agree_on(300, |random| {
        let square = random.pick(&[9, 26, 50]);
        let mut positions: Vec<_> = on_sphere(square).map(|p| p.map(f64::from)).collect();
        random.shuffle(&mut positions);
        positions.truncate(6 + random.below(8));
        let mut weights = vec![random.below(3) as f64; positions.len()];
        if random.below(2) == 0 {
            positions.push([0.0; 3]);
            weights.push(random.pick(&[0.0, -5.0, -9.0, -26.0, -50.0]));
        }
        let alpha = random.pick(&[0.0, 4.5, 8.0, 9.0, 26.0, 48.0, 50.0]);
        Case { positions, weights, alpha }
    });
}

#[test]
fn cube_corners_and_centres() {
    agree_on(300, |random| {
        let mut positions = grid(2 + random.below(2));
        let centres = positions.clone().into_iter().map(|p| p.map(|x| x + 0.5));
        positions.extend(centres.filter(|p| p.iter().all(|&x| x < 2.0)));
        random.shuffle(&mut positions);
        positions.truncate(6 + random.below(12));
        let tie = random.pick(&[-0.75, 0.0, 0.25, 0.5, 0.75, 1.0]);
        let weight = |p: &[f64; 3]| if p[0].fract() == 0.0 { 0.0 } else { tie };
        let weights = positions.iter().map(weight).collect();
        Case { positions, weights, alpha: random.pick(&[0.0, 0.25, 0.5, 0.75, 1.0]) }
    });
}

/// Most points lie in one plane or on one line, the others outside of it.
#[test]
fn coplanar_and_collinear_runs() {
    agree_on(600, |random| {
        let flat = 1 + random.below(2);
        let mut positions: Vec<_> = (0..4 + random.below(8))
            .map(|_| {
                let mut p = [0; 3].map(|_| random.below(4) as f64);
                p[flat..].fill(1.0);
                if random.below(3) == 0 { [p[0], p[0] + p[1], p[2] + p[1]] } else { p }
            })
            .collect();
        for _ in 0..2 + random.below(3) {
            positions.push([0; 3].map(|_| random.below(4) as f64));
        }
        let weights = weights(random, positions.len());
        Case { positions, weights, alpha: alpha(random) }
    });
}

#[test]
fn duplicates_and_heavy_points() {
    agree_on(500, |random| {
        let n = 6 + random.below(10);
        let positions = (0..n).map(|_| [0; 3].map(|_| random.below(3) as f64)).collect();
        let heavy = |random: &mut Random| if random.below(6) == 0 { 9.0 } else { 0.0 };
        let weights = (0..n).map(|_| heavy(random) + random.below(3) as f64).collect();
        Case { positions, weights, alpha: alpha(random) }
    });
}

/// α is exactly at R² of some simplex, and one ulp away from it: a facet with R² = 10 on the grid.
#[test]
fn critical_alpha() {
    let facet = [[0.0, 0.0, 0.0], [0.0, 2.0, 4.0], [0.0, 6.0, 0.0]];
    for alpha in [10.0f64.next_down(), 10.0, 10.0f64.next_up()] {
        agree_on(60, |random| {
            let mut positions = facet.to_vec();
            for _ in 0..5 {
                positions.push([0; 3].map(|_| random.below(8) as f64));
            }
            Case { weights: vec![0.0; 8], positions, alpha }
        });
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, ..ProptestConfig::default() })]

    /// Shrinks to few points with small numbers when it fails.
    #[test]
    fn any_small_set(
        points in prop::collection::vec((prop::array::uniform3(-3i8..=3), -4i8..=4), 5..14),
        halves in any::<bool>(),
        alpha in -3i8..=12,
    ) {
        let scale = if halves { 0.5 } else { 1.0 };
        let positions = points.iter().map(|(p, _)| p.map(f64::from)).collect();
        let weights = points.iter().map(|(_, w)| f64::from(*w) * scale).collect();
        let case = Case { positions, weights, alpha: f64::from(alpha) * 0.25 };
        prop_assert_eq!(agree(&case), common::spans_a_volume(&case.positions));
    }
}

#[test]
fn one_ulp_neighbours() {
    let near = |random: &mut Random, x: f64| match random.below(4) {
        0 => x.next_up(),
        1 => x.next_down(),
        _ => x,
    };
    agree_on(400, |random| {
        let n = 6 + random.below(6);
        let positions = (0..n)
            .map(|_| {
                [0; 3].map(|_| {
                    let x = random.below(3) as f64;
                    near(random, x)
                })
            })
            .collect();
        let weights = (0..n).map(|_| near(random, 1.0)).collect();
        let alpha = random.pick(&[-0.5, -0.25, 0.0, 0.5]);
        Case { positions, weights, alpha: near(random, alpha) }
    });
}

/// Coordinates from 1e-300 to 1e150, and weights to match.
#[test]
fn tiny_and_huge_coordinates() {
    agree_on(400, |random| {
        let scale = random.pick(&[1e-300, 1e-160, 1e-20, 1e20, 1e149]);
        let other = if random.below(3) == 0 { random.pick(&[1e-300, 1.0, 1e149]) } else { scale };
        let n = 5 + random.below(6);
        let positions = (0..n)
            .map(|_| {
                let s = if random.below(3) == 0 { other } else { scale };
                [0; 3].map(|_| (random.below(4) as f64) * s)
            })
            .collect();
        let weights = (0..n).map(|_| random.below(3) as f64 * scale * scale).collect();
        let alpha = random.pick(&[0.0, scale * scale, f64::MAX, -1.0]);
        Case { positions, weights, alpha }
    });
}

/// Five points whose determinants underflow: not one of them is zero.
#[test]
fn determinants_that_underflow() {
    let positions = [[2, 1, 3], [1, 3, 1], [0, 0, 3], [1, 0, 1], [1, 1, 2]]
        .map(|p| p.map(|x| f64::from(x) * 1e-300))
        .to_vec();
    assert!(agree(&Case { positions, weights: vec![0.0; 5], alpha: 0.0 }));
}

/// Points 0, 1, 3 and 5 span a volume of 1e-339: flat for doubles, not for the definition.
#[test]
fn a_cell_thinner_than_any_double() {
    let tiny = f64::from_bits(1);
    let [one, two] = [1f64, 2.0].map(f64::next_down);
    let [one_up, two_up] = [1f64, 2.0].map(f64::next_up);
    let positions = vec![
        [two_up, one, -tiny],
        [2.0, 0.0, -tiny],
        [0.0, one, 2.0],
        [two_up, two, tiny],
        [tiny, 2.0, tiny],
        [two_up, -tiny, tiny],
        [two, 2.0, 0.0],
        [one, one, one_up],
        [1.0, 1.0, 2.0],
        [two, one, one],
    ];
    let weights = vec![one, 1.0, one, 1.0, 1.0, one_up, 1.0, one_up, one_up, 1.0];
    assert!(agree(&Case { positions, weights, alpha: -0.5 }));
}

/// Shuffling the input gives the same complex in input indices.
#[test]
fn the_order_of_input_does_not_count() {
    let mut random = Random::new(21);
    for _ in 0..60 {
        let n = 8 + random.below(60);
        // Places of their own, so that no tie among duplicates depends on the order.
        let mut positions = grid(5);
        random.shuffle(&mut positions);
        positions.truncate(n);
        let weights = weights(&mut random, n);
        let case = Case { positions, weights, alpha: alpha(&mut random) };
        let spans = common::spans_a_volume(&case.positions);
        assert_eq!(engine(&case).is_ok(), spans, "{case:?}");
        assert!(spans, "nine of a grid's points and more are hardly in one plane");
        let straight = engine(&case).unwrap();
        let mut order: Vec<usize> = (0..n).collect();
        random.shuffle(&mut order);
        let shuffled = engine(&Case {
            positions: order.iter().map(|&i| case.positions[i]).collect(),
            weights: order.iter().map(|&i| case.weights[i]).collect(),
            alpha: case.alpha,
        })
        .unwrap();
        let back = |row: &[u32]| {
            let mut row: Vec<_> = row.iter().map(|&i| order[i as usize] as u32).collect();
            row.sort_unstable();
            row
        };
        assert_eq!(rows(&shuffled, back), rows(&straight, back_to_itself), "{case:?}");
    }
}

fn back_to_itself(row: &[u32]) -> Vec<u32> {
    let mut row = row.to_vec();
    row.sort_unstable();
    row
}

/// All simplices with sorted vertices and their classes, and the hidden points.
fn rows(answer: &Answer, renumber: impl Fn(&[u32]) -> Vec<u32>) -> Vec<(Vec<u32>, Option<Class>)> {
    let c = &answer.complex;
    let mut all: Vec<_> = c.cells.iter().map(|(r, class)| (renumber(r), Some(class))).collect();
    all.extend(c.facets.iter().map(|(r, class)| (renumber(r), Some(class))));
    all.extend(c.edges.iter().map(|(r, class)| (renumber(r), Some(class))));
    all.extend(c.vertices.iter().map(|(r, class)| (renumber(r), Some(class))));
    all.extend(answer.hidden.iter().map(|&i| (renumber(&[i]), None)));
    all.sort_unstable();
    all
}
