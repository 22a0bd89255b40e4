//! Exact geometry in the plane: every number is an integer multiple of one power of two.

use std::cmp::Ordering;

use dashu_int::{IBig, ops::BitTest};

use walpha_regular::internals::number::{integer, lowest_bit};

/// Points, and weights if there are any, as integers: a coordinate is its integer times 2^exponent
/// and a weight its integer times 4^exponent. Nothing is rounded.
pub(super) struct Exact {
    positions: Vec<[IBig; 2]>,
    weights: Vec<IBig>,
    /// α of [`Exact::weighted`] in the unit of weights.
    alpha: IBig,
    exponent: i32,
}

/// The square of a length as a fraction; the denominator is positive.
pub(super) struct Square {
    numerator: IBig,
    denominator: IBig,
}

/// The squared radius 1/α² that squares are compared with, α being of the unit 1/length.
pub(super) struct Curve {
    square: IBig,
    /// A square n/d is compared through n·square·2^shift against d.
    shift: i64,
}

impl Exact {
    pub(super) fn new(positions: &[[f64; 2]]) -> Self {
        let exponent = positions.as_flattened().iter().filter_map(|&v| lowest_bit(v)).min();
        Self::scaled(positions, &[], 0.0, exponent.unwrap_or(0))
    }

    /// Creates the units for power weights, and α in the same unit.
    pub(super) fn weighted(positions: &[[f64; 2]], weights: &[f64], alpha: f64) -> Self {
        let lengths = positions.as_flattened().iter().filter_map(|&v| lowest_bit(v));
        let squares = weights.iter().chain([&alpha]).filter_map(|&v| lowest_bit(v));
        let exponent = lengths.chain(squares.map(|e| e.div_euclid(2))).min();
        Self::scaled(positions, weights, alpha, exponent.unwrap_or(0))
    }

    fn scaled(positions: &[[f64; 2]], weights: &[f64], alpha: f64, exponent: i32) -> Self {
        Self {
            positions: positions.iter().map(|p| p.map(|v| integer(v, exponent))).collect(),
            weights: weights.iter().map(|&w| integer(w, 2 * exponent)).collect(),
            alpha: integer(alpha, 2 * exponent),
            exponent,
        }
    }

    /// The curve of radius 1/|α|, for α ≠ 0.
    pub(super) fn curve(&self, alpha: f64) -> Curve {
        let e = lowest_bit(alpha).expect("α is not 0");
        let mantissa = integer(alpha, e);
        Curve { square: &mantissa * &mantissa, shift: i64::from(2 * (e + self.exponent)) }
    }

    fn ray(&self, p: u32, q: u32) -> [IBig; 2] {
        let ([px, py], [qx, qy]) = (&self.positions[p as usize], &self.positions[q as usize]);
        [qx - px, qy - py]
    }

    /// Positive where p, q, r turn counter-clockwise.
    fn turn(&self, p: u32, q: u32, r: u32) -> IBig {
        cross(&self.ray(p, q), &self.ray(p, r))
    }

    /// Whether three points lie on one line.
    pub(super) fn collinear(&self, p: u32, q: u32, r: u32) -> bool {
        self.turn(p, q, r) == IBig::ZERO
    }

    /// The order of the angle at `apex` over p and q against the right angle. `Less` (obtuse) also
    /// says that the apex lies strictly inside the disc over the diameter pq, `Equal` on it.
    pub(super) fn apex(&self, p: u32, q: u32, apex: u32) -> Ordering {
        dot(&self.ray(apex, p), &self.ray(apex, q)).cmp(&IBig::ZERO)
    }

    fn squared_distance(&self, p: u32, q: u32) -> IBig {
        let a = self.ray(p, q);
        dot(&a, &a)
    }

    /// The squared half distance of two points.
    pub(super) fn half_distance(&self, p: u32, q: u32) -> Square {
        Square { numerator: self.squared_distance(p, q), denominator: 4.into() }
    }

    /// The squared radius of the circle through three points that are not on one line: with the
    /// sides a, b, c and twice the area t it is a²b²c² / 4t².
    pub(super) fn circumradius(&self, [p, q, r]: [u32; 3]) -> Square {
        let t = self.turn(p, q, r);
        let [a, b, c] = [(p, q), (q, r), (r, p)].map(|(p, q)| self.squared_distance(p, q));
        Square { numerator: a * b * c, denominator: 4 * (&t * &t) }
    }

    /// The length with this square, rounded only in its last digits.
    pub(super) fn length(&self, Square { numerator, denominator }: &Square) -> f64 {
        if *numerator == IBig::ZERO {
            return 0.0;
        }
        // An even shift that leaves the quotient more bits than a double has.
        let excess = denominator.bit_len() as i64 - numerator.bit_len() as i64;
        let shift = (excess + 128).div_euclid(2) * 2;
        let quotient = if shift >= 0 {
            (numerator << shift as usize) / denominator
        } else {
            numerator / (denominator << shift.unsigned_abs() as usize)
        };
        let exponent = (i64::from(self.exponent) - shift / 2) as i32;
        // Two steps are used, so that the factor itself is a double for any length.
        let half = exponent / 2;
        quotient.to_f64().value().sqrt() * 2f64.powi(half) * 2f64.powi(exponent - half)
    }

    /// |q−p|² + ωₚ − `ω_q`: the power of q to the disc around p of squared radius −ωₚ.
    fn power(&self, a: &[IBig; 2], p: u32, q: u32) -> IBig {
        dot(a, a) + &self.weights[p as usize] - &self.weights[q as usize]
    }

    /// Whether the smallest circle orthogonal to p, of squared radius −ωₚ, is at most α.
    pub(super) fn vertex_fits(&self, p: u32) -> bool {
        -&self.weights[p as usize] <= self.alpha
    }

    /// Whether x lies strictly inside that circle.
    pub(super) fn inside_vertex(&self, p: u32, x: u32) -> bool {
        self.power(&self.ray(p, x), p, x) < IBig::ZERO
    }

    /// Whether the smallest circle orthogonal to p and q is at most α. With a = q − p and t the
    /// power of q to p its centre is p + ta/2a², its squared radius t²/4a² − ωₚ.
    pub(super) fn edge_fits(&self, p: u32, q: u32) -> bool {
        let a = self.ray(p, q);
        let t = self.power(&a, p, q);
        &t * &t <= 4 * dot(&a, &a) * (&self.alpha + &self.weights[p as usize])
    }

    /// Whether x lies strictly inside that circle.
    pub(super) fn inside_edge(&self, p: u32, q: u32, x: u32) -> bool {
        let (a, e) = (self.ray(p, q), self.ray(p, x));
        self.power(&e, p, x) * dot(&a, &a) < self.power(&a, p, q) * dot(&a, &e)
    }

    /// Whether the circle orthogonal to three points is at most α. Its centre p + c solves
    /// 2c·a = t, 2c·b = u for a = q − p, b = r − p and the powers t, u of q, r to p.
    pub(super) fn triangle_fits(&self, [p, q, r]: [u32; 3]) -> bool {
        let (a, b) = (self.ray(p, q), self.ray(p, r));
        let (t, u) = (self.power(&a, p, q), self.power(&b, p, r));
        let det = cross(&a, &b);
        let x = &t * &b[1] - &u * &a[1];
        let y = &u * &a[0] - &t * &b[0];
        &x * &x + &y * &y <= 4 * (&det * &det) * (&self.alpha + &self.weights[p as usize])
    }
}

impl Square {
    /// This square against 1/α².
    pub(super) fn against(&self, curve: &Curve) -> Ordering {
        let Square { numerator, denominator } = self;
        let scaled = numerator * &curve.square;
        let by = curve.shift.unsigned_abs() as usize;
        if curve.shift >= 0 {
            (scaled << by).cmp(denominator)
        } else {
            scaled.cmp(&(denominator << by))
        }
    }
}

fn dot(a: &[IBig; 2], b: &[IBig; 2]) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1]
}

fn cross(a: &[IBig; 2], b: &[IBig; 2]) -> IBig {
    &a[0] * &b[1] - &a[1] * &b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radii_are_compared_exactly() {
        let tiny = 1e-160;
        for scale in [1.0, 2f64.powi(-300), 2f64.powi(300)] {
            // A right triangle over the diameter 2·scale: its circle has the radius scale.
            let points = [[-1.0, 0.0], [1.0, 0.0], [0.0, 1.0], [tiny, 0.0]]
                .map(|p| p.map(|v: f64| v * scale));
            let exact = Exact::new(&points);
            let circle = exact.circumradius([0, 1, 2]);
            let alpha = 1.0 / scale;
            assert_eq!(circle.against(&exact.curve(alpha)), Ordering::Equal);
            assert_eq!(circle.against(&exact.curve(-alpha.next_up())), Ordering::Greater);
            assert_eq!(circle.against(&exact.curve(alpha.next_down())), Ordering::Less);
            assert_eq!(exact.half_distance(0, 1).against(&exact.curve(alpha)), Ordering::Equal);
            assert_eq!(exact.apex(0, 1, 2), Ordering::Equal);
            assert!(exact.collinear(0, 1, 3));
        }
    }
}
