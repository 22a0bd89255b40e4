//! A squared radius from an approximate centre: as exact as [`Twofold`](super::twofold::Twofold) numbers, with a third of their
//! operations.
//!
//! Let p be the first vertex of a simplex, aᵢ the rays to the others and tᵢ their powers. The centre p + c has
//! 2c·aᵢ = tᵢ and c in the span of the rays, and the squared radius is R = |c|² − ω(p). For any c̃ and μᵢ, let
//!
//! - rᵢ = tᵢ − 2c̃·aᵢ, by how much c̃ misses the equations of c,
//! - δ = c̃ − c, and s = c̃ − Σ μᵢaᵢ.
//!
//! As 2δ·aᵢ = −rᵢ, c is in the span, and δ·c = δ·Σμᵢaᵢ + δ·(s − δ),
//!
//! R = |c̃|² − 2δ·c − |δ|² − ω(p) = |c̃|² − ω(p) + Σ μᵢrᵢ − 2δ·s + |δ|².
//!
//! Doubles give c̃ and μ so well that the last two terms, which have two small factors each, are far below half a unit in the
//! last place of R. The others are sums of products, in which the rounded-off parts are added, too. δ is bounded by its
//! equations, so no assumption about the shape of the simplex is needed; flat ones have large bounds.

use super::formulas::{Ray, Solution};
use super::size::Size;
use super::twofold::Twofold;
use super::{ROUNDING, Site};

/// An approximate centre, relative to the first vertex, the factors μ of the rays, and the numbers that bound its distance from
/// the centre: Σ |rᵢ| times `per_residual`, and |s| if the simplex is `in_plane`, or on a line.
struct Centre<const M: usize> {
    at: [f64; 3],
    factors: [f64; M],
    per_residual: f64,
    in_plane: bool,
}

/// The double nearest to the squared radius of an edge, a facet or a cell, if the bounds determine it; `rays` are those of `sites`
/// in doubles, of this `size`, which is sane, and with this solution.
#[inline(always)]
pub(super) fn nearest<const N: usize>(
    sites: &[Site; N],
    rays: &[Ray<f64>; N],
    size: Size,
    solution: &Solution,
) -> Option<f64> {
    match (&rays[..], &sites[..]) {
        ([_, a], [p, q]) => around(*p, [*q], [a], size, of_edge(a, size, solution)?),
        ([_, a, b], [p, q, r]) => {
            around(*p, [*q, *r], [a, b], size, of_facet([a, b], size, solution)?)
        }
        ([_, a, b, c], [p, q, r, s]) => {
            around(*p, [*q, *r, *s], [a, b, c], size, of_cell(size, solution)?)
        }
        _ => None,
    }
}

#[inline(always)]
fn of_edge(a: &Ray<f64>, size: Size, solution: &Solution) -> Option<Centre<1>> {
    let square = solution.det;
    let least = square - 3.0 * size.length * size.length * ROUNDING;
    if least <= 0.5 * square {
        return None;
    }
    let factor = solution.others[0] * (0.5 / square);
    let at = a.vector.map(|x| factor * x);
    // Along the edge, δ = −½ r a / |a|². Across it, δ is that of s.
    Some(Centre { at, factors: [factor], per_residual: 0.5 / least.sqrt(), in_plane: true })
}

#[inline(always)]
fn of_facet(rays: [&Ray<f64>; 2], size: Size, solution: &Solution) -> Option<Centre<2>> {
    let gram = solution.det;
    let square = size.length * size.length;
    let least = gram - 18.0 * square * square * ROUNDING;
    if least <= 0.5 * gram {
        return None;
    }
    let twice = 0.5 / gram;
    let [u, v, _] = solution.others;
    let factors = [u * twice, v * twice];
    let at = [0, 1, 2].map(|k| factors[0] * rays[0].vector[k] + factors[1] * rays[1].vector[k]);
    // In the plane, δ = −½ Σ rᵢaᵢ* in the dual basis: |a*| = |b| / |a×b|, and |b| ≤ √3 times the size. Across the plane, δ is
    // that of s.
    let per_residual = 0.9 * size.length / least.sqrt();
    Some(Centre { at, factors, per_residual, in_plane: true })
}

#[inline(always)]
fn of_cell(size: Size, solution: &Solution) -> Option<Centre<3>> {
    let det = solution.det;
    let square = size.length * size.length;
    let least = det.abs() - 6.0 * square * size.length * ROUNDING;
    if least <= 0.5 * det.abs() {
        return None;
    }
    let twice = 0.5 / det;
    let at = solution.twice.map(|x| x * twice);
    let square_of_det = twice / det;
    let factors = solution.others.map(|x| x * square_of_det);
    // δ = −½ Σ rᵢnᵢ / det for the normals nᵢ, which are at most 3 times the square of the size.
    Some(Centre { at, factors, per_residual: 1.5 * square / least, in_plane: false })
}

#[inline(always)]
fn around<const M: usize>(
    p: Site,
    others: [Site; M],
    rays: [&Ray<f64>; M],
    size: Size,
    centre: Centre<M>,
) -> Option<f64> {
    let Centre { at, factors, per_residual, in_plane } = centre;
    let far = at.iter().fold(0f64, |most, x| most.max(x.abs()));
    // Terms that underflow are far below the errors of the others; NaN is refused, too.
    if !(far > Size::SHORTEST && far < Size::LONGEST) {
        return None;
    }
    let twice = at.map(|x| 2.0 * x);
    // The error of one residual; the magnitudes of its terms are aₖ(aₖ + 2c̃ₖ) and the weights, which are summed exactly.
    let off = Twofold::ROUNDING * (size.power + 6.0 * size.length * far);
    let residuals = residuals(p, &others, twice);
    let (mut missed, mut correction, mut wrong) = (0.0, 0.0, 0.0);
    let mut sum_of_factors = 0.0;
    for (residual, factor) in residuals.into_iter().zip(factors) {
        missed += residual.abs() + off;
        correction += factor * residual;
        wrong += factor.abs() * residual.abs();
        sum_of_factors += factor.abs();
    }
    // |s|: its terms are those of c̃ and of Σ μᵢaᵢ.
    let gap: f64 = [0, 1, 2]
        .map(|k| {
            let sum: f64 =
                rays.iter().zip(factors).map(|(ray, factor)| factor * ray.vector[k]).sum();
            (at[k] - sum).abs()
        })
        .iter()
        .sum();
    let gap = gap + 3.0 * ROUNDING * (far + sum_of_factors * size.length);
    let delta = per_residual * missed + if in_plane { gap } else { 0.0 };
    let mut square = Compensated { high: -p.weight, low: 0.0 };
    for x in at {
        square.add_product(x, x);
    }
    let error = delta * (delta + 2.0 * gap)
        + sum_of_factors * off
        + 4.0 * f64::EPSILON * wrong
        + Twofold::ROUNDING * (3.0 * far * far + p.weight.abs() + wrong);
    Twofold::sum(square.high, square.low + correction).nearest(error).map(|radius| radius + 0.0)
}

/// The residuals rᵢ, each a sum of products. One operation on all of them follows the other, so that compilers do two at a
/// time.
#[inline(always)]
fn residuals<const M: usize>(p: Site, others: &[Site; M], twice: [f64; 3]) -> [f64; M] {
    let [mut high, mut low] = each([p.weight; M], others.map(|q| -q.weight), Twofold::sum);
    for (k, twice) in twice.into_iter().enumerate() {
        let along = each(others.map(|q| q.position[k]), [-p.position[k]; M], Twofold::sum);
        let less = each(along[0], [-twice; M], Twofold::sum);
        let product = each(along[0], less[0], Twofold::product);
        let sum = each(high, product[0], Twofold::sum);
        high = sum[0];
        for i in 0..M {
            low[i] += product[1][i] + sum[1][i];
            low[i] += along[0][i] * (less[1][i] + along[1][i]) + along[1][i] * less[0][i];
        }
    }
    let mut residuals = high;
    for (residual, low) in residuals.iter_mut().zip(low) {
        *residual += low;
    }
    residuals
}

/// The upper and the lower parts of the results of one operation on pairs of numbers.
#[inline(always)]
fn each<const M: usize>(
    a: [f64; M],
    b: [f64; M],
    operation: impl Fn(f64, f64) -> Twofold,
) -> [[f64; M]; 2] {
    let (mut high, mut low) = ([0.0; M], [0.0; M]);
    for i in 0..M {
        let result = operation(a[i], b[i]);
        (high[i], low[i]) = (result.high, result.low);
    }
    [high, low]
}

/// A sum of doubles and products, in which the rounded-off parts are added, too (Ogita, Rump and Oishi 2005,
/// doi:10.1137/030601818). With u = 2⁻⁵³, the error of fewer than ten terms is below 2⁻⁹⁷ times the sum of their magnitudes: the
/// rounded-off parts have magnitudes of at most 3u times that sum each, and adding them rounds by u times their magnitudes.
struct Compensated {
    high: f64,
    low: f64,
}

impl Compensated {
    #[inline(always)]
    fn add_product(&mut self, a: f64, b: f64) {
        let product = Twofold::product(a, b);
        let sum = Twofold::sum(self.high, product.high);
        self.high = sum.high;
        self.low += product.low + sum.low;
    }
}
