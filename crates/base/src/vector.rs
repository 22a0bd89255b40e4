//! Three-dimensional vectors.

/// A vector (x, y, z).
pub type V3 = [f64; 3];

/// a + b
pub fn add(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a − b
pub fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// s·a
pub fn scale(a: V3, s: f64) -> V3 {
    [a[0] * s, a[1] * s, a[2] * s]
}

/// a + s·b
pub fn along(a: V3, s: f64, b: V3) -> V3 {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// The inner product.
pub fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
pub fn cross(a: V3, b: V3) -> V3 {
    let minor = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// The length.
pub fn length(a: V3) -> f64 {
    dot(a, a).sqrt()
}

/// The vector scaled to length 1; `None` if it has no direction.
pub fn unit(a: V3) -> Option<V3> {
    // Dividing by the largest component first keeps the squares in range.
    let largest = a[0].abs().max(a[1].abs()).max(a[2].abs());
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let a = scale(a, 1.0 / largest);
    Some(scale(a, 1.0 / length(a)))
}

/// The number clamped to 0..1. NaN becomes 0, where `clamp` would keep it.
#[expect(clippy::manual_clamp)]
pub fn saturate(x: f64) -> f64 {
    x.max(0.0).min(1.0)
}
