use std::cmp::Ordering;

use super::WeightedPoint;
use super::formulas::{Area, Power1, Power2, Power3, Power4, Radius2, Radius3, Radius4, Volume};
use super::frame::sign_of;
use crate::Alpha;

/// Where a weighted point is relative to the smallest orthogonal sphere of others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// Strictly inside: its power product with the sphere is negative.
    Inside,
    /// On the sphere: orthogonal to it.
    On,
    /// Strictly outside.
    Outside,
}

impl Side {
    fn of(sign: Ordering) -> Self {
        match sign {
            Ordering::Less => Self::Inside,
            Ordering::Equal => Self::On,
            Ordering::Greater => Self::Outside,
        }
    }
}

/// The sign of det(b−a, c−a, d−a), as its comparison with zero: `Greater` if a, b, c turn
/// counter-clockwise seen from d.
pub(crate) fn orientation(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> Ordering {
    let [a, b, c, d] = [a, b, c, d].map(WeightedPoint::bare);
    sign_of(&Volume, &a, [&b, &c, &d], 0.0)
}

/// Whether three points lie on one line.
pub(crate) fn collinear(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> bool {
    let [a, b, c] = [a, b, c].map(WeightedPoint::bare);
    sign_of(&Area, &a, [&b, &c], 0.0).is_eq()
}

/// Where `q` is relative to the smallest orthogonal sphere of 1 to 4 affinely independent points.
///
/// # Panics
/// If there are none or more than 4.
pub(crate) fn side<const N: usize>(simplex: [&WeightedPoint; N], q: &WeightedPoint) -> Side {
    Side::of(match simplex[..] {
        [a] => sign_of(&Power1, a, [q], 0.0),
        [a, b] => sign_of(&Power2, a, [b, q], 0.0),
        [a, b, c] => sign_of(&Power3, a, [b, c, q], 0.0),
        [a, b, c, d] => {
            let sign = sign_of(&Power4, a, [b, c, d, q], 0.0);
            match orientation(a.position, b.position, c.position, d.position) {
                Ordering::Less => sign.reverse(),
                _ => sign,
            }
        }
        _ => panic!("a simplex has 1 to 4 vertices, not {N}"),
    })
}

/// The squared radius of the smallest orthogonal sphere of 1 to 4 affinely independent points,
/// compared with α (±∞ allowed).
///
/// # Panics
/// If there are none or more than 4.
pub(crate) fn radius<const N: usize>(simplex: [&WeightedPoint; N], alpha: Alpha) -> Ordering {
    let alpha = alpha.squared();
    if alpha.is_infinite() {
        return 0.0.partial_cmp(&alpha).expect("infinity compares");
    }
    match simplex[..] {
        [a] => (-a.weight).partial_cmp(&alpha).expect("neither weights nor α are NaN"),
        [a, b] => sign_of(&Radius2, a, [b], alpha),
        [a, b, c] => sign_of(&Radius3, a, [b, c], alpha),
        [a, b, c, d] => sign_of(&Radius4, a, [b, c, d], alpha),
        _ => panic!("a simplex has 1 to 4 vertices, not {N}"),
    }
}
