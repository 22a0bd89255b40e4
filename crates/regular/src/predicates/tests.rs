//! Compares with determinants of integers by their definition, which no code of the kernel computes.

use std::collections::BTreeSet;

use dashu_int::IBig;
use walpha_base::random::Random;

use super::*;
use crate::number::integer;

/// The unit in which every finite double is an integer.
const UNIT: i32 = -1074;

/// The determinant by its definition: over all permutations of columns.
fn determinant(rows: &[Vec<IBig>]) -> IBig {
    let Some((first, rest)) = rows.split_first() else { return IBig::ONE };
    let mut sum = IBig::ZERO;
    for (column, number) in first.iter().enumerate() {
        let minor = |row: &Vec<IBig>| {
            let mut row = row.clone();
            row.remove(column);
            row
        };
        let minor: Vec<_> = rest.iter().map(minor).collect();
        let term = number * determinant(&minor);
        if column % 2 == 0 { sum += term } else { sum -= term }
    }
    sum
}

fn places(points: &[[f64; 3]]) -> Vec<Vec<IBig>> {
    points.iter().map(|p| p.iter().map(|&x| integer(x, UNIT)).collect()).collect()
}

/// The sign of the matrix of homogeneous coordinates (1, x, y, z).
fn orientation_by_definition(points: [[f64; 3]; 4]) -> Ordering {
    let rows: Vec<Vec<IBig>> =
        places(&points).into_iter().map(|p| [vec![IBig::ONE], p].concat()).collect();
    determinant(&rows).cmp(&IBig::ZERO)
}

/// The sign of the matrix of lifted points (1, x, y, z, |p|² − ω), with the tested point last.
fn power_by_definition(points: [[f64; 3]; 5], weights: [f64; 5]) -> Ordering {
    let lifted = |(p, weight): (Vec<IBig>, f64)| {
        let square: IBig = p.iter().map(|x| x * x).sum();
        let height = square - (integer(weight, UNIT) << (-UNIT) as usize);
        [vec![IBig::ONE], p, vec![height]].concat()
    };
    let rows: Vec<_> = places(&points).into_iter().zip(weights).map(lifted).collect();
    // Positive if the last point is outside a positively oriented cell.
    determinant(&rows).cmp(&IBig::ZERO)
}

/// Small integers and their neighbours, halves, and numbers of any size up to both ends of the range of doubles.
fn number(random: &mut Random, wild: bool) -> f64 {
    let small = random.below(9) as f64 - 4.0;
    match random.below(12) {
        _ if !wild => small,
        0 => small.next_up(),
        1 => small / 2.0,
        2 => small * 2f64.powi(random.below(2000) as i32 - 1000),
        3 => random.next() as f64 / 1e19,
        4 => [5e-324, -5e-324, f64::MAX, f64::MIN, f64::MIN_POSITIVE][random.below(5)],
        5 => small + 2f64.powi(-30) * (random.below(3) as f64 - 1.0),
        _ => small,
    }
}

#[test]
fn signs_are_those_of_the_definition() {
    let mut random = Random::new(11);
    let mut seen = BTreeSet::new();
    for round in 0..4000 {
        let wild = round % 3 != 0;
        let points: [[f64; 3]; 5] =
            std::array::from_fn(|_| [0; 3].map(|_| number(&mut random, wild)));
        let weighted = round % 2 == 0;
        let weights = [0; 5].map(|_| if weighted { number(&mut random, wild) } else { 0.0 });
        let [a, b, c, d, q] = points;
        let oriented = orientation(a, b, c, d);
        assert_eq!(oriented, orientation_by_definition([a, b, c, d]), "{points:?}");
        let [wa, wb, wc, wd, wq] = weights;
        let power = power_test([a, b, c, d], [wa, wb, wc, wd], q, wq);
        assert_eq!(power, power_by_definition(points, weights), "{points:?} {weights:?}");
        // Two corners exchanged reverse both.
        assert_eq!(orientation(b, a, c, d), oriented.reverse());
        assert_eq!(power_test([b, a, c, d], [wb, wa, wc, wd], q, wq), power.reverse());
        seen.insert((wild, weighted, oriented, power));
    }
    // Nine pairs of signs for each of four kinds; wild numbers have few ties.
    assert!(seen.len() > 27, "{}: {seen:?}", seen.len());
}

#[test]
fn signs_that_doubles_get_wrong() {
    // Tenths on the plane z = x + y, which are rounded: their determinants are about one rounding.
    let naive = |[a, b, c, d]: [[f64; 3]; 4]| {
        let [u, v, w] = [b, c, d].map(|q| [0, 1, 2].map(|k| q[k] - a[k]));
        let minor = |i: usize, j: usize| v[i] * w[j] - v[j] * w[i];
        u[0] * minor(1, 2) + u[1] * minor(2, 0) + u[2] * minor(0, 1)
    };
    let mut random = Random::new(7);
    let mut reversed = 0;
    for _ in 0..2000 {
        let points: [[f64; 3]; 4] = std::array::from_fn(|_| {
            let [x, y] = [0; 2].map(|_| random.below(100));
            [x, y, x + y].map(|tenths| tenths as f64 / 10.0)
        });
        let [a, b, c, d] = points;
        let truth = orientation_by_definition(points);
        assert_eq!(orientation(a, b, c, d), truth, "{points:?}");
        let sign = naive(points).partial_cmp(&0.0).unwrap();
        reversed += usize::from(sign.is_ne() && sign == truth.reverse());
    }
    assert!(reversed > 100, "{reversed}");
}

#[test]
fn what_is_not_finite_panics() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let [a, b, c, d] = points;
        assert!(std::panic::catch_unwind(|| orientation(a, b, c, [d[0], bad, d[2]])).is_err());
        assert!(std::panic::catch_unwind(|| power_test(points, [0.0; 4], [bad; 3], 0.0)).is_err());
        assert!(std::panic::catch_unwind(|| power_test(points, [0.0; 4], [1.0; 3], bad)).is_err());
        assert!(
            std::panic::catch_unwind(|| power_test(points, [0.0, bad, 0.0, 0.0], [1.0; 3], 0.0))
                .is_err()
        );
    }
}
