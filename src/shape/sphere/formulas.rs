//! The polynomials behind smallest orthogonal spheres, written once for doubles and for integers.
//!
//! Seen from a simplex's first vertex p, with rays a = q − p and powers t = |a|² + ω(p) − ω(q) of
//! the others, the centre is p + c where 2c·a = t for each ray and c lies in the span of the rays;
//! the squared radius is |c|² − ω(p). A point at the ray e is inside if its power < 2c·e.

use dashu_int::IBig;

/// What the polynomials are computed in.
pub(super) trait Number {
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        self * other
    }
}

impl Number for IBig {
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
}

/// From the first vertex to another.
pub(super) struct Ray<T> {
    pub vector: [T; 3],
    pub power: T,
}

/// 4 d·|c|² and d, where d ≥ 0 depends on the rays alone: of degree 2 for one ray, 4 for two, 6
/// for three.
#[inline(always)]
pub(super) fn quotient<T: Number>(rays: &[Ray<T>]) -> (T, T) {
    match rays {
        [a] => (a.power.times(&a.power), dot(&a.vector, &a.vector)),
        [a, b] => {
            let ([u, v], d) = gram(a, b);
            (u.times(&a.power).plus(&v.times(&b.power)), d)
        }
        [a, b, c] => {
            let normals = [cross(b, c), cross(c, a), cross(a, b)];
            let component = |k: usize| {
                let [x, y, z] = [0, 1, 2].map(|i| rays[i].power.times(&normals[i][k]));
                x.plus(&y).plus(&z)
            };
            let twice = [component(0), component(1), component(2)];
            let det = dot(&a.vector, &normals[0]);
            (dot(&twice, &twice), det.times(&det))
        }
        _ => unreachable!("a simplex has one to three rays"),
    }
}

/// A positive multiple of the power of the point at `e` less 2c·e: negative inside the sphere of a
/// vertex, an edge or a facet.
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
        _ => unreachable!("only edges and facets are asked about"),
    }
}

/// The Gram determinant d of two rays, and d times the coordinates of 2c in them.
#[inline(always)]
fn gram<T: Number>(a: &Ray<T>, b: &Ray<T>) -> ([T; 2], T) {
    let aa = dot(&a.vector, &a.vector);
    let bb = dot(&b.vector, &b.vector);
    let ab = dot(&a.vector, &b.vector);
    let u = bb.times(&a.power).minus(&ab.times(&b.power));
    let v = aa.times(&b.power).minus(&ab.times(&a.power));
    ([u, v], aa.times(&bb).minus(&ab.times(&ab)))
}

#[inline(always)]
pub(super) fn dot<T: Number>(u: &[T; 3], v: &[T; 3]) -> T {
    u[0].times(&v[0]).plus(&u[1].times(&v[1])).plus(&u[2].times(&v[2]))
}

#[inline(always)]
fn cross<T: Number>(a: &Ray<T>, b: &Ray<T>) -> [T; 3] {
    let (u, v) = (&a.vector, &b.vector);
    let minor = |i: usize, j: usize| u[i].times(&v[j]).minus(&u[j].times(&v[i]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}
