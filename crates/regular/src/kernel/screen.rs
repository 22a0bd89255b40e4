//! Orientation and power test on many points, filtered: one error bound for the whole set decides nearly all.

use std::cmp::Ordering;

use super::formulas::{Ray, determinant, power_determinant};
use super::{Predicates, ROUNDING};
use crate::{TriangulationError, with_capacity};

/// Weighted points lifted to the paraboloid: coordinates relative to the centre of the bounding box, and the height
/// h = |p|² − ω. Both determinants are computed from these four doubles. On a lattice where the terms of a determinant
/// sum to at most 2⁵³ in magnitude, every sign is exact, ties included. Otherwise a sign is accepted beyond one error
/// bound for the whole set, and [`Predicates`] decide the rest.
#[derive(Debug)]
pub struct Screen<'a> {
    predicates: &'a Predicates<'a>,
    /// Points as [x, z, y, h], not [x, y, z, h]: `power_determinant` multiplies the lanes (x, z) by the lanes (y, h),
    /// so that one vector instruction computes the minors in the columns (x, y) and (z, h). In this order both pairs
    /// are adjacent in memory, and a difference of two points is not shuffled. After the last point comes the infinite vertex,
    /// all NaN: no comparison accepts a sign that it takes part in.
    points: Vec<[f64; 4]>,
    /// If every orientation is exact: factors of x and y for which `x·fx + y·fy + z` orders points by (x, y, z), exactly.
    order: Option<[f64; 2]>,
    /// Error bounds of the determinants: beyond them a sign is certain. 0 if the determinants are exact.
    orientation: f64,
    power: f64,
}

/// 2⁻¹⁰⁶⁰, 2¹⁴ times the smallest positive double: bounds the total loss of the products of a determinant by underflow, before
/// they are multiplied by further factors.
const UNDERFLOW: f64 = f64::from_bits(1 << 14);

impl<'a> Screen<'a> {
    /// Lifts all points, and bounds the errors. O(n).
    ///
    /// # Errors
    /// Out of memory: 32 bytes per point are needed.
    pub fn new(predicates: &'a Predicates<'a>) -> Result<Self, TriangulationError> {
        let (positions, weights) = (predicates.positions, predicates.weights);
        let (low, high) = super::extent(positions);
        let equal_weights = weights.windows(2).all(|pair| pair[0] == pair[1]);
        let lattice = predicates.lattice;
        let exact = lattice.step != 0.0 && (lattice.holds_weights || equal_weights);
        let centre = [0, 1, 2].map(|k| match lattice.step {
            0.0 => low[k] / 2.0 + high[k] / 2.0,
            step => ((low[k] / 2.0 + high[k] / 2.0) / step).round() * step,
        });
        let mut points = with_capacity(positions.len() + 1)?;
        let mut highest = 0f64;
        for (position, weight) in positions.iter().zip(weights) {
            let [x, y, z] = [0, 1, 2].map(|k| position[k] - centre[k]);
            let (square, weight) =
                (x * x + y * y + z * z, if equal_weights { 0.0 } else { *weight });
            highest = highest.max(square + weight.abs());
            points.push([x, z, y, square - weight]);
        }
        points.push([f64::NAN; 4]);
        let [width, depth, height] = [0, 1, 2].map(|k| high[k] - low[k]);
        let terms = 6.0 * width * depth * height;
        // Four differences of heights, each at most twice the largest height.
        let power_terms = 4.0 * terms * 2.0 * highest;
        // Underflows of products, times the factors by which they are multiplied later; ∞ if a product may overflow.
        let underflow =
            UNDERFLOW * (1.0 + width) * (1.0 + depth) * (1.0 + height) * (1.0 + highest);
        let error_bound = |terms: f64, degree: usize, exact: bool| {
            if exact && predicates.holds(terms, degree) {
                0.0
            } else {
                // The relative error of a difference is below 2⁻⁵⁰ of the largest one, which `ROUNDING` covers.
                terms * ROUNDING + underflow
            }
        };
        let on_lattice = lattice.step != 0.0;
        let (orientation, power) =
            (error_bound(terms, 3, on_lattice), error_bound(power_terms, 5, exact));
        // A step in y counts more than the whole extent in z, and a step in x more than the extents in y and z. The sum stays
        // below 2⁵³, like six times the product of the extents.
        let counts = |extent: f64| extent / lattice.step + 1.0;
        let order = (on_lattice && orientation == 0.0)
            .then(|| [counts(depth) * counts(height), counts(height)]);
        Ok(Self { predicates, points, order, orientation, power })
    }

    /// Like [`new`](Self::new), but the infinite vertex has an index into the positions whose entry is a dummy. That entry must
    /// be a copy of a point's, so that it widens no bound.
    ///
    /// # Errors
    /// Out of memory: 32 bytes per point are needed.
    pub fn with_infinite(
        predicates: &'a Predicates<'a>,
        at_infinity: u32,
    ) -> Result<Self, TriangulationError> {
        let mut screen = Self::new(predicates)?;
        screen.points[at_infinity as usize] = [f64::NAN; 4];
        Ok(screen)
    }

    /// The number of points; a [`Self::with_infinite`] counts, too.
    pub fn count(&self) -> usize {
        self.points.len() - 1
    }

    /// The sign of the determinant of b − a, c − a, d − a: positive if a, b, c turn counter-clockwise, as seen from d.
    #[inline(always)]
    pub fn orientation(&self, corners: [u32; 4]) -> Ordering {
        let a = &self.points[corners[0] as usize];
        let ray = |v: u32| {
            let q = &self.points[v as usize];
            [q[0] - a[0], q[2] - a[2], q[1] - a[1]]
        };
        let value = determinant([&ray(corners[1]), &ray(corners[2]), &ray(corners[3])]);
        if value > self.orientation {
            Ordering::Greater
        } else if value < -self.orientation {
            Ordering::Less
        } else if self.orientation == 0.0 {
            Ordering::Equal
        } else {
            self.predicates.orientation(corners)
        }
    }

    /// Whether three points lie on one line.
    pub fn collinear(&self, [a, b, c]: [u32; 3]) -> bool {
        self.predicates.collinear([a, b, c])
    }

    /// Whether a point lies inside the orthogonal sphere of a positively oriented cell; `None` if the error bound
    /// does not decide, and for infinite cells.
    #[inline(always)]
    pub fn conflicts(&self, cell: [u32; 4], t: u32) -> Option<bool> {
        let x = &self.points[t as usize];
        let ray = |v: u32| {
            let p = &self.points[v as usize];
            Ray { vector: [p[0] - x[0], p[2] - x[2], p[1] - x[1]], power: p[3] - x[3] }
        };
        let value = power_determinant(&[ray(cell[0]), ray(cell[1]), ray(cell[2]), ray(cell[3])]);
        (value.abs() > self.power).then_some(value < 0.0)
    }

    /// The exact test of a finite cell that [`Self::conflicts`] has not decided. For points on the sphere, each lifted
    /// point is raised by an infinitesimal height, which is larger the later the point comes in the order of (x, y, z)
    /// (Devillers and Teillaud 2011, doi:10.1016/j.comgeo.2010.09.010; CGAL's `Regular_triangulation_3` does the same).
    pub fn conflicts_exactly(&self, cell: [u32; 4], t: u32) -> bool {
        // An exact filter has found a 0.
        let sign = match self.power {
            0.0 => Ordering::Equal,
            _ => self.predicates.power(cell, t),
        };
        sign.is_lt() || (sign.is_eq() && self.conflicts_raised(cell, t))
    }

    /// For a point on the sphere: whether the first term in the infinitesimal heights that is not 0 is negative.
    fn conflicts_raised(&self, cell: [u32; 4], t: u32) -> bool {
        // The index of `t` among the five.
        const TESTED: usize = 4;
        let mut points = [cell[0], cell[1], cell[2], cell[3], t];
        let mut corners = [0, 1, 2, 3, TESTED];
        for count in [5, 4, 3] {
            let last = self.last(&points[..count]);
            let corner = corners[last];
            if corner == TESTED {
                return false;
            }
            let mut moved = cell;
            moved[corner] = t;
            let sign = self.orientation(moved);
            if sign.is_ne() {
                return sign.is_gt();
            }
            points[last] = points[count - 1];
            corners[last] = corners[count - 1];
        }
        false
    }

    /// The index of the point that comes last in the order of (x, y, z).
    fn last(&self, points: &[u32]) -> usize {
        let mut last = 0;
        if let Some([by_x, by_y]) = self.order {
            let key = |v: u32| {
                let [x, z, y, _] = self.points[v as usize];
                x * by_x + y * by_y + z
            };
            let mut highest = key(points[0]);
            for (at, &v) in points.iter().enumerate().skip(1) {
                let key = key(v);
                last = if key > highest { at } else { last };
                highest = highest.max(key);
            }
        } else {
            let position = |at: usize| self.predicates.positions[points[at] as usize];
            for at in 1..points.len() {
                if position(at) > position(last) {
                    last = at;
                }
            }
        }
        last
    }
}
