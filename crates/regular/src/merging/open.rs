//! Finds the cells of one half that may be in conflict with a point of the other half.

use walpha_base::vector::{cross, dot, sub as minus};

use super::Points;
use super::slots::{Marks, Slots};
use crate::facets;
use crate::kernel::extent;

/// The extent of points: their bounding box and largest weight.
#[derive(Clone, Copy)]
pub(super) struct Extent {
    low: [f64; 3],
    high: [f64; 3],
    heaviest: f64,
}

/// A cell whose volume is smaller than this part of the sum of its terms has a sphere that rounding leaves undecided.
const MIN_CONDITION: f64 = 1.0 / (1u32 << 20) as f64;
/// Then the relative error of the sphere's centre, compared with the sum of its terms, is below 2⁻²⁷.
const CENTRE_ERROR: f64 = 1.0 / (1u32 << 24) as f64;
/// Bounds the relative error of sums of a few terms.
const SUM_ERROR: f64 = 1.0 / (1u64 << 45) as f64;
/// Volumes below this are undecided; above it, underflow moves a centre by less than [`UNDERFLOW`].
const MIN_VOLUME: f64 = 1e-200;
const UNDERFLOW: f64 = 1e-120;

impl Extent {
    pub(super) fn of(positions: &[[f64; 3]], weights: &[f64]) -> Self {
        let (low, high) = extent(positions);
        Self { low, high, heaviest: weights.iter().copied().fold(f64::NEG_INFINITY, f64::max) }
    }

    pub(super) fn union(&self, other: &Self) -> Self {
        Self {
            low: [0, 1, 2].map(|k| self.low[k].min(other.low[k])),
            high: [0, 1, 2].map(|k| self.high[k].max(other.high[k])),
            heaviest: self.heaviest.max(other.heaviest),
        }
    }

    /// Whether a plane across an axis lies strictly between two extents.
    pub(super) fn is_apart(&self, other: &Self) -> bool {
        (0..3).any(|k| self.high[k] < other.low[k] || other.high[k] < self.low[k])
    }

    /// Whether it is certain that no point of the extent is in conflict with a cell. `false` if rounding leaves it undecided,
    /// which includes NaN and infinities.
    fn is_clear_of(&self, corners: [u32; 4], points: &Points<'_>) -> bool {
        match corners.iter().position(|&v| v == points.at_infinity) {
            Some(corner) => self.is_behind(facets(corners)[corner], points),
            None => self.is_outside(corners, points),
        }
    }

    /// Whether all points of the extent are behind a facet, and none in its plane.
    fn is_behind(&self, facet: [u32; 3], points: &Points<'_>) -> bool {
        let [a, b, c] = facet.map(|v| points.positions[v as usize]);
        let (u, v) = (minus(b, a), minus(c, a));
        let normal = cross(u, v);
        let (low, high) = (minus(self.low, a), minus(self.high, a));
        let farthest: f64 = (0..3).map(|k| (normal[k] * low[k]).max(normal[k] * high[k])).sum();
        let terms = crossed_terms(u, v);
        let all: f64 = (0..3).map(|k| terms[k] * low[k].abs().max(high[k].abs())).sum();
        farthest < -(SUM_ERROR * all + f64::MIN_POSITIVE)
    }

    /// Whether all points of the extent are outside the orthogonal sphere of a cell. With the corner o as origin, the
    /// centre x solves 2 p·x = |p|² − ω(p) + ω(o) for the other corners p, and the squared radius is |x|² − ω(o).
    fn is_outside(&self, corners: [u32; 4], points: &Points<'_>) -> bool {
        let [o, a, b, c] = corners.map(|v| points.positions[v as usize]);
        let [wo, wa, wb, wc] = corners.map(|v| points.weights[v as usize]);
        let (a, b, c) = (minus(a, o), minus(b, o), minus(c, o));
        let half = |p: [f64; 3], w: f64| 0.5 * (dot(p, p) - w + wo);
        let half_terms = |p: [f64; 3], w: f64| 0.5 * (dot(p, p) + w.abs() + wo.abs());
        let (ha, hb, hc) = (half(a, wa), half(b, wb), half(c, wc));
        let (ta, tb, tc) = (half_terms(a, wa), half_terms(b, wb), half_terms(c, wc));
        let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
        let (tbc, tca, tab) = (crossed_terms(b, c), crossed_terms(c, a), crossed_terms(a, b));
        let volume = dot(a, bc);
        let volume_terms = dot(a.map(f64::abs), tbc);
        let is_decided = volume.abs() > MIN_CONDITION * volume_terms && volume.abs() > MIN_VOLUME;
        let (mut away, mut reach) = (0.0, 0.0);
        for k in 0..3 {
            let x = (ha * bc[k] + hb * ca[k] + hc * ab[k]) / volume;
            let terms = (ta * tbc[k] + tb * tca[k] + tc * tab[k]) / volume.abs();
            let (low, high) = (self.low[k] - o[k], self.high[k] - o[k]);
            let error = CENTRE_ERROR * terms + UNDERFLOW + SUM_ERROR * (low.abs().max(high.abs()));
            let distance = ((low - x).max(x - high) - error).max(0.0);
            away += distance * distance;
            reach += (x.abs() + error) * (x.abs() + error);
        }
        let terms = reach + wo.abs() + self.heaviest.abs();
        let reach = reach - wo + self.heaviest + SUM_ERROR * terms + f64::MIN_POSITIVE;
        is_decided && away * (1.0 - SUM_ERROR) > reach
    }
}

/// The sums of the magnitudes of the terms of a cross product.
fn crossed_terms([a, b, c]: [f64; 3], [u, v, w]: [f64; 3]) -> [f64; 3] {
    [(b * w).abs() + (c * v).abs(), (c * u).abs() + (a * w).abs(), (a * v).abs() + (b * u).abs()]
}

/// The mark of a closed cell.
pub(super) const CLOSED: u8 = 1;
/// The mark of an open cell.
pub(super) const OPEN: u8 = 2;

/// Appends the open cells of the half that an infinite cell belongs to, and marks them: all cells with which a point of the other
/// half, within `other`, is in conflict. The cells in conflict with one point are connected, and an infinite one is among them,
/// because the point is outside the convex hull of this half. So flooding from the hull finds all.
pub(super) fn flood(
    slots: &Slots,
    infinite: u32,
    other: &Extent,
    points: &Points<'_>,
    marks: &mut Marks,
    open: &mut Vec<u32>,
) {
    let mut mark = |slot: u32, open: &mut Vec<u32>| {
        let mark = marks.of(slot);
        let is_new = *mark == 0;
        if is_new {
            let is_open = !other.is_clear_of(slots.get(slot).corners, points);
            *mark = if is_open { OPEN } else { CLOSED };
            if is_open {
                open.push(slot);
            }
        }
        is_new
    };
    // All infinite cells: they are connected by their facets with the infinite vertex.
    let mut hull = vec![infinite];
    let mut at = open.len();
    mark(infinite, open);
    while let Some(slot) = hull.pop() {
        let cell = slots.get(slot);
        for (v, side) in cell.corners.into_iter().zip(cell.neighbors) {
            if v != points.at_infinity && mark(side / 4, open) {
                hull.push(side / 4);
            }
        }
    }
    while let Some(&slot) = open.get(at) {
        at += 1;
        for side in slots.get(slot).neighbors {
            mark(side / 4, open);
        }
    }
}
