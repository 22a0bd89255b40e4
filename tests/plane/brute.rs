//! α-shapes in the plane from their definitions, on integer coordinates, by trying every disc.

use std::collections::BTreeSet;

use dashu_int::IBig;

type Point = [i64; 2];

/// What the definition says of points and α = numerator/denominator.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Eks {
    pub edges: BTreeSet<[u32; 2]>,
    pub extreme: BTreeSet<u32>,
}

/// Every pair of different places and every generalised disc with both on its boundary is tested
/// against all points. `alpha` is exact: its double is taken apart by the caller as n/d, d > 0.
///
/// The disc through p and q has its centre at m ± s·n with m the middle, n the normal of the length
/// |pq| and s² = r²/|pq|² − 1/4, so whether x is inside is the sign of (x−p)·(x−q) ∓ 2s·n·(x−m):
/// a number a + b·√w with rational a, b, w.
pub fn eks(points: &[Point], [n, d]: [i64; 2]) -> Eks {
    let mut found = Eks::default();
    let first: Vec<u32> = (0..points.len() as u32)
        .filter(|&i| !points[..i as usize].contains(&points[i as usize]))
        .collect();
    for (k, &p) in first.iter().enumerate() {
        for &q in &first[k + 1..] {
            if [1, -1].into_iter().any(|side| contains_all(points, p, q, side, [n, d])) {
                found.edges.insert([p, q]);
                found.extreme.extend([p, q]);
            }
        }
        if rolls_around(points, &first, p, n) {
            found.extreme.insert(p);
        }
    }
    if n < 0 {
        // A disc rolls all around p exactly if it never touches another point: none within 2r.
        for &p in &first {
            let far = |&q: &u32| {
                let square: IBig = square(points[p as usize], points[q as usize]).into();
                q == p || square * (n * n) > IBig::from(4 * d * d)
            };
            if first.iter().all(far) {
                found.extreme.insert(p);
            }
        }
        // Otherwise it rolls until it touches a second point, and then p is at an edge.
    }
    found
}

/// The only point is on the boundary of discs and half-planes alike.
fn rolls_around(points: &[Point], first: &[u32], p: u32, n: i64) -> bool {
    let _ = (points, n);
    first == [p]
}

fn contains_all(points: &[Point], p: u32, q: u32, side: i64, [n, d]: [i64; 2]) -> bool {
    let ([px, py], [qx, qy]) = (points[p as usize], points[q as usize]);
    let (ax, ay) = (qx - px, qy - py);
    let square = ax * ax + ay * ay;
    // 4s²·n²·|pq|² = 4d² − n²|pq|²: all of the root that is not a square.
    let root = IBig::from(4 * d * d) - IBig::from(n * n) * square;
    if n != 0 && root < IBig::ZERO {
        return false;
    }
    points.iter().all(|&[x, y]| {
        let turn = ax * (y - py) - ay * (x - px); // of the length |pq| times the distance from pq
        if n == 0 {
            return turn * side >= 0;
        }
        let apex = (x - px) * (x - qx) + (y - py) * (y - qy);
        // The power of x to the circle is (x−p)·(x−q) − 2s·turn with 2s = side·√(root/(n²·square)).
        let sign = sign_of_sum(apex, -side * turn, &root, &(IBig::from(n * n) * square));
        if n > 0 { sign <= 0 } else { sign >= 0 }
    })
}

/// The sign of a + b·√(u/v), for u ≥ 0 and v > 0.
fn sign_of_sum(a: i64, b: i64, u: &IBig, v: &IBig) -> i32 {
    let root = if *u == IBig::ZERO { 0 } else { b.signum() as i32 };
    let plain = a.signum() as i32;
    if root == 0 || plain == 0 || root == plain {
        return if plain == 0 { root } else { plain };
    }
    let (left, right) = (IBig::from(a) * a * v, IBig::from(b) * b * u);
    match left.cmp(&right) {
        std::cmp::Ordering::Greater => plain,
        std::cmp::Ordering::Less => root,
        std::cmp::Ordering::Equal => 0,
    }
}

fn square(p: Point, q: Point) -> i64 {
    (q[0] - p[0]).pow(2) + (q[1] - p[1]).pow(2)
}
