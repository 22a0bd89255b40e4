//! Signs that doubles leave undecided, decided without integers if possible: by coordinates that are equal, as on grids along the
//! axes, and in numbers with twice the digits.
//!
//! A grid whose spacing is not a double, or which is turned, has rounded coordinates. They are on no lattice of few bits, and
//! most ties on the grid itself become near ties: the difference is about one rounding, and far larger than the roundings of
//! twice the digits. The remaining ties have equal coordinates, like the corners of a box.

use std::cmp::Ordering;

use super::Site;
use super::formulas::{Ray, determinant, power_determinant, quotient, side};
use super::size::Size;
use super::twofold::Twofold;
use crate::number::{Number, dot};

/// The sign of the determinant of b − a, c − a, d − a.
pub(super) fn orientation(sites: &[Site; 4], size: Size, terms: f64) -> Option<Ordering> {
    if in_a_plane_of_the_grid(sites) {
        return Some(Ordering::Equal);
    }
    let [_, b, c, d] = rays(sites[0], sites);
    certain(determinant([&b.vector, &c.vector, &d.vector]), size, terms)
}

/// Whether the last point lies inside (`Less`), on or outside the orthogonal sphere of the positively oriented cell of
/// the others.
pub(super) fn power(sites: &[Site; 5], size: Size, terms: f64) -> Option<Ordering> {
    if have_weight(sites[0].weight, sites) && are_corners_of_a_prism(sites) {
        return Some(Ordering::Equal);
    }
    let [a, b, c, d, _] = rays(sites[4], sites);
    certain(power_determinant(&[a, b, c, d]), size, terms)
}

/// The comparison of the squared radius of the smallest orthogonal sphere with `alpha`.
pub(super) fn radius<const N: usize>(
    sites: &[Site; N],
    alpha: f64,
    size: Size,
    terms: f64,
) -> Option<Ordering> {
    let (numerator, denominator) = quotient(&rays(sites[0], sites)[1..]);
    let Twofold { high, low } = Twofold::sum(alpha, sites[0].weight);
    let four_balls = Twofold { high: 4.0 * high, low: 4.0 * low };
    certain(numerator.minus(&four_balls.times(&denominator)), size, terms)
}

/// Whether `x` lies inside (`Less`), on or outside the smallest orthogonal sphere of an edge or a facet.
pub(super) fn inside<const N: usize>(
    sites: &[Site; N],
    x: Site,
    size: Size,
    terms: f64,
) -> Option<Ordering> {
    if have_weight(x.weight, sites) && has_a_diagonal(sites, x) {
        return Some(Ordering::Equal);
    }
    let [to_x] = rays(sites[0], &[x]);
    certain(side(&rays(sites[0], sites)[1..], &to_x), size, terms)
}

/// The sign of a polynomial whose terms have magnitudes that sum to at most `terms`, if it is beyond its error bound.
fn certain(value: Twofold, size: Size, terms: f64) -> Option<Ordering> {
    let beyond = size.is_sane() && value.high.abs() > terms * Twofold::ROUNDING;
    beyond.then(|| super::sign(value.high))
}

/// Rays from a point with twice the digits.
pub(super) fn rays<const N: usize>(p: Site, sites: &[Site; N]) -> [Ray<Twofold>; N] {
    sites.map(|q| {
        let vector = [0, 1, 2].map(|k| Twofold::sum(q.position[k], -p.position[k]));
        let heavier = Twofold::sum(p.weight, -q.weight);
        Ray { power: dot(&vector, &vector).plus(&heavier), vector }
    })
}

/// Whether four points have one coordinate in common, or at most two pairs of coordinates along two axes: then they lie in one
/// plane, normal to an axis or parallel to one.
fn in_a_plane_of_the_grid(sites: &[Site; 4]) -> bool {
    (0..3).any(|k| has_values(1, along(k, sites)) || has_values(2, across(k, sites)))
}

/// Whether points are corners of a right prism along an axis, over a triangle or a rectangle. With equal weights they lie
/// on the sphere around it.
fn are_corners_of_a_prism(sites: &[Site; 5]) -> bool {
    let two = [0, 1, 2].map(|k| has_values(2, along(k, sites)));
    two == [true; 3] || (0..3).any(|k| two[k] && has_values(3, across(k, sites)))
}

/// Whether two of the points span a box along the axes of which all others, and `x`, are corners. With equal weights they
/// lie on the sphere around it, which is the smallest one that the two lie on.
fn has_a_diagonal<const N: usize>(sites: &[Site; N], x: Site) -> bool {
    let position = sites.map(|site| site.position);
    let corners = |p: [f64; 3], q: [f64; 3]| {
        let is_corner = |r: [f64; 3]| (0..3).all(|k| r[k] == p[k] || r[k] == q[k]);
        is_corner(x.position) && position.iter().all(|&r| is_corner(r))
    };
    (1..N).any(|i| (0..i).any(|j| corners(position[i], position[j])))
}

fn have_weight(weight: f64, sites: &[Site]) -> bool {
    sites.iter().all(|site| site.weight == weight)
}

/// The coordinates along an axis.
fn along<const N: usize>(k: usize, sites: &[Site; N]) -> [f64; N] {
    sites.each_ref().map(|site| site.position[k])
}

/// The coordinates along the other two.
fn across<const N: usize>(k: usize, sites: &[Site; N]) -> [[f64; 2]; N] {
    sites.each_ref().map(|site| [site.position[(k + 1) % 3], site.position[(k + 2) % 3]])
}

/// Whether there are at most this many different values.
fn has_values<T: PartialEq, const N: usize>(most: usize, values: [T; N]) -> bool {
    let is_new = |&i: &usize| !values[..i].contains(&values[i]);
    (0..N).filter(is_new).count() <= most
}
