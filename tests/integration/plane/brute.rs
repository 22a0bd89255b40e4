//! α-shapes in the plane from their definitions, on integer coordinates, by trying every disc.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use dashu_int::IBig;

pub type Point = [i64; 2];

/// The result of the definition.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Eks {
    pub edges: BTreeSet<[u32; 2]>,
    pub extreme: BTreeSet<u32>,
}

/// Tests both generalised discs of radius 1/α through every pair of places against all points,
/// exactly. Of equal points the first counts.
pub fn eks(points: &[Point], alpha: f64) -> Eks {
    let alpha = Fraction::of(alpha);
    let first: Vec<u32> = (0..points.len() as u32)
        .filter(|&i| !points[..i as usize].contains(&points[i as usize]))
        .collect();
    let mut found = Eks::default();
    for (k, &p) in first.iter().enumerate() {
        for &q in &first[k + 1..] {
            if [1, -1].into_iter().any(|side| contains_all(points, p, q, side, &alpha)) {
                found.edges.insert([p, q]);
                found.extreme.extend([p, q]);
            }
        }
    }
    // A disc that touches p rolls around it until it touches a second point, unless there is none,
    // or for α < 0 none that it reaches.
    for &p in &first {
        let beyond_reach = |&q: &u32| {
            let square = IBig::from(square(points[p as usize], points[q as usize]));
            q == p || alpha.sign == Ordering::Less && square * &alpha.n2 >= 4 * &alpha.d2
        };
        if first.iter().all(beyond_reach) {
            found.extreme.insert(p);
        }
    }
    found
}

/// α as a fraction, squared, with its sign.
struct Fraction {
    sign: Ordering,
    n2: IBig,
    d2: IBig,
}

impl Fraction {
    fn of(mut alpha: f64) -> Self {
        let sign = alpha.total_cmp(&0.0);
        let mut d2 = IBig::ONE;
        while alpha.fract() != 0.0 {
            (alpha, d2) = (alpha * 2.0, d2 * 4);
        }
        let n = IBig::from(alpha as i64);
        Self { sign, n2: &n * &n, d2 }
    }
}

/// Whether the disc through p and q, its centre to the left (side 1) or right (−1) of pq, contains
/// all points.
///
/// With m the middle of pq and N its normal of the same length the centre is m + sN, where
/// 4s² = (4/α² − |pq|²) / |pq|². The power of x to the circle is (x−p)·(x−q) − 2s·N·(x−m): a
/// number of the form a + b√(u/v), whose sign needs no root.
fn contains_all(points: &[Point], p: u32, q: u32, side: i64, alpha: &Fraction) -> bool {
    let ([px, py], [qx, qy]) = (points[p as usize], points[q as usize]);
    let (ax, ay) = (qx - px, qy - py);
    let v = &alpha.n2 * (ax * ax + ay * ay);
    let u = 4 * &alpha.d2 - &v;
    if alpha.sign != Ordering::Equal && u < IBig::ZERO {
        return false;
    }
    points.iter().all(|&[x, y]| {
        let turn = ax * (y - py) - ay * (x - px);
        let apex = (x - px) * (x - qx) + (y - py) * (y - qy);
        match alpha.sign {
            Ordering::Equal => turn * side >= 0,
            Ordering::Greater => sign_of_sum(apex, -side * turn, &u, &v) <= 0,
            Ordering::Less => sign_of_sum(apex, -side * turn, &u, &v) >= 0,
        }
    })
}

/// The sign of a + b√(u/v), for u ≥ 0 and v > 0.
fn sign_of_sum(a: i64, b: i64, u: &IBig, v: &IBig) -> i64 {
    let root = if *u == IBig::ZERO { 0 } else { b.signum() };
    if a.signum() * root >= 0 {
        return if a == 0 { root } else { a.signum() };
    }
    let (left, right) = (IBig::from(a) * a * v, IBig::from(b) * b * u);
    match left.cmp(&right) {
        Ordering::Greater => a.signum(),
        Ordering::Less => root,
        Ordering::Equal => 0,
    }
}

fn square(p: Point, q: Point) -> i64 {
    (q[0] - p[0]).pow(2) + (q[1] - p[1]).pow(2)
}
