//! Orientation and power test for many points: one bound for the whole set decides nearly all.

use std::cmp::Ordering;

use super::formulas::{Ray, determinant, power_determinant};
use super::{Predicates, ROUNDING};
use crate::{TriangulationError, room};

/// Weighted points about the middle of their box, each with its height |p|² − ω on the paraboloid:
/// four doubles that both determinants are made of. On a lattice where all terms of a determinant
/// stay below 2⁵³ every sign is exact, ties included; else a sign is believed beyond one bound for
/// the whole set, and [`Predicates`] decide the rest.
pub struct Screen<'a> {
    predicates: &'a Predicates<'a>,
    /// One more than there are: the ghost is nowhere, so that no sign is believed.
    points: Vec<[f64; 4]>,
    /// Where every determinant of coordinates is exact: what x and y count for in the number that
    /// orders points by (x, y, z).
    order: Option<[f64; 2]>,
    orientation: f64,
    power: f64,
}

/// 2¹⁴ times the smallest double: 2⁻¹⁰⁶⁰.
const LOST: f64 = f64::from_bits(1 << 14);

impl<'a> Screen<'a> {
    /// Looks at all points. O(n).
    ///
    /// # Errors
    /// No memory for 32 bytes a point.
    pub fn new(predicates: &'a Predicates<'a>) -> Result<Self, TriangulationError> {
        let (positions, weights) = (predicates.positions, predicates.weights);
        let (low, high) = super::extent(positions);
        let alike = weights.windows(2).all(|pair| pair[0] == pair[1]);
        let lattice = predicates.lattice;
        let exact = lattice.step != 0.0 && (lattice.holds_weights || alike);
        let middle = [0, 1, 2].map(|k| match lattice.step {
            0.0 => low[k] / 2.0 + high[k] / 2.0,
            step => ((low[k] / 2.0 + high[k] / 2.0) / step).round() * step,
        });
        let mut points = room(positions.len() + 1)?;
        let mut highest = 0f64;
        for (position, weight) in positions.iter().zip(weights) {
            let [x, y, z] = [0, 1, 2].map(|k| position[k] - middle[k]);
            let (square, weight) = (x * x + y * y + z * z, if alike { 0.0 } else { *weight });
            highest = highest.max(square + weight.abs());
            points.push([x, z, y, square - weight]);
        }
        points.push([f64::NAN; 4]);
        let [width, depth, height] = [0, 1, 2].map(|k| high[k] - low[k]);
        let terms = 6.0 * width * depth * height;
        // Four differences of heights, each of at most twice the largest.
        let power_terms = 4.0 * terms * 2.0 * highest;
        // What products lose that fall below the smallest doubles, times what they are multiplied by; ∞
        // where one may overflow.
        let lost = LOST * (1.0 + width) * (1.0 + depth) * (1.0 + height) * (1.0 + highest);
        let sure = |terms: f64, degree: usize, exact: bool| {
            if exact && predicates.holds(terms, degree) {
                0.0
            } else {
                // A difference is off by less than 2⁻⁵⁰ of the largest; see `ROUNDING`.
                terms * ROUNDING + lost
            }
        };
        let on_lattice = lattice.step != 0.0;
        let (orientation, power) = (sure(terms, 3, on_lattice), sure(power_terms, 5, exact));
        // One more than the steps there are in z, and so for y: below 2⁵³ in all, as `terms` are, of which
        // there are six.
        let more = |extent: f64| extent / lattice.step + 1.0;
        let order =
            (on_lattice && orientation == 0.0).then(|| [more(depth) * more(height), more(height)]);
        Ok(Self { predicates, points, order, orientation, power })
    }

    /// The same where the ghost has the number of a point, whose place is another point's.
    ///
    /// # Errors
    /// No memory for 32 bytes a point.
    pub fn with_ghost(
        predicates: &'a Predicates<'a>,
        ghost: u32,
    ) -> Result<Self, TriangulationError> {
        let mut screen = Self::new(predicates)?;
        screen.points[ghost as usize] = [f64::NAN; 4];
        Ok(screen)
    }

    /// The number of points.
    pub fn count(&self) -> usize {
        self.points.len() - 1
    }

    /// The sign of the determinant of b − a, c − a, d − a: positive if a, b, c turn
    /// counter-clockwise seen from d.
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

    /// Whether a point lies inside the orthogonal sphere of a positively oriented cell; `None` if
    /// that needs a closer look, or if the cell is infinite.
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

    /// The same for a finite cell, always decided: points on the sphere are judged as if each point
    /// were raised by an infinitely small height, the larger the later it comes in the order of
    /// (x, y, z) (Devillers and Teillaud 2011, doi:10.1016/j.comgeo.2010.09.010; CGAL's
    /// `Regular_triangulation_3` does the same).
    pub fn conflicts_closely(&self, cell: [u32; 4], t: u32) -> bool {
        // With a bound of 0 the first look has seen a true 0.
        let sign = match self.power {
            0.0 => Ordering::Equal,
            _ => self.predicates.power(cell, t),
        };
        sign.is_lt() || (sign.is_eq() && self.conflicts_raised(cell, t))
    }

    /// For a point on the sphere: the sign of the first term in the infinitely small heights that
    /// is not 0.
    fn conflicts_raised(&self, cell: [u32; 4], t: u32) -> bool {
        let mut names = [cell[0], cell[1], cell[2], cell[3], t];
        let mut places = [0, 1, 2, 3, 4];
        for count in [5, 4, 3] {
            let last = self.last(&names[..count]);
            let place = places[last];
            if place == 4 {
                return false;
            }
            let mut moved = cell;
            moved[place] = t;
            let sign = self.orientation(moved);
            if sign.is_ne() {
                return sign.is_gt();
            }
            names[last] = names[count - 1];
            places[last] = places[count - 1];
        }
        false
    }

    /// Which of some points comes last in the order of (x, y, z).
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
