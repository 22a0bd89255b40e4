use std::cmp::Ordering;

use super::formulas::Power4;
use super::frame::sign_of;
use super::{WeightedPoint, orientation};

/// The order of the perturbation: points by x, then y, then z. The largest is raised most.
fn rank(a: &WeightedPoint, b: &WeightedPoint) -> Ordering {
    a.position.partial_cmp(&b.position).expect("coordinates are not NaN")
}

/// Whether `q` refutes a positively oriented cell: whether it is strictly inside the cell's
/// orthogonal sphere, after the symbolic perturbation when it is on it. `q` is at none of the
/// cell's vertices.
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
    order.sort_unstable_by(|&i, &j| rank(cell[j], cell[i]));
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
    // Only a flat cell gets here, which has no sphere to be inside of.
    false
}
