//! Evenly spread view directions, without a sine at run time.

use walpha_base::vector::{V3, along, cross, unit};

/// cos and sin of the golden angle π(3 − √5). Turning by it again and again, by complex
/// multiplication, spreads directions evenly without a sine at run time.
const GOLDEN: [f64; 2] = [-0.737_368_878_078_319_7, 0.675_490_294_261_523_8];

/// Directions spread evenly over the sphere (Fibonacci lattice).
pub(super) fn sphere_directions(count: usize) -> Vec<V3> {
    spiral(count)
        .map(|(share, turn)| {
            let z = 1.0 - 2.0 * share;
            let r = (1.0 - z * z).sqrt();
            [r * turn[0], r * turn[1], z]
        })
        .collect()
}

/// Directions spread evenly over a cone of 11° around an axis: a lamp with soft shadows.
pub(super) fn cone_directions(axis: V3, count: usize) -> Vec<V3> {
    let (u, v) = across(axis);
    spiral(count)
        .filter_map(|(share, turn)| {
            let r = 0.2 * share.sqrt();
            unit(along(along(axis, r * turn[0], u), r * turn[1], v))
        })
        .collect()
}

/// The middle of each of `count` equal shares of 0..1, with a unit vector turned further by the
/// golden angle each time.
fn spiral(count: usize) -> impl Iterator<Item = (f64, [f64; 2])> {
    let mut turn = [1.0, 0.0];
    (0..count).map(move |k| {
        let [x, y] = turn;
        turn = [x * GOLDEN[0] - y * GOLDEN[1], x * GOLDEN[1] + y * GOLDEN[0]];
        ((k as f64 + 0.5) / count as f64, [x, y])
    })
}

/// Two unit vectors that are orthogonal to this one and to each other.
pub(super) fn across(axis: V3) -> (V3, V3) {
    let smallest = (0..3).fold(0, |s, k| if axis[k].abs() < axis[s].abs() { k } else { s });
    let mut other = [0.0; 3];
    other[smallest] = 1.0;
    let u = unit(cross(axis, other)).expect("the smallest component is not the only one");
    (u, cross(axis, u))
}
