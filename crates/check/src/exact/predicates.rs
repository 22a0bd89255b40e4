//! The predicates: orientation, side of a sphere, squared radius against α, and conflict with a cell.

use std::cmp::Ordering;

use walpha_base::sort::sort_handful_by;

use super::formulas::{Area, Power1, Power2, Power3, Power4, Radius2, Radius3, Radius4, Volume};
use super::frame::{WeightedPoint, sign_of};
use crate::Alpha;

/// The location of a weighted point relative to the smallest orthogonal sphere of others.
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

/// The location of `q` relative to the smallest orthogonal sphere of 1 to 4 affinely independent points.
///
/// # Panics
/// If the number of points is 0 or more than 4.
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
/// If the number of points is 0 or more than 4.
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

/// The order of the perturbation: points by x, then y, then z. The largest is raised most.
fn rank(a: &WeightedPoint, b: &WeightedPoint) -> Ordering {
    a.position.partial_cmp(&b.position).expect("coordinates are not NaN")
}

/// Whether `q` refutes a positively oriented cell: whether it is strictly inside the cell's orthogonal sphere, or, if it is on
/// the sphere, inside after the symbolic perturbation. `q` is not at a vertex of the cell.
///
/// **The perturbation** (Devillers & Teillaud, Comput. Geom. 44, 2011,
/// doi:10.1016/j.comgeo.2010.09.010; CGAL's `Regular_triangulation_3` uses the same). The lifted
/// height of each point is raised by a positive infinitesimal, and of two points the one later in
/// the [`rank`] order by infinitely more. Then no five lifted points are in one hyperplane, and
/// the regular triangulation is unique: a function of the points alone.
///
/// **Its sign.** For q on the sphere, let q = Σ λᵢ pᵢ with Σ λᵢ = 1. The raised q is above the
/// hyperplane through the raised cell by `ε_q` − Σ λᵢ εᵢ, and inside if that is negative. Take the
/// five points from the largest: if it is q, q is outside; if it is pᵢ, q is inside for λᵢ > 0 and
/// outside for λᵢ < 0, and for λᵢ = 0 the next point decides. λᵢ has the sign of the cell's
/// orientation with q in the place of pᵢ. At most two λ are zero, or q would be a vertex, so the
/// third point decides at the latest.
pub(crate) fn in_conflict(cell: [&WeightedPoint; 4], q: &WeightedPoint) -> bool {
    let [a, b, c, d] = cell;
    match sign_of(&Power4, a, [b, c, d, q], 0.0) {
        Ordering::Less => true,
        Ordering::Greater => false,
        Ordering::Equal => perturbed(cell, q),
    }
}

fn perturbed(cell: [&WeightedPoint; 4], q: &WeightedPoint) -> bool {
    let mut order = [0, 1, 2, 3];
    sort_handful_by(&mut order, |&i, &j| rank(cell[j], cell[i]));
    for i in order {
        if rank(q, cell[i]).is_gt() {
            return false;
        }
        let mut with_q = cell.map(|p| p.position);
        with_q[i] = q.position;
        let [a, b, c, d] = with_q;
        match orientation(a, b, c, d) {
            Ordering::Equal => {}
            sign => return sign.is_gt(),
        }
    }
    // Only a flat cell, which has no sphere, reaches this line.
    false
}
