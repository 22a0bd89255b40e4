//! The formulas: each a polynomial in a [`Frame`], written once for all kinds of number.
//!
//! Write aᵢ for the offsets, hᵢ for the heights and G for the Gram matrix aᵢ·aⱼ. The smallest
//! sphere orthogonal to all points has its centre p₀ + c in their affine hull, where
//! 2 aᵢ·c = hᵢ, so 2c = Σ λᵢ aᵢ with G λ = h, and its squared radius is |c|² − w₀.

use super::frame::{Formula, Frame, cross, dot};
use super::number::Number;

/// det(a₁, a₂, a₃): six times the volume of the tetrahedron.
pub(super) struct Volume;

impl Formula<3> for Volume {
    #[inline(always)]
    fn value<T: Number>(&self, frame: &Frame<T, 3>) -> T {
        let [a, b, c] = &frame.offsets;
        dot(&cross(a, b), c)
    }
}

/// det(a₁, a₂, a₃) · (h₄ − the height over p₄ of the plane through the lifted others): negative
/// when p₄ is inside the orthogonal sphere of positively oriented p₀ … p₃.
pub(super) struct Power4;

impl Formula<4> for Power4 {
    #[inline(always)]
    fn value<T: Number>(&self, frame: &Frame<T, 4>) -> T {
        let [a, b, c, q] = &frame.offsets;
        let [ha, hb, hc, hq] = &frame.heights;
        let (ab, cq) = (cross(a, b), cross(c, q));
        let upper = hq.times(&dot(&ab, c)).minus(&hc.times(&dot(&ab, q)));
        let lower = hb.times(&dot(&cq, a)).minus(&ha.times(&dot(&cq, b)));
        upper.plus(&lower)
    }
}

/// det G · (`h_q` − `2c·a_q`) for a triangle: negative when q is inside.
pub(super) struct Power3;

impl Formula<3> for Power3 {
    #[inline(always)]
    fn value<T: Number>(&self, frame: &Frame<T, 3>) -> T {
        let [a, b, q] = &frame.offsets;
        let [ha, hb, hq] = &frame.heights;
        let gram = Gram::of(a, b);
        let [la, lb] = gram.adjugate_times(ha, hb);
        let center = la.times(&dot(a, q)).plus(&lb.times(&dot(b, q)));
        hq.times(&gram.determinant()).minus(&center)
    }
}

/// |a|² · (`h_q` − `2c·a_q`) for a segment: negative when q is inside.
pub(super) struct Power2;

impl Formula<2> for Power2 {
    #[inline(always)]
    fn value<T: Number>(&self, frame: &Frame<T, 2>) -> T {
        let ([a, q], [ha, hq]) = (&frame.offsets, &frame.heights);
        hq.times(&dot(a, a)).minus(&ha.times(&dot(a, q)))
    }
}

/// `h_q` for a point: negative when q is inside the sphere of squared radius −w₀ about p₀.
pub(super) struct Power1;

impl Formula<1> for Power1 {
    #[inline(always)]
    fn value<T: Number>(&self, frame: &Frame<T, 1>) -> T {
        frame.heights[0].clone()
    }
}

/// 4 det² · (R² − α) for a tetrahedron, det that of its offsets: c = A⁻¹h / 2.
pub(super) struct Radius4;

impl Formula<3> for Radius4 {
    #[inline(always)]
    fn value<T: Number>(&self, frame: &Frame<T, 3>) -> T {
        let ([a, b, c], [ha, hb, hc]) = (&frame.offsets, &frame.heights);
        let (center, det) = center4([a, b, c], [ha, hb, hc]);
        excess(dot(&center, &center), det.times(&det), frame)
    }
}

/// 2 det · c and det for a tetrahedron.
#[inline(always)]
pub(super) fn center4<T: Number>([a, b, c]: [&[T; 3]; 3], [ha, hb, hc]: [&T; 3]) -> ([T; 3], T) {
    let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
    let center =
        std::array::from_fn(|k| ha.times(&bc[k]).plus(&hb.times(&ca[k])).plus(&hc.times(&ab[k])));
    (center, dot(&ab, c))
}

/// 2 det G · c and det G for a triangle.
#[inline(always)]
pub(super) fn center3<T: Number>([a, b]: [&[T; 3]; 2], [ha, hb]: [&T; 2]) -> ([T; 3], T) {
    let gram = Gram::of(a, b);
    let [la, lb] = gram.adjugate_times(ha, hb);
    let center = std::array::from_fn(|k| la.times(&a[k]).plus(&lb.times(&b[k])));
    (center, gram.determinant())
}

/// 4 det G · (R² − α) for a triangle.
pub(super) struct Radius3;

impl Formula<2> for Radius3 {
    #[inline(always)]
    fn value<T: Number>(&self, frame: &Frame<T, 2>) -> T {
        let ([a, b], [ha, hb]) = (&frame.offsets, &frame.heights);
        let gram = Gram::of(a, b);
        let [la, lb] = gram.adjugate_times(ha, hb);
        excess(ha.times(&la).plus(&hb.times(&lb)), gram.determinant(), frame)
    }
}

/// 4 |a|² · (R² − α) for a segment.
pub(super) struct Radius2;

impl Formula<1> for Radius2 {
    #[inline(always)]
    fn value<T: Number>(&self, frame: &Frame<T, 1>) -> T {
        let ([a], [h]) = (&frame.offsets, &frame.heights);
        excess(h.times(h), dot(a, a), frame)
    }
}

/// 4 det · (|c|² − (α + w₀)), given 4 det · |c|² in heights squared per coordinate unit squared.
#[inline(always)]
fn excess<T: Number, const N: usize>(four_det_c2: T, det: T, frame: &Frame<T, N>) -> T {
    let twice = det.plus(&det);
    let four = twice.plus(&twice);
    four_det_c2.minus(&four.times(&frame.level).times(&frame.unit))
}

/// The Gram matrix of two vectors.
struct Gram<T> {
    aa: T,
    ab: T,
    bb: T,
}

impl<T: Number> Gram<T> {
    #[inline(always)]
    fn of(a: &[T; 3], b: &[T; 3]) -> Self {
        Self { aa: dot(a, a), ab: dot(a, b), bb: dot(b, b) }
    }

    #[inline(always)]
    fn determinant(&self) -> T {
        self.aa.times(&self.bb).minus(&self.ab.times(&self.ab))
    }

    #[inline(always)]
    fn adjugate_times(&self, u: &T, v: &T) -> [T; 2] {
        [self.bb.times(u).minus(&self.ab.times(v)), self.aa.times(v).minus(&self.ab.times(u))]
    }
}

/// |a × b|²: zero when three points are collinear. A sum of squares, so it is never negative.
pub(super) struct Area;

impl Formula<2> for Area {
    #[inline(always)]
    fn value<T: Number>(&self, frame: &Frame<T, 2>) -> T {
        let [a, b] = &frame.offsets;
        let normal = cross(a, b);
        dot(&normal, &normal)
    }
}
