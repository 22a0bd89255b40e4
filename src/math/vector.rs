//! Three-dimensional vectors.

use super::number;

pub(crate) type V3 = [f64; 3];

#[cfg(feature = "render")]
pub(crate) fn add(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[cfg(feature = "render")]
pub(crate) fn scale(a: V3, s: f64) -> V3 {
    [a[0] * s, a[1] * s, a[2] * s]
}

/// a + s·b
#[cfg(feature = "render")]
pub(crate) fn along(a: V3, s: f64, b: V3) -> V3 {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

pub(crate) fn dot(a: V3, b: V3) -> f64 {
    number::dot(&a, &b)
}

pub(crate) fn cross(a: V3, b: V3) -> V3 {
    number::cross(&a, &b)
}

pub(crate) fn length(a: V3) -> f64 {
    dot(a, a).sqrt()
}

/// The vector scaled to length 1; `None` when it has no direction.
#[cfg(feature = "render")]
pub(crate) fn unit(a: V3) -> Option<V3> {
    // Dividing by the largest component first keeps the squares in range.
    let largest = a[0].abs().max(a[1].abs()).max(a[2].abs());
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let a = scale(a, 1.0 / largest);
    Some(scale(a, 1.0 / length(a)))
}

/// The number moved into 0..1; NaN becomes 0, where `clamp` would keep it.
#[expect(clippy::manual_clamp)]
#[cfg(feature = "render")]
pub(crate) fn saturate(x: f64) -> f64 {
    x.max(0.0).min(1.0)
}
