//! Arithmetic, held to integers of any length: numbers are in units of 2⁻¹²⁰⁰.

use dashu_int::IBig;
use walpha_base::random::Random;
use walpha_regular::internals::number::integer;

use super::*;

const UNIT: i32 = -1200;

fn one() -> IBig {
    IBig::from(1) << 1200usize
}

fn times(a: &IBig, b: &IBig) -> IBig {
    (a * b) >> 1200usize
}

fn over(a: &IBig, b: &IBig) -> IBig {
    (a << 1200usize) / b
}

fn size(a: &IBig) -> IBig {
    if *a < IBig::ZERO { -a } else { a.clone() }
}

/// The square root by Newton's iteration from above.
fn root(a: &IBig) -> IBig {
    let square = a << 1200usize;
    let mut root: IBig = IBig::from(1) << 1240usize;
    loop {
        let next: IBig = (&root + &square / &root) >> 1usize;
        if next >= root {
            return root;
        }
        root = next;
    }
}

/// The arctangent of a number from 0 to 1: Σ 2²ⁿ (n!)² t²ⁿ⁺¹ / ((2n+1)! (1+t²)ⁿ⁺¹).
fn arctangent(t: &IBig) -> IBig {
    let below = one() + times(t, t);
    let ratio = over(&times(t, t), &below);
    let mut term = over(t, &below);
    let mut sum = IBig::ZERO;
    let mut n = 0u32;
    while term != IBig::ZERO {
        sum += &term;
        n += 1;
        term = times(&term, &ratio) * (2 * n) / (2 * n + 1);
    }
    sum
}

fn pi() -> IBig {
    arctangent(&one()) << 2usize
}

/// The angle of a direction with y ≥ 0.
fn angle(y: &IBig, x: &IBig) -> IBig {
    let width = size(x);
    let steep = *y > width;
    let part = if steep { over(&width, y) } else { over(y, &width) };
    let angle = arctangent(&part);
    let angle = if steep { (pi() >> 1usize) - angle } else { angle };
    if *x < IBig::ZERO { pi() - angle } else { angle }
}

/// What numbers have in common for the tests.
trait Checked: Real + std::fmt::Debug {
    /// The value and the error; `None` where nothing is known.
    fn parts(self) -> Option<(IBig, IBig)>;
    /// Numbers with this error, or a hundred times less.
    fn rough(x: f64, error: f64) -> Self;
}

impl Checked for Single {
    fn parts(self) -> Option<(IBig, IBig)> {
        let Bounded { value, bound } = self.bounded();
        bound.is_finite().then(|| (integer(value, UNIT), integer(bound, UNIT)))
    }

    fn rough(x: f64, error: f64) -> Self {
        Self { value: x, error }
    }
}

impl Checked for Double {
    fn parts(self) -> Option<(IBig, IBig)> {
        let Twofold { high, low } = self.value;
        let error = self.error * (1.0 + 1e-6);
        let value = || integer(high, UNIT) + integer(low, UNIT);
        error.is_finite().then(|| (value(), integer(error, UNIT)))
    }

    fn rough(x: f64, error: f64) -> Self {
        Self { value: Twofold { high: x, low: 0.0 }, error }
    }
}

#[track_caller]
fn assert_bound<N: Checked>(found: N, wanted: &IBig) {
    let Some((value, error)) = found.parts() else { return };
    let off = size(&(&value - wanted));
    // Two units for the integers.
    assert!(off <= error + 2, "{found:?}");
}

/// Whatever the numbers are within their errors, the results are within theirs.
fn operations<N: Checked>(widest: f64) {
    let mut random = Random::new(3);
    for round in 0..3000 {
        // Some numbers are exact, some rough, and some are larger than the others.
        let error = [0.0, widest * 1e-3, widest][round % 3];
        let mut number = || {
            let x = (random.unit() - 0.5) * 2f64.powi(random.below(20) as i32 - 10);
            let off = (random.unit() - 0.5) * 2.0 * error * x.abs();
            // The true number is the double nearest to x + off, and the number is known as x.
            let truth = x + off;
            let gap = (truth - x).abs();
            (N::rough(x, gap), integer(truth, UNIT))
        };
        let ((a, x), (b, y), (c, z)) = (number(), number(), number());
        assert_bound(a + b, &(&x + &y));
        assert_bound(a - b, &(&x - &y));
        assert_bound(a * b, &times(&x, &y));
        assert_bound(a / b, &over(&x, &y));
        assert_bound(a * b - c, &(times(&x, &y) - &z));
        assert_bound(
            (a * b - c) / (a + c * c),
            &over(&(times(&x, &y) - &z), &(&x + times(&z, &z))),
        );
        assert_bound(a.half(), &(&x >> 1usize));
        assert_bound((a * a).sqrt(), &size(&x));
        assert_bound((a * a + b * b).sqrt(), &root(&(times(&x, &x) + times(&y, &y))));
        if round % 10 == 0 {
            assert_bound(N::angle(b * b, c), &angle(&times(&y, &y), &z));
            let y = size(&y);
            let b = if b.rounded().value < 0.0 { -b } else { b };
            assert_bound(N::angle(b, a), &angle(&y, &x));
        }
    }
}

#[test]
fn results_in_doubles_are_within_their_bounds() {
    operations::<Single>(1e-9);
    operations::<Single>(0.3);
}

#[test]
fn results_in_two_doubles_are_within_their_bounds() {
    operations::<Double>(1e-20);
    operations::<Double>(0.3);
}

#[test]
fn vectors_are_within_their_bounds() {
    fn check<N: Checked>() {
        let mut random = Random::new(4);
        for _ in 0..1000 {
            let mut place = || [0; 3].map(|_| (random.unit() - 0.5) * 4.0);
            let places = [place(), place(), place(), place()];
            let exact = |to: usize| {
                [0, 1, 2].map(|k| integer(places[to][k], UNIT) - integer(places[0][k], UNIT))
            };
            let dot = |a: &[IBig; 3], b: &[IBig; 3]| {
                times(&a[0], &b[0]) + times(&a[1], &b[1]) + times(&a[2], &b[2])
            };
            let [a, b, c] = [1, 2, 3].map(|to| N::ray(places[0], places[to]));
            let [x, y, z] = [exact(1), exact(2), exact(3)];
            let normal = [0, 1, 2].map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                times(&x[i], &y[j]) - times(&x[j], &y[i])
            });
            assert_bound(N::dot(a, b), &dot(&x, &y));
            assert_bound(N::squared(a), &dot(&x, &x));
            assert_bound(N::along(a[1]), &x[1]);
            let found = N::cross(a, b);
            (0..3).for_each(|k| assert_bound(found[k], &normal[k]));
            assert_bound(N::triple(found, c), &dot(&normal, &z));
            assert_bound(N::squared_normal(found), &dot(&normal, &normal));
        }
    }
    check::<Single>();
    check::<Double>();
}

/// Angles that are nearly 0, π/2 and π, and those of the table.
#[test]
fn angles_are_within_their_bounds() {
    fn check<N: Checked>(part: f64) {
        for k in 0..=130 {
            for (y, x) in [(f64::from(k) / 130.0, 1.0), (1.0, f64::from(k) / 130.0)] {
                for sign in [1.0, -1.0] {
                    let (big_y, big_x) = (integer(y, UNIT), integer(sign * x, UNIT));
                    let found = N::angle(N::exact(y), N::exact(sign * x));
                    let wanted = angle(&big_y, &big_x);
                    assert_bound(found, &wanted);
                    let (_, error) = found.parts().unwrap();
                    assert!(error <= integer(part, UNIT), "{y} {x} {found:?}");
                }
            }
        }
        for tiny in [1e-8, 1e-15, 1e-17, 1e-40] {
            for (y, x) in [(tiny, 1.0), (1.0, tiny), (1.0, -tiny), (tiny, -1.0), (1.0, 1.0 + tiny)]
            {
                let wanted = angle(&integer(y, UNIT), &integer(x, UNIT));
                assert_bound(N::angle(N::exact(y), N::exact(x)), &wanted);
            }
        }
    }
    check::<Single>(1e-14);
    check::<Double>(1e-14);
}

#[test]
fn what_is_unknown_has_a_bound_all_the_same() {
    let pi = std::f64::consts::PI;
    let point = Single { value: 1e-20, error: 1e-10 };
    let unknown = Single::angle(point, -point).bounded();
    assert!(unknown.contains(0.0) && unknown.contains(pi));
    let below = Single { value: -1e-20, error: 1e-10 }.sqrt().bounded();
    assert!(below.contains(0.0) && below.contains(9.99e-6));
    let divided = Single::exact(1.0) / point;
    assert_eq!(divided.bounded().bound, f64::INFINITY);
    let nothing = Single { value: f64::NAN, error: 0.0 };
    assert_eq!(nothing.bounded().bound, f64::INFINITY);
    let past = Single::exact(1e200) * Single::exact(1e200);
    assert_eq!(past.bounded().bound, f64::INFINITY);
    assert_eq!((past - past).bounded().bound, f64::INFINITY);
    let lost = (Single::exact(1e-200) * Single::exact(1e-200)).bounded();
    assert!(lost.value == 0.0 && lost.bound > 0.0);
}
