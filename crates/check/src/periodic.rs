//! Copies of points in a periodic box.

/// The multiples of the sides that move `to` to its copy nearest to `from`.
pub(crate) fn nearest_copy(sides: [f64; 3], from: [f64; 3], to: [f64; 3]) -> [i32; 3] {
    [0, 1, 2].map(|k| {
        let (way, half) = (to[k] - from[k], sides[k] / 2.0);
        i32::from(way < -half) - i32::from(way > half)
    })
}

/// A position moved by multiples of the sides.
pub(crate) fn moved(sides: [f64; 3], position: [f64; 3], by: [i32; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| position[k] + f64::from(by[k]) * sides[k])
}
