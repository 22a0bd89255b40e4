//! The centre of the smallest orthogonal sphere of a simplex by its barycentric coordinates, in numbers with twice the digits of
//! doubles, or in integers if those have too few digits: the flatter a simplex, the more digits are lost.

use dashu_int::IBig;

use super::close::rays;
use super::formulas::{Centre, Ray, centre, gram};
use super::size::{Size, View};
use super::twofold::Twofold;
use super::{Ratio, Site, exact};
use crate::number::{Number, dot};

/// The share of a corner of a simplex in the centre c of its smallest orthogonal sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Its barycentric coordinate b of c.
    pub share: f64,
    /// b times the way from c to the corner.
    pub moment: [f64; 3],
}

/// The shares of the corners of a simplex, at these places and with these weights. They are correct to 2⁻⁵⁰ of the largest, and
/// moments to that times the way from c to the corner; if numbers of two doubles do not achieve that, they are the nearest
/// doubles. NaN if the places span no simplex.
///
/// # Panics
/// If the number of corners is not one to four.
pub fn centre_shares<const N: usize>(places: [[f64; 3]; N], weights: [f64; N]) -> [Share; N] {
    let mut sites = [Site { position: [0.0; 3], weight: 0.0 }; N];
    for (site, (position, weight)) in sites.iter_mut().zip(places.into_iter().zip(weights)) {
        *site = Site { position, weight };
    }
    closely(&sites).unwrap_or_else(|| exactly(sites))
}

/// Numerators and denominators of shares and of the centre.
struct Shares<T> {
    /// The numerators of the barycentric coordinates, except the first one's.
    others: Vec<T>,
    of_others: T,
    /// The numerators of the centre, as seen from the first corner.
    centre: [T; 3],
    of_centre: T,
}

impl<T: Number + Clone> Shares<T> {
    fn of(rays: &[Ray<T>]) -> Self {
        let twice = |number: &T| number.plus(number);
        match rays {
            [a] => {
                let square = twice(&dot(&a.vector, &a.vector));
                let centre = a.vector.each_ref().map(|x| a.power.times(x));
                let (of_others, of_centre) = (square.clone(), square);
                Self { others: vec![a.power.clone()], of_others, centre, of_centre }
            }
            [a, b] => {
                let ([u, v], d) = gram(a, b);
                let centre = [0, 1, 2].map(|k| u.times(&a.vector[k]).plus(&v.times(&b.vector[k])));
                let (of_others, of_centre) = (twice(&d), twice(&d));
                Self { others: vec![u, v], of_others, centre, of_centre }
            }
            [a, b, c] => {
                let Centre { twice: centre, det, normals } = centre([a, b, c]);
                let others = normals.iter().map(|normal| dot(&centre, normal)).collect();
                Self { others, of_others: twice(&det.times(&det)), centre, of_centre: twice(&det) }
            }
            _ => unreachable!("a simplex of two to four corners has one to three rays"),
        }
    }
}

/// The only corner is the centre.
const ALONE: Share = Share { share: 1.0, moment: [0.0; 3] };
const NONE: Share = Share { share: f64::NAN, moment: [f64::NAN; 3] };

/// Computes in numbers of two doubles; `None` if their error bounds are too large.
fn closely<const N: usize>(sites: &[Site; N]) -> Option<[Share; N]> {
    /// The error of a quotient is at most a few times that of its parts.
    const PRECISE: f64 = 1.0 / (1u64 << 53) as f64;
    if N == 1 {
        return Some([ALONE; N]);
    }
    let size = View::<N>::of(sites[0], *sites).size;
    let weights_are_sane = sites.iter().all(|site| site.weight.abs() < Size::LARGEST_SQUARE);
    if !(size.is_sane() && weights_are_sane) {
        return None;
    }
    let rays = rays(sites[0], sites);
    let Shares { others, of_others, centre, of_centre } = Shares::of(&rays[1..]);
    // Bounds of the terms of the way from the centre to a corner, and of its denominator, which contains three powers of the
    // length.
    let Size { length, power } = size;
    let (way_terms, centre_terms) = match N {
        2 => (3.0 * power * length, 6.0 * length * length),
        3 => (60.0 * power * length.powi(3), 36.0 * length.powi(4)),
        _ => (10.0 * power * length.powi(2), 12.0 * length.powi(3)),
    };
    let holds = |value: f64, terms: f64| terms * Twofold::ROUNDING <= value.abs() * PRECISE;
    let denominator_terms = 2.0 * size.bounds(N).denominator;
    if !(holds(of_others.high, denominator_terms) && holds(of_centre.high, centre_terms)) {
        return None;
    }
    let first = others.iter().fold(of_others, |rest, share| rest.minus(share));
    let numerators: Vec<Twofold> = std::iter::once(first).chain(others).collect();
    let largest = numerators.iter().fold(0f64, |most, share| most.max(share.high.abs()));
    if !holds(largest, size.barycentric_bound(N)) {
        return None;
    }
    let mut shares = [ALONE; N];
    for ((to, numerator), ray) in shares.iter_mut().zip(numerators).zip(&rays) {
        let way = [0, 1, 2].map(|k| ray.vector[k].times(&of_centre).minus(&centre[k]));
        let longest = way.iter().fold(0f64, |most, x| most.max(x.high.abs()));
        if !holds(longest, way_terms) {
            return None;
        }
        let share = numerator.over(of_others);
        let moment = way.map(|x| share.times(&x.over(of_centre)).high);
        *to = Share { share: share.high, moment };
    }
    Some(shares)
}

/// Computes in integers, and rounds each number to the nearest double.
fn exactly<const N: usize>(sites: [Site; N]) -> [Share; N] {
    if N == 1 {
        return [ALONE; N];
    }
    let (rays, units) = exact::rays(&sites);
    let Shares { others, of_others, centre, of_centre } = Shares::<IBig>::of(&rays[1..]);
    if of_others == IBig::ZERO {
        return [NONE; N];
    }
    // Powers are in finer units than the squares of lengths.
    let [of_others, of_centre] = [of_others, of_centre].map(|length| length << units.finer());
    let first = others.iter().fold(of_others.clone(), |rest, share| rest - share);
    let mut shares = [ALONE; N];
    let numerators = std::iter::once(first).chain(others);
    for ((to, numerator), ray) in shares.iter_mut().zip(numerators).zip(&rays) {
        let moment = [0, 1, 2].map(|k| {
            let way = &ray.vector[k] * &of_centre - &centre[k];
            let denominator = &of_others * &of_centre;
            positive(&numerator * way, denominator, units.coordinate())
        });
        *to = Share { share: positive(numerator, of_others.clone(), 0), moment };
    }
    shares
}

/// The double nearest to a quotient, whose denominator may be negative, times 2^`exponent`.
fn positive(numerator: IBig, denominator: IBig, exponent: i32) -> f64 {
    let (numerator, denominator) = if denominator < IBig::ZERO {
        (-numerator, -denominator)
    } else {
        (numerator, denominator)
    };
    Ratio::new(numerator, denominator, exponent).nearest()
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;

    fn sites<const N: usize>(random: &mut Random, thickness: f64) -> [Site; N] {
        let mut sites = [Site { position: [0.0; 3], weight: 0.0 }; N];
        for site in &mut sites {
            let [x, y, z] = [0; 3].map(|_| random.unit());
            *site = Site { position: [x, y, thickness * z], weight: 0.1 * random.unit() };
        }
        sites
    }

    /// The largest errors of shares, and of moments, relative to their guaranteed precision.
    fn off<const N: usize>(sites: [Site; N]) -> Option<f64> {
        let (found, wanted) = (closely(&sites)?, exactly(sites));
        let largest = |of: &dyn Fn(&Share) -> f64| wanted.iter().map(of).fold(0.0, f64::max);
        let share = largest(&|share| share.share.abs());
        let off = found.iter().zip(&wanted).map(|(found, wanted)| {
            let way =
                wanted.moment.iter().fold(0f64, |most, x| most.max(x.abs())) / wanted.share.abs();
            let moments =
                (0..3).map(|k| (found.moment[k] - wanted.moment[k]).abs() / (share * way));
            moments.fold((found.share - wanted.share).abs() / share, f64::max)
        });
        Some(off.fold(0.0, f64::max))
    }

    #[test]
    fn two_doubles_and_integers_agree() {
        let mut random = Random::new(4);
        let (mut close, mut all) = (0, 0);
        for thickness in [1.0, 1e-5, 1e-10, 1e-14, 1e-25, 1e-40] {
            for _ in 0..50 {
                let off = [
                    off(sites::<2>(&mut random, thickness)),
                    off(sites::<3>(&mut random, thickness)),
                    off(sites::<4>(&mut random, thickness)),
                ];
                for off in off {
                    all += 1;
                    close += usize::from(off.is_some());
                    assert!(off.is_none_or(|off| off < 2f64.powi(-50)), "{off:?} at {thickness}");
                }
            }
        }
        assert!(close > all / 2 && close < all, "{close} of {all}");
    }

    /// The centre of a box's corner is the middle of its diagonal: exact zeros, not remainders.
    #[test]
    fn corners_of_boxes() {
        let corner = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 6.0]];
        let shares = centre_shares(corner, [0.0; 4]);
        assert_eq!(shares.map(|share| share.share), [-0.5, 0.5, 0.5, 0.5]);
        assert_eq!(shares[1].moment, [0.5, -1.0, -1.5]);
        // An edge whose ends have different weights.
        let edge = centre_shares([[1.0; 3], [5.0, 1.0, 1.0]], [0.0, 8.0]);
        assert_eq!(edge.map(|share| share.share), [0.75, 0.25]);
        assert_eq!(edge[1].moment, [0.75, 0.0, 0.0]);
        assert_eq!(centre_shares([[7.0; 3]], [1.0]), [ALONE]);
        let none = centre_shares([[0.0; 3], [0.1; 3], [0.2; 3]], [0.0, 1.0, 0.0]);
        assert!(none.iter().all(|share| share.share.is_nan() && share.moment[0].is_nan()));
        // Beyond the range of polynomials in doubles.
        let huge = centre_shares(corner.map(|p| p.map(|x| x * 2f64.powi(400))), [0.0; 4]);
        assert_eq!(huge.map(|share| share.share), [-0.5, 0.5, 0.5, 0.5]);
        assert_eq!(huge[1].moment, [0.5, -1.0, -1.5].map(|x| x * 2f64.powi(400)));
    }
}
