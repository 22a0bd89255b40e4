//! The polynomials whose signs are the predicates, written once for doubles and for integers.
//!
//! Orientation and power test are determinants of rays, from one of the points to the others.
//!
//! Seen from a simplex's first vertex p, with rays a = q − p and powers t = |a|² + ω(p) − ω(q) of
//! the others, the centre is p + c where 2c·a = t for each ray and c lies in the span of the rays;
//! the squared radius is |c|² − ω(p). A point p + e with the power s lies inside if s < 2c·e.

use crate::number::{Number, Scale, cross, dot};

/// The way from the first vertex p to another vertex q: `vector` is q − p and `power` is |q − p|² + ω(p) − ω(q). The types differ
/// if a lattice makes vectors exact in doubles, and only powers need more digits.
#[derive(Clone, Copy)]
pub(super) struct Ray<T, V = T> {
    pub vector: [V; 3],
    pub power: T,
}

/// The determinant of three vectors: positive if they are oriented like the axes x, y, z.
#[inline(always)]
pub(super) fn determinant<T: Number>([a, b, c]: [&[T; 3]; 3]) -> T {
    dot(a, &cross(b, c))
}

/// The determinant of four rays as rows (x, y, z, power), by 2×2 minors. For the rays from a point t
/// to the corners of a positively oriented cell it is negative if t lies strictly inside the cell's
/// orthogonal sphere. Powers may be replaced by differences of lifted heights |p|² − ω: this only adds
/// multiples of the other columns.
#[inline(always)]
pub(super) fn power_determinant<T: Number>([a, b, c, d]: &[Ray<T>; 4]) -> T {
    // Laplace expansion: minors of two rows times the complementary minors of the others.
    let terms = [
        products(minors(a, b), minors(c, d)),
        products(minors(a, c), minors(b, d)),
        products(minors(a, d), minors(b, c)),
    ];
    let [x, y] = [0, 1].map(|i| terms[0][i].minus(&terms[1][i]).plus(&terms[2][i]));
    x.plus(&y)
}

/// The minors of two rays in the columns (x, y) and (z, power), computed in pairs so that one vector instruction of
/// two lanes does both: (x, z) times (y, power).
#[inline(always)]
fn minors<T: Number>(p: &Ray<T>, q: &Ray<T>) -> [T; 2] {
    let (low_p, high_p) = ([&p.vector[0], &p.vector[2]], [&p.vector[1], &p.power]);
    let (low_q, high_q) = ([&q.vector[0], &q.vector[2]], [&q.vector[1], &q.power]);
    [0, 1].map(|i| low_p[i].times(high_q[i]).minus(&low_q[i].times(high_p[i])))
}

/// The products of the minors of two rays with the complementary minors of two others.
#[inline(always)]
fn products<T: Number>([u, v]: [T; 2], [x, y]: [T; 2]) -> [T; 2] {
    [u.times(&y), v.times(&x)]
}

/// 4 d·|c|² and d, where d ≥ 0 depends on the vectors alone and has degree 2 for one ray, 4 for two, 6 for
/// three.
#[inline(always)]
pub(super) fn quotient<T: Scale<V>, V: Number>(rays: &[Ray<T, V>]) -> (T, V) {
    match rays {
        [a] => (a.power.times(&a.power), dot(&a.vector, &a.vector)),
        [a, b] => {
            let ([u, v], d) = gram(a, b);
            (u.times(&a.power).plus(&v.times(&b.power)), d)
        }
        [a, b, c] => {
            let Centre { twice, det, .. } = centre([a, b, c]);
            (dot(&twice, &twice), det.times(&det))
        }
        _ => unreachable!("a simplex has one to three rays"),
    }
}

/// The centre p + c of the orthogonal sphere of a cell.
pub(super) struct Centre<T, V> {
    /// 2 det·c.
    pub twice: [T; 3],
    /// The determinant of the three rays.
    pub det: V,
    /// For the facets at p, each opposite one of the other corners: the products of their two rays.
    pub normals: [[V; 3]; 3],
}

/// The centre of a cell, by Cramer's rule.
#[inline(always)]
pub(super) fn centre<T: Scale<V>, V: Number>(rays: [&Ray<T, V>; 3]) -> Centre<T, V> {
    let [a, b, c] = rays.map(|ray| &ray.vector);
    let normals = [cross(b, c), cross(c, a), cross(a, b)];
    let component = |k: usize| {
        let [x, y, z] = [0, 1, 2].map(|i| rays[i].power.scaled(&normals[i][k]));
        x.plus(&y).plus(&z)
    };
    let twice = [component(0), component(1), component(2)];
    Centre { twice, det: dot(a, &normals[0]), normals }
}

/// A positive multiple of s − 2c·e for the point at `e` of power s: negative inside the smallest orthogonal sphere
/// of an edge or a facet.
#[inline(always)]
pub(super) fn side<T: Number>(rays: &[Ray<T>], e: &Ray<T>) -> T {
    match rays {
        [a] => {
            let along = a.power.times(&dot(&e.vector, &a.vector));
            e.power.times(&dot(&a.vector, &a.vector)).minus(&along)
        }
        [a, b] => {
            let ([u, v], d) = gram(a, b);
            let along = u.times(&dot(&e.vector, &a.vector));
            let along = along.plus(&v.times(&dot(&e.vector, &b.vector)));
            e.power.times(&d).minus(&along)
        }
        _ => unreachable!("only edges and facets have sides"),
    }
}

/// What the squared radius of a simplex and the barycentric coordinates of its centre p + c have in common, in doubles.
#[derive(Clone, Copy)]
pub(super) struct Solution {
    /// The barycentric coordinates of all vertices but p, times 2d with the denominator d of [`quotient`].
    pub others: [f64; 3],
    /// |a|² for one ray a, the Gram determinant for two, the determinant for three.
    pub det: f64,
    /// For three rays, 2 det·c.
    pub twice: [f64; 3],
}

impl Solution {
    #[inline(always)]
    pub(super) fn of(rays: &[Ray<f64>]) -> Self {
        match rays {
            [] => Self { others: [0.0; 3], det: 0.0, twice: [0.0; 3] },
            [a] => {
                let det = dot(&a.vector, &a.vector);
                Self { others: [a.power, 0.0, 0.0], det, twice: [0.0; 3] }
            }
            [a, b] => {
                let ([u, v], det) = gram(a, b);
                Self { others: [u, v, 0.0], det, twice: [0.0; 3] }
            }
            [a, b, c] => {
                let Centre { twice, det, normals } = centre([a, b, c]);
                Self { others: normals.map(|normal| dot(&twice, &normal)), det, twice }
            }
            _ => unreachable!("a simplex has at most three rays"),
        }
    }

    /// [`quotient`], of the same rays.
    #[inline(always)]
    pub(super) fn quotient(&self, rays: &[Ray<f64>]) -> (f64, f64) {
        let [u, v, _] = self.others;
        match rays {
            [a] => (a.power * a.power, self.det),
            [a, b] => (u * a.power + v * b.power, self.det),
            _ => (dot(&self.twice, &self.twice), self.det * self.det),
        }
    }

    /// Positive multiples of the barycentric coordinates of the centre, that of p first.
    #[inline(always)]
    pub(super) fn barycentric<const N: usize>(&self) -> [f64; N] {
        let denominator = if N == 4 { self.det * self.det } else { self.det };
        let [u, v, w] = self.others;
        let all = [2.0 * denominator - (u + v + w), u, v, w];
        let mut to = [0.0; N];
        to.copy_from_slice(&all[..N]);
        to
    }
}

/// The Gram determinant d of two rays, and d times the coefficients of 2c in the basis of the rays.
#[inline(always)]
pub(super) fn gram<T: Scale<V>, V: Number>(a: &Ray<T, V>, b: &Ray<T, V>) -> ([T; 2], V) {
    let aa = dot(&a.vector, &a.vector);
    let bb = dot(&b.vector, &b.vector);
    let ab = dot(&a.vector, &b.vector);
    let u = a.power.scaled(&bb).minus(&b.power.scaled(&ab));
    let v = b.power.scaled(&aa).minus(&a.power.scaled(&ab));
    ([u, v], aa.times(&bb).minus(&ab.times(&ab)))
}
