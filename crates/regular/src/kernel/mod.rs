//! The exact predicates of regular triangulations and α-complexes: orientation, power test, radius of the smallest orthogonal
//! sphere, and whether a point lies inside it.
//!
//! Each predicate is the sign of a polynomial. It is evaluated in doubles, and accepted if its magnitude exceeds a forward error
//! bound, or if the arithmetic is exact because all numbers are small multiples of a power of two, as on voxel grids. Otherwise
//! numbers with twice the digits decide, and finally integers.

mod centred;
mod close;
mod exact;
mod formulas;
mod nearest;
mod ratio;
mod screen;
mod shares;
mod size;
mod twofold;

use std::cmp::Ordering;

use formulas::{Centre, Solution, centre, determinant, power_determinant, quotient, side};
pub use nearest::SmallRadius;
pub use ratio::Ratio;
pub use screen::Screen;
pub use shares::{Share, centre_shares};
use size::{Size, View, ray};
pub use twofold::Twofold;

use super::Torus;
use crate::Lattice;

/// A weighted point.
#[derive(Clone, Copy)]
pub(crate) struct Site {
    position: [f64; 3],
    weight: f64,
}

/// Doubles that enclose a real number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// A lower bound.
    pub low: f64,
    /// An upper bound.
    pub high: f64,
}

impl Interval {
    /// Encloses every number whose nearest double this is.
    pub fn around(nearest: f64) -> Self {
        Self { low: nearest.next_down(), high: nearest.next_up() }
    }
}

/// Predicates on weighted points, which are given by index.
#[derive(Debug)]
pub struct Predicates<'a> {
    positions: &'a [[f64; 3]],
    weights: &'a [f64],
    lattice: Lattice,
    /// For each degree less 1, the largest sum of magnitudes of terms for which a polynomial in coordinates is exact in doubles;
    /// 0 without a lattice.
    exact: [f64; 8],
    /// On a torus, points stand for all their copies: a simplex has the copies nearest to its first corner.
    torus: Option<Torus>,
}

/// Relative rounding error, 2⁻⁴⁸ = 32·2⁻⁵³: a polynomial takes fewer than 32 roundings of at most 2⁻⁵³ each, so its
/// error is less than this times the sum of the magnitudes of its terms.
const ROUNDING: f64 = 1.0 / (1u64 << 48) as f64;

/// Not all integers from here on are doubles: 2⁵³.
const MAX_INTEGER: f64 = (1u64 << f64::MANTISSA_DIGITS) as f64;

impl<'a> Predicates<'a> {
    /// Predicates on points, with their own lattice. O(n).
    pub fn new(positions: &'a [[f64; 3]], weights: &'a [f64]) -> Self {
        Self::on(Lattice::of(positions, weights), positions, weights)
    }

    /// Predicates on points of a known lattice. O(1).
    pub fn on(lattice: Lattice, positions: &'a [[f64; 3]], weights: &'a [f64]) -> Self {
        let exact = [1, 2, 3, 4, 5, 6, 7, 8].map(|degree| MAX_INTEGER * lattice.step.powi(degree));
        Self { positions, weights, lattice, exact, torus: None }
    }

    /// Predicates on a few points, each of which is evaluated once: searching for a lattice would take longer.
    pub(crate) fn of_few(positions: &'a [[f64; 3]], weights: &'a [f64]) -> Self {
        Self { positions, weights, lattice: Lattice::NONE, exact: [0.0; 8], torus: None }
    }

    /// Predicates on points of a torus, if one is given. The other corners of a simplex, and a point tested against
    /// it, must be nearer to its first corner than half of each vector of the box. O(n).
    pub fn on_torus(positions: &'a [[f64; 3]], weights: &'a [f64], torus: Option<Torus>) -> Self {
        let lattice = lattice(positions, weights, torus);
        Self { torus, ..Self::on(lattice, positions, weights) }
    }

    #[inline(always)]
    fn site(&self, v: u32) -> Site {
        Site { position: self.positions[v as usize], weight: self.weights[v as usize] }
    }

    #[inline(always)]
    fn sites<const N: usize>(&self, simplex: [u32; N]) -> [Site; N] {
        let mut sites = [Site { position: [0.0; 3], weight: 0.0 }; N];
        for (site, v) in sites.iter_mut().zip(simplex) {
            *site = self.site(v);
        }
        if let Some(torus) = &self.torus {
            let first = sites[0].position;
            sites.iter_mut().for_each(|site| site.position = torus.near(first, site.position));
        }
        sites
    }

    /// A point to be tested against a simplex with the first corner `p`: its copy nearest to `p`.
    #[inline(always)]
    fn nearest_copy(&self, p: Site, v: u32) -> Site {
        let site = self.site(v);
        match &self.torus {
            None => site,
            Some(torus) => Site { position: torus.near(p.position, site.position), ..site },
        }
    }

    /// Encloses the squared radius of the smallest orthogonal sphere of a simplex: the smallest α that it fits.
    #[inline]
    pub fn squared_radius<const N: usize>(&self, simplex: [u32; N]) -> Interval {
        let p = self.site(simplex[0]);
        if N == 1 {
            return Interval { low: -p.weight, high: -p.weight };
        }
        let View { rays, size } = View::<N>::of(p, self.sites(simplex));
        let (numerator, denominator) = quotient(&rays[1..]);
        let bounds = size.bounds(N);
        let error = |bound: f64, degree: usize, exact: bool| {
            if exact && self.holds(bound, degree) { 0.0 } else { bound * ROUNDING }
        };
        let above = error(bounds.numerator, 2 * N, self.lattice.holds_weights);
        let below = error(bounds.denominator, 2 * N - 2, true);
        if !(size.is_sane() && denominator > 2.0 * below) {
            let high = self.first_alpha(simplex);
            return Interval { low: high.next_down(), high };
        }
        let quotient = numerator / (4.0 * denominator);
        let radius = quotient - p.weight;
        // |n/d − ñ/d̃| ≤ (e_n + (ñ/d̃) e_d) / (d̃ − e_d); then the division and the difference.
        let error = (above + 4.0 * quotient * below) / (4.0 * (denominator - below))
            + f64::EPSILON * (quotient + radius.abs());
        let error = error * (1.0 + 1e-9);
        Interval { low: (radius - error).next_down(), high: (radius + error).next_up() }
    }

    /// Whether a simplex fits α: the squared radius of its smallest orthogonal sphere, of which the
    /// interval is known, is at most α. Exact.
    #[inline]
    pub fn fits_by<const N: usize>(&self, simplex: [u32; N], radius: Interval, alpha: f64) -> bool {
        if radius.high <= alpha || alpha == f64::INFINITY {
            return true;
        }
        if radius.low > alpha || alpha == f64::NEG_INFINITY {
            return false;
        }
        self.fits(simplex, alpha)
    }

    /// The smallest double α that a simplex fits: its squared radius, rounded up. Computed by division of integers in some
    /// microseconds.
    pub fn first_alpha<const N: usize>(&self, simplex: [u32; N]) -> f64 {
        let sites = self.sites(simplex);
        if N == 1 { -sites[0].weight } else { exact::squared_radius(sites).rounded_up() }
    }

    /// Whether a point lies strictly inside the smallest orthogonal sphere of a vertex, an edge or
    /// a facet. Exact.
    #[inline]
    pub fn inside<const N: usize>(&self, simplex: [u32; N], x: u32) -> bool {
        let sites = self.sites(simplex);
        let p = sites[0];
        let x = self.nearest_copy(p, x);
        let View { rays, size } = View::<N>::of(p, sites);
        let (ray, of_ray) = ray(p, x);
        let size = size.larger(of_ray);
        let value = if N == 1 { ray.power } else { side(&rays[1..], &ray) };
        let bound = size.side_bound(N);
        let exact = self.lattice.holds_weights && self.holds(bound, 2 * N);
        if exact || (size.is_sane() && value.abs() > bound * ROUNDING) {
            value < 0.0
        } else {
            let closely = if N == 1 { None } else { close::inside(&sites, x, size, bound) };
            closely.map_or_else(|| exact::inside(sites, x), Ordering::is_lt)
        }
    }

    /// For each corner of an edge, a facet or a cell, whether it lies strictly inside the smallest orthogonal sphere of
    /// the face opposite it. Exact.
    ///
    /// It does if the centre of the simplex's own smallest orthogonal sphere lies beyond that face: the power of a corner with
    /// respect to the sphere of the face is twice the product of its height above the face and the height of the centre.
    pub fn inside_opposite<const N: usize>(&self, simplex: [u32; N]) -> [bool; N] {
        self.radius_and_inside(simplex, || false).1
    }

    /// [`Self::nearest_radius`], if it is wanted, and [`Self::inside_opposite`], which have much of their work in common.
    #[inline(always)]
    pub fn radius_and_inside<const N: usize>(
        &self,
        simplex: [u32; N],
        is_wanted: impl FnOnce() -> bool,
    ) -> (Option<f64>, [bool; N]) {
        let sites = self.sites(simplex);
        let View { rays, size } = View::<N>::of(sites[0], sites);
        let solution = Solution::of(&rays[1..]);
        let radius = is_wanted().then(|| self.radius(simplex, &sites, &rays, size, &solution));
        let bound = size.barycentric_bound(N);
        let exact = self.lattice.holds_weights && self.holds(bound, 2 * N - 2);
        let sane = size.is_sane();
        let error = bound * ROUNDING;
        let values: [f64; N] = solution.barycentric();
        let mut inside = [false; N];
        for (corner, (inside, value)) in inside.iter_mut().zip(values).enumerate() {
            *inside = if exact || (sane && value.abs() > error) {
                value < 0.0
            } else {
                self.inside_face(simplex, corner)
            };
        }
        (radius, inside)
    }

    /// Whether a corner lies strictly inside the smallest orthogonal sphere of the face opposite it.
    #[cold]
    fn inside_face<const N: usize>(&self, simplex: [u32; N], corner: usize) -> bool {
        let other = |k: usize| simplex[(corner + k) % N];
        let x = simplex[corner];
        match N {
            2 => self.inside([other(1)], x),
            3 => self.inside([other(1), other(2)], x),
            _ => self.inside([other(1), other(2), other(3)], x),
        }
    }

    /// The sign of the determinant of b − a, c − a, d − a. Exact.
    pub fn orientation(&self, corners: [u32; 4]) -> Ordering {
        let sites = self.sites(corners);
        let View { rays: [_, b, c, d], size } = View::of(sites[0], sites);
        let value = determinant([&b.vector, &c.vector, &d.vector]);
        let bound = 6.0 * size.length * size.length * size.length;
        if self.holds(bound, 3) || (size.is_sane() && value.abs() > bound * ROUNDING) {
            sign(value)
        } else {
            close::orientation(&sites, size, bound).unwrap_or_else(|| exact::orientation(sites))
        }
    }

    /// Whether three points lie on one line. Exact, in integers.
    pub fn collinear(&self, corners: [u32; 3]) -> bool {
        exact::collinear(self.sites(corners))
    }

    /// Whether a point lies inside (`Less`), on (`Equal`) or outside the orthogonal sphere of a
    /// positively oriented cell. Exact.
    pub fn power(&self, cell: [u32; 4], t: u32) -> Ordering {
        let sites = self.sites(cell);
        let t = self.nearest_copy(sites[0], t);
        let View { rays, size } = View::of(t, sites);
        let value = power_determinant(&rays);
        let bound = 24.0 * size.length * size.length * size.length * size.power;
        let equal_weights = sites.iter().all(|site| site.weight == t.weight);
        let exact = (equal_weights || self.lattice.holds_weights) && self.holds(bound, 5);
        if exact || (size.is_sane() && value.abs() > bound * ROUNDING) {
            sign(value)
        } else {
            let sites = [sites[0], sites[1], sites[2], sites[3], t];
            close::power(&sites, size, bound).unwrap_or_else(|| exact::power(sites))
        }
    }

    /// The centre of the orthogonal sphere of a positively oriented cell, relative to its first corner. Each coordinate is
    /// correct to 2⁻³⁰ of the cell's largest difference of coordinates and of the distance; if doubles do not achieve that, it is
    /// the nearest double.
    pub fn centre(&self, cell: [u32; 4]) -> [f64; 3] {
        /// The ratio of a determinant to the error bound of its terms for which a quotient by it is right to 2⁻³⁰.
        const WELL_ABOVE: f64 = (1u64 << 32) as f64;
        let sites = self.sites(cell);
        let View { rays: [_, b, c, d], size } = View::of(sites[0], sites);
        let Centre { twice, det, .. } = centre([&b, &c, &d]);
        let bound = 6.0 * size.length * size.length * size.length;
        if size.is_sane() && det > bound * ROUNDING * WELL_ABOVE {
            twice.map(|twice| twice / (2.0 * det))
        } else {
            exact::centre_of(sites)
        }
    }

    /// Whether a simplex fits a finite α: the squared radius of its smallest orthogonal sphere is at
    /// most α. Exact.
    #[inline]
    pub fn fits<const N: usize>(&self, simplex: [u32; N], alpha: f64) -> bool {
        let sites = self.sites(simplex);
        let p = sites[0];
        if N == 1 {
            return -p.weight <= alpha;
        }
        let View { rays, size } = View::<N>::of(p, sites);
        let (numerator, denominator) = quotient(&rays[1..]);
        let ball = alpha + p.weight;
        let value = numerator - 4.0 * ball * denominator;
        let bounds = size.bounds(N);
        let bound = bounds.numerator + 4.0 * ball.abs() * bounds.denominator;
        let exact = self.lattice.holds_weights && self.on_lattice(alpha);
        let sane = size.is_sane() && ball.abs() < Size::LARGEST_SQUARE;
        if (exact && self.holds(bound, 2 * N)) || (sane && value.abs() > bound * ROUNDING) {
            value <= 0.0
        } else {
            let closely = if sane { close::radius(&sites, alpha, size, bound) } else { None };
            closely.map_or_else(|| exact::fits(sites, alpha), Ordering::is_le)
        }
    }

    /// Whether a polynomial of this degree, whose terms have magnitudes that sum to at most `bound`, is exact in doubles.
    #[inline]
    fn holds(&self, bound: f64, degree: usize) -> bool {
        // Without a step nothing is exact, not even a bound that underflowed to 0.
        self.lattice.step != 0.0 && bound <= self.exact[degree - 1]
    }

    /// Whether a squared length is a multiple of the squared step.
    fn on_lattice(&self, square: f64) -> bool {
        let multiple = square / (self.lattice.step * self.lattice.step);
        let underflows = multiple == 0.0 && square != 0.0;
        self.lattice.step != 0.0
            && multiple.abs() < MAX_INTEGER
            && multiple.round() == multiple
            && !underflows
    }
}

/// The lattice of points and, on a torus, of all their copies.
pub fn lattice(positions: &[[f64; 3]], weights: &[f64], torus: Option<Torus>) -> Lattice {
    match torus {
        None => Lattice::of(positions, weights),
        Some(torus) => Lattice::of(&[positions, &torus.vectors()].concat(), weights),
    }
}

/// The bounding box of points: smallest and largest coordinates, +∞ and −∞ without points. O(n).
pub(crate) fn extent(positions: &[[f64; 3]]) -> ([f64; 3], [f64; 3]) {
    let empty = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    positions.iter().fold(empty, |(low, high), p| {
        ([0, 1, 2].map(|k| p[k].min(low[k])), [0, 1, 2].map(|k| p[k].max(high[k])))
    })
}

fn sign(value: f64) -> Ordering {
    value.partial_cmp(&0.0).expect("no NaN passes a bound")
}

#[cfg(test)]
mod tests;
