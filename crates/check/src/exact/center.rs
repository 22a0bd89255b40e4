use super::formulas::{center3, center4};
use super::frame::{WeightedPoint, approx, dot};
use super::number::{Approx, Number};

/// The smallest orthogonal sphere of a simplex in doubles, with a bound on the error, for a quick decision that a point is
/// outside.
pub(crate) struct RoundedSphere {
    /// An approximation of the centre.
    pub center: [f64; 3],
    /// The largest possible distance from the true centre.
    pub error: f64,
    /// A vertex of the simplex.
    vertex: WeightedPoint,
    /// Its distance from `center`, and the square.
    distance: f64,
    near: f64,
    /// A point q is certainly outside if its power is above slope · (far + near) + base + [`ROUNDED`] · |`ω_q`|, where far is its
    /// squared distance from `center`.
    slope: f64,
    base: f64,
}

/// Bounds the rounding error of a power, relative to the sum of the magnitudes of its terms.
const ROUNDED: f64 = 4e-15;

impl RoundedSphere {
    /// The sphere of 1 to 4 affinely independent points; `None` if doubles cannot decide.
    ///
    /// # Panics
    /// If there are no points or more than 4.
    pub(crate) fn new<const N: usize>(simplex: [&WeightedPoint; N]) -> Option<Self> {
        let (center, error) = rounded_center(simplex)?;
        let vertex = *simplex[0];
        let near = squared_distance(vertex.position, center);
        let [x, y, z] = [0, 1, 2].map(|k| vertex.position[k] - center[k]);
        // The square may be too small or too large for a double.
        let distance = if near.is_normal() { near.sqrt() } else { x.hypot(y).hypot(z) };
        // For any k > 0, √S ≤ S / (2 k) + k / 2. With S = 2 (far + near) this is (far + near) / k + k / 2. It is an equality for
        // k = √S, as here if far = near.
        let k = (2.0 * near.sqrt()).max(error.sqrt());
        let slope = 2.0 * error / k * (1.0 + 1e-12) + ROUNDED;
        let base = error * k * (1.0 + 1e-12) + ROUNDED * vertex.weight.abs() + f64::MIN_POSITIVE;
        Some(Self { center, error, vertex, distance, near, slope, base })
    }

    /// A distance from `center` that includes all points inside and on the sphere whose weight is at most `heaviest`.
    ///
    /// With c the true centre and v the vertex, such a point q has |q − c|² ≤ |v − c|² − `ω_v` + `ω_q`.
    pub(crate) fn reach(&self, heaviest: f64) -> f64 {
        let lighter = (heaviest - self.vertex.weight).next_up().max(0.0);
        let near = self.distance + self.error;
        let squared = near * near + lighter;
        let root = if squared.is_normal() { squared.sqrt() } else { near.hypot(lighter.sqrt()) };
        // The factor covers roundings.
        root * (1.0 + 1e-12) + self.error
    }

    /// Whether `q` is certainly strictly outside.
    ///
    /// With v the vertex, f(c) = |q − c|² − `ω_q` − |v − c|² + `ω_v` is q's power with respect to the
    /// sphere about c. It is linear in c, so moving the centre by e changes it by at most
    /// 2 |q − v| e, and computing it here rounds by at most 8 · 2⁻⁵³ of what is added up. |q − v| is at most √far + √near ≤
    /// √(2 (far + near)), which [`new`](Self::new) replaces by a linear bound.
    #[inline]
    pub(crate) fn surely_outside(&self, q: &WeightedPoint) -> bool {
        let far = squared_distance(q.position, self.center);
        let power = (far - q.weight) - (self.near - self.vertex.weight);
        power > self.slope * (far + self.near) + ROUNDED * q.weight.abs() + self.base
    }
}

#[inline]
fn squared_distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2) + (p[2] - q[2]).powi(2)
}

/// The centre of the smallest orthogonal sphere, rounded, and a bound on the error.
fn rounded_center<const N: usize>(simplex: [&WeightedPoint; N]) -> Option<([f64; 3], f64)> {
    let zero = Approx::exact(0.0);
    let (twice_det_c, det) = match simplex[..] {
        [_] => ([zero; 3], Approx::exact(1.0)),
        [a, b] => {
            let frame = approx(a, [b], 0.0);
            let ([b], [h]) = (&frame.offsets, &frame.heights);
            (b.map(|x| x.times(h)), dot(b, b))
        }
        [a, b, c] => {
            let frame = approx(a, [b, c], 0.0);
            center3(frame.offsets.each_ref(), frame.heights.each_ref())
        }
        [a, b, c, d] => {
            let frame = approx(a, [b, c, d], 0.0);
            center4(frame.offsets.each_ref(), frame.heights.each_ref())
        }
        _ => panic!("a simplex has 1 to 4 vertices, not {N}"),
    };
    let (det, det_error) = det.value_and_error();
    if det.abs() <= det_error {
        return None;
    }
    let mut center = simplex[0].position;
    let mut error = 0.0;
    for (x, twice) in center.iter_mut().zip(twice_det_c) {
        let (value, value_error) = twice.value_and_error();
        let offset = value / (2.0 * det);
        *x += offset;
        // |n/d − ñ/d̃| ≤ (e_n + |ñ/d̃| e_d) / (|d̃| − e_d); the last terms are the roundings here.
        let numerator = value_error + 2.0 * offset.abs() * det_error;
        let quotient = numerator / (2.0 * (det.abs() - det_error));
        error += quotient + (offset.abs() + x.abs()) * f64::EPSILON;
    }
    // The factor covers the roundings of the bound itself.
    let error = error * (1.0 + 1e-12) + f64::MIN_POSITIVE;
    error.is_finite().then_some((center, error))
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;
    use crate::exact::orientation;

    /// Integers from −`most` to `most`, each draw another three.
    fn draws(seed: u64) -> impl FnMut(i64) -> [i64; 3] {
        let mut random = Random::new(seed);
        move |most| [0; 3].map(|_| random.whole(-most, most) as i64)
    }

    fn plus(p: [i64; 3], q: [i64; 3], times: i64) -> [i64; 3] {
        std::array::from_fn(|k| p[k] + times * q[k])
    }

    /// The point `d` from `center` with the power `power` with respect to the sphere about it of
    /// squared radius `radius`: all of it integers, so nothing is rounded.
    fn site(center: [i64; 3], d: [i64; 3], radius: i64, power: i64) -> WeightedPoint {
        let length: i64 = d.iter().map(|x| x * x).sum();
        let position = plus(center, d, 1).map(|x| x as f64);
        WeightedPoint { position, weight: (length - radius - power) as f64 }
    }

    /// A simplex whose smallest orthogonal sphere has a known centre, its rounded sphere, and
    /// points on the true one, inside, and outside.
    fn judge<const N: usize>(
        center: [i64; 3],
        offsets: [[i64; 3]; N],
        radius: i64,
        draw: &mut impl FnMut(i64) -> [i64; 3],
    ) {
        let simplex = offsets.map(|d| site(center, d, radius, 0));
        let sphere = RoundedSphere::new(simplex.each_ref()).expect("independent");
        let off = |k: usize| (sphere.center[k] - center[k] as f64).abs();
        assert!(off(0).max(off(1)).max(off(2)) <= sphere.error, "{center:?} {simplex:?}");
        assert!(sphere.error < 1e-5, "{} at {center:?} {simplex:?}", sphere.error);
        for _ in 0..8 {
            let d = draw(60);
            let is_outside = |power| sphere.surely_outside(&site(center, d, radius, power));
            assert!(!is_outside(-1) && !is_outside(0), "{center:?} {d:?} {simplex:?}");
            let on = site(center, d, radius, 0);
            let heaviest = simplex.iter().fold(on.weight, |most, corner| most.max(corner.weight));
            let apart = squared_distance(on.position, sphere.center).sqrt();
            let reach = sphere.reach(heaviest);
            assert!(apart <= reach, "{apart} {reach} at {center:?} {d:?} {simplex:?}");
            let true_reach = (radius as f64 + heaviest).sqrt();
            assert!(reach < true_reach + 1e-4, "{reach} {true_reach} {center:?} {simplex:?}");
            assert!(is_outside(1), "{center:?} {d:?} {simplex:?}");
        }
        assert!(simplex.iter().all(|corner| !sphere.surely_outside(corner)));
    }

    #[test]
    fn points_surely_outside_are_outside_and_centers_are_within_their_error() {
        let mut draw = draws(5);
        let mut judged = 0;
        for far in [0, 1000, 1_000_000] {
            for _ in 0..500 {
                let center = draw(far);
                let [radius, times, _] = draw(100).map(|x| x.abs() + 1);
                let [u, v, w, x] = [0; 4].map(|_| draw(40));
                judge(center, [[0; 3]], radius, &mut draw);
                let [p, q, r, s] = [u, v, w, x].map(|d| d.map(|x| x as f64));
                if orientation([0.0; 3], p, q, r).is_eq() || orientation(p, q, r, s).is_eq() {
                    continue;
                }
                judged += 1;
                // The line and plane of the points contain the centre.
                judge(center, [u, plus(u, u, times)], radius, &mut draw);
                judge(center, [u, v, plus(u, v, times)], radius, &mut draw);
                judge(center, [u, v, w, x], radius, &mut draw);
            }
        }
        assert!(judged > 1000, "{judged}");
    }

    /// Centres that a double cannot hold are rounded, and so are powers of points far away.
    #[test]
    fn points_on_a_sphere_with_a_rounded_center_are_not_outside() {
        let mut draw = draws(6);
        let mut judged = 0;
        for _ in 0..4000 {
            // The centre is a third of this. With positions that are multiples of three, powers are integers:
            // |3d − c/3|² is 9|d|² − 2 d·c, up to a number that is the same for all.
            let center = draw(10_000_000);
            let base = center.map(|x| x / 9);
            let site = |d: [i64; 3], power: i64| {
                let d = plus(base, d, 1);
                let dot = |u: [i64; 3], v: [i64; 3]| (0..3).map(|k| u[k] * v[k]).sum::<i64>();
                let weight = 9 * dot(d, d) - 2 * dot(d, center) - power;
                let lift = 9 * dot(base, base) - 2 * dot(base, center);
                WeightedPoint {
                    position: d.map(|x| 3.0 * x as f64),
                    weight: (weight - lift) as f64,
                }
            };
            let corners = [0; 4].map(|_| draw(9)).map(|d| site(d, 0));
            let [a, b, c, d] = corners.map(|corner| corner.position);
            if orientation(a, b, c, d).is_eq() {
                continue;
            }
            let Some(sphere) = RoundedSphere::new(corners.each_ref()) else { continue };
            for times in [1, 30, 1000] {
                let d = draw(9).map(|x| times * x);
                let is_outside = |power: i64| sphere.surely_outside(&site(d, power));
                assert!(!is_outside(0) && !is_outside(-1), "{center:?} {corners:?} {d:?}");
                judged += usize::from(is_outside(1 << 30));
            }
        }
        assert!(judged > 9000, "{judged}");
    }
}
