//! The CGAL engine against the enumeration, simplex by simplex.

mod check_common;

use check_common::{Answer, Case, Random, engine, grid};
use walpha::check::enumerate;

/// Both answers must be equal, and so must be the decision that there is none.
#[track_caller]
fn agree(case: &Case) -> bool {
    let expected = enumerate(&case.positions, &case.weights, case.alpha);
    let got = engine(case);
    match (expected, got) {
        (Ok(e), Ok(got)) => {
            let expected =
                Answer { complex: e.complex, hidden: e.hidden, duplicates: e.duplicates };
            assert!(expected == got, "{case:?}\nexpected {expected:?}\ngot {got:?}");
            true
        }
        (Err(_), Err(_)) => false,
        (expected, got) => panic!("{case:?}\nexpected {expected:?}\ngot {:?}", got.err()),
    }
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
