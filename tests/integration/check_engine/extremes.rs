//! Numbers at the ends of what doubles hold.

use super::*;

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
