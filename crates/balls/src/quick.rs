//! Triangles whose two sides are both cells of the complex, in doubles with one bound for all roundings: most triangles of a dense set.
//!
//! Let r² be the largest squared length among the edges of the triangle and the way from its first corner to the apex, plus the largest
//! difference of weights, and u = 2⁻⁵³. Each coordinate of a difference errs by u of itself, an inner product by 6u r² (two differences, a product, two sums),
//! g by 4u r² (it is at most r²/2), and so in turn
//!
//! | number | at most | error |
//! |---|---|---|
//! | c = g D − g′ p, the coordinates | r⁴ | 16u r⁴ |
//! | n, the normal | r² | 5u r² in each coordinate |
//! | N = n·n | r⁴ | 22u r⁴ |
//! | det = n·w | r³ | 14u r³ |
//! | c·(a·w) + c′·(b·w) | 2r⁶ | 48u r⁶ |
//!
//! Quotients are products with reciprocals, which rounds twice. Bounds are used only if N and det are at least four times their errors.

use walpha_base::vector::{cross, dot, sub};

use crate::real::{Single, U};
use crate::simplex::{Ball, Limits};

/// What the two cells at a triangle give.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quick {
    /// For the edge opposite each corner, twice its length times the part of its power facet at the triangle.
    pub kites: [Single; 3],
    /// Six times the volume of each cell.
    pub dets: [Single; 2],
}

impl Quick {
    /// A triangle and the apexes of the cells on both sides; `None` if the bounds are not narrow enough.
    #[inline(always)]
    pub(crate) fn of([i, j, k]: [Ball; 3], apexes: [Ball; 2], limits: Limits) -> Option<Self> {
        /// What bounds leave of a divisor: at least 3/4.
        const LEFT: f64 = 4.0 / 3.0;
        let (a, b, t) = (sub(j.centre, i.centre), sub(k.centre, i.centre), sub(k.centre, j.centre));
        let (aa, bb, tt) = (dot(a, a), dot(b, b), dot(t, t));
        let (ab, at) = (dot(a, b), dot(a, t));
        let (to_j, to_k, across) = (i.weight - j.weight, i.weight - k.weight, j.weight - k.weight);
        let (g_j, g_k) = (0.5 * (aa + to_j), 0.5 * (bb + to_k));
        let coordinates = [
            0.5 * (aa - to_j) * tt + 0.5 * (tt + across) * at,
            g_j * bb - g_k * ab,
            g_k * aa - g_j * ab,
        ];
        let n = cross(a, b);
        let area = dot(n, n);
        let (long, heavy) = (aa.max(bb).max(tt), to_j.abs().max(to_k.abs()).max(across.abs()));
        let reciprocal = 1.0 / area;
        let mut found = Self { kites: [Single::ZERO; 3], dets: [Single::ZERO; 2] };
        for (apex, det) in apexes.into_iter().zip(&mut found.dets) {
            let w = sub(apex.centre, i.centre);
            let ww = dot(w, w);
            let to_apex = i.weight - apex.weight;
            let r2 = long.max(ww) + heavy.max(to_apex.abs());
            let (r3, r4) = (r2 * r2.sqrt(), r2 * r2);
            let (of_area, of_det) = (22.0 * U * r4, 14.0 * U * r3);
            let value = dot(n, w).abs();
            // Where nothing underflows or overflows, and also false for NaN.
            let sane =
                (1e-60..1e60).contains(&r2) && area >= 4.0 * of_area && value >= 4.0 * of_det;
            if !sane {
                return None;
            }
            let in_plane = (coordinates[1] * dot(a, w) + coordinates[2] * dot(b, w)) * reciprocal;
            let rise = 0.5 * (ww + to_apex) - in_plane;
            let over = 1.0 / value;
            let height = rise * over;
            let of_plane = (48.0 * U * r2 * r4 + in_plane.abs() * of_area) * reciprocal * LEFT
                + 2.0 * U * in_plane.abs();
            let of_rise = 4.0 * U * r2 + of_plane + U * rise.abs();
            let of_height =
                (of_rise + height.abs() * of_det) * over * LEFT + 2.0 * U * height.abs();
            for (kite, coordinate) in found.kites.iter_mut().zip(coordinates) {
                let value = coordinate * height;
                let error = coordinate.abs() * of_height
                    + 16.0 * U * r4 * (height.abs() + of_height)
                    + U * value.abs();
                *kite += Single { value, error };
            }
            *det = Single { value, error: of_det };
        }
        let narrow = found.kites.iter().chain(&found.dets).all(|&number| limits.cube(number));
        narrow.then_some(found)
    }
}
