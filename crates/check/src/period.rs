//! The copies of points in a periodic box.

use std::cmp::Ordering;

use crate::exact::{Lattice, collinear, compare_part, orientation};
use crate::schema::BoxVectors;

/// The vectors along which the points of a torus repeat. A way is the sum of the vectors, each times its *part*; comparisons of
/// parts are exact for points whose copies are exact. Vectors along which points do not repeat are 0: a way may also lead out of the span of the
/// others, perpendicular to it.
#[derive(Clone, Copy)]
pub(crate) struct Period {
    vectors: [[f64; 3]; 3],
    /// The sign of the determinant of the vectors.
    sign: Ordering,
    /// Along which vectors points repeat.
    repeats: [bool; 3],
    /// The sides, if the box is along the axes.
    sides: Option<[f64; 3]>,
}

impl Period {
    pub(crate) fn new(vectors: BoxVectors) -> Self {
        let [a, b, c] = vectors.0;
        Self {
            vectors: vectors.0,
            sign: orientation([0.0; 3], a, b, c),
            repeats: vectors.0.map(|vector| vector != [0.0; 3]),
            sides: vectors.sides(),
        }
    }

    /// Along which vectors points repeat.
    pub(crate) fn repeats(&self) -> [bool; 3] {
        self.repeats
    }

    /// The vectors along which points repeat.
    pub(crate) fn repeating(&self) -> Vec<[f64; 3]> {
        self.vectors.into_iter().filter(|vector| *vector != [0.0; 3]).collect()
    }

    fn along(&self) -> impl Iterator<Item = usize> + use<> {
        let repeats = self.repeats;
        (0..3).filter(move |&k| repeats[k])
    }

    /// Whether the vectors are finite and those along which points repeat independent of each other, and there are some; and, if they are along the
    /// axes, whether no side is negative.
    pub(crate) fn is_sound(vectors: BoxVectors) -> bool {
        if !vectors.0.as_flattened().iter().all(|x| x.is_finite()) {
            return false;
        }
        let period = Self::new(vectors);
        let independent = match period.repeating()[..] {
            [] => false,
            [_] => true,
            [u, v] => !collinear([0.0; 3], u, v),
            _ => period.sign.is_ne(),
        };
        independent && vectors.sides().is_none_or(|sides| sides.iter().all(|side| *side >= 0.0))
    }

    /// Compares the part of a way along a vector with `halves` halves.
    fn compare(&self, k: usize, way: [f64; 3], halves: f64) -> Ordering {
        if let Some(sides) = self.sides {
            return (2.0 * way[k]).total_cmp(&(halves * sides[k] + 0.0));
        }
        if self.repeats != [true; 3] {
            return compare_part(self.vectors, k, way, halves as i32);
        }
        let [u, v] = [(k + 1) % 3, (k + 2) % 3].map(|other| self.vectors[other]);
        let beyond = [0, 1, 2].map(|axis| 2.0 * way[axis] - halves * self.vectors[k][axis]);
        let side = orientation([0.0; 3], beyond, u, v);
        if self.sign.is_gt() { side } else { side.reverse() }
    }

    /// The multiples of the vectors that move `to` to its copy nearest to `from`.
    pub(crate) fn nearest_copy(&self, from: [f64; 3], to: [f64; 3]) -> [i32; 3] {
        let way = [0, 1, 2].map(|axis| to[axis] - from[axis]);
        [0, 1, 2].map(|k| {
            if !self.repeats[k] {
                return 0;
            }
            let before = self.compare(k, way, -1.0).is_lt();
            let beyond = self.compare(k, way, 1.0).is_gt();
            i32::from(before) - i32::from(beyond)
        })
    }

    /// Whether the way to the nearest copy spans half of a vector or more.
    pub(crate) fn is_long(&self, from: [f64; 3], to: [f64; 3]) -> bool {
        let to = self.moved(to, self.nearest_copy(from, to));
        let way = [0, 1, 2].map(|axis| to[axis] - from[axis]);
        self.along()
            .any(|k| !(self.compare(k, way, -1.0).is_gt() && self.compare(k, way, 1.0).is_lt()))
    }

    /// Raises the numbers of copies of the box until the way between two places spans less than half of them, or until one is above `most`.
    pub(crate) fn lengthen(&self, times: &mut [i32; 3], from: [f64; 3], to: [f64; 3], most: i32) {
        let way = [0, 1, 2].map(|axis| to[axis] - from[axis]);
        for (k, times) in times.iter_mut().enumerate().filter(|&(k, _)| self.repeats[k]) {
            let is_long = |times: i32| {
                self.compare(k, way, f64::from(times)).is_ge()
                    || self.compare(k, way, -f64::from(times)).is_le()
            };
            while *times <= most && is_long(*times) {
                *times += 1;
            }
        }
    }

    /// Whether a position is in the box, and its nearby copies are exact.
    pub(crate) fn holds(&self, position: [f64; 3]) -> bool {
        if position.iter().any(|x| !x.is_finite()) {
            return false;
        }
        // Copies differ along these axes only.
        let moves = |axis: usize| self.vectors.iter().any(|vector| vector[axis] != 0.0);
        let moved = |axis: usize| if moves(axis) { position[axis] } else { 0.0 };
        let position = [0, 1, 2].map(moved);
        let numbers = [position, self.vectors[0], self.vectors[1], self.vectors[2]];
        // Sums of a position and four times each vector, in units of the lowest bit.
        let magnitude = |axis: usize| {
            let along: f64 = self.vectors.iter().map(|vector| vector[axis].abs()).sum();
            position[axis].abs() + 4.0 * along
        };
        let largest = (0..3).map(magnitude).fold(0.0, f64::max);
        let is_exact = largest < 2f64.powi(Lattice::through(numbers).exponent() + 53);
        let in_box = |k: usize| {
            self.compare(k, position, 0.0).is_ge() && self.compare(k, position, 2.0).is_lt()
        };
        is_exact && self.along().all(in_box)
    }

    /// A position moved by multiples of the vectors.
    pub(crate) fn moved(&self, position: [f64; 3], by: [i32; 3]) -> [f64; 3] {
        let by = by.map(f64::from);
        let [a, b, c] = self.vectors;
        [0, 1, 2].map(|axis| position[axis] + (by[0] * a[axis] + by[1] * b[axis] + by[2] * c[axis]))
    }

    /// Half of the longest diagonal, rounded up: no place is farther from all copies of a point, as measured along the vectors.
    pub(crate) fn reach(&self) -> f64 {
        let diagonals = [[1, 1, 1], [1, 1, -1], [1, -1, 1], [1, -1, -1]];
        let lengths = diagonals.map(|by| {
            let [x, y, z] = self.moved([0.0; 3], by);
            x.hypot(y).hypot(z)
        });
        0.5001 * lengths.into_iter().fold(0.0, f64::max)
    }

    /// The corners of the box, whose bits are the vectors: of a right-handed box, in the order of the vectors.
    pub(crate) fn corners(&self) -> [[f64; 3]; 8] {
        [0, 1, 2, 3, 4, 5, 6, 7].map(|corner: i32| {
            let mut by = [corner & 1, corner >> 1 & 1, corner >> 2 & 1];
            if self.sign.is_lt() {
                by.swap(1, 2);
            }
            self.moved([0.0; 3], by)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lattice of hexagons, one layer above the other, left-handed.
    fn slanted() -> Period {
        Period::new(BoxVectors([[4.0, 0.0, 0.0], [0.0, 0.0, 8.0], [-2.0, 3.5, 0.0]]))
    }

    #[test]
    fn copies_are_nearest_by_parts() {
        let period = slanted();
        assert!(period.sign.is_lt());
        // The way has parts −¾, ½ and ¾; a half stays.
        let to = [-4.5, 2.625, 4.0];
        assert_eq!(period.nearest_copy([0.0; 3], to), [1, 0, -1]);
        assert!(period.is_long([0.0; 3], to));
        assert!(!period.is_long([0.0; 3], [-4.5, 2.625, 3.75]));
    }

    /// Along a vector alone, and along two, parts are measured perpendicular to the rest.
    #[test]
    fn boxes_repeat_along_some_vectors() {
        let rod = Period::new(BoxVectors([[0.0; 3], [1.0, 2.0, 2.0], [0.0; 3]]));
        assert!(Period::is_sound(BoxVectors(rod.vectors)));
        assert_eq!(rod.nearest_copy([0.0; 3], [0.0, 2.0, 0.0]), [0; 3]);
        assert_eq!(rod.nearest_copy([0.0; 3], [0.0, 2.0, 0.5]), [0, -1, 0]);
        assert!(rod.is_long([0.0; 3], [0.5, 2.0, 0.0]));
        assert!(rod.holds([8.0, -4.0, 0.5]) && !rod.holds([8.0, -4.0, -0.5]));
        let slab = Period::new(BoxVectors([[1.0, -1.0, 0.0], [0.0; 3], [0.0, 1.0, -1.0]]));
        // Two thirds and one third of the vectors, and what is perpendicular to them.
        let way = [1.0, 0.0, 0.0];
        assert_eq!(slab.nearest_copy([0.0; 3], way), [-1, 0, 0]);
        let moved = way.map(|x| x + 50.0);
        assert_eq!(slab.nearest_copy([0.0; 3], moved), [-1, 0, 0]);
        let sheet = Period::new(BoxVectors::of_sides([4.0, 0.0, 2.0]));
        assert!(sheet.holds([3.0, 1e-200, 1.0]) && !sheet.holds([3.0, 0.0, 2.0]));
    }

    #[test]
    fn positions_are_in_the_box_if_their_parts_are() {
        let period = slanted();
        assert!(period.holds([-1.0, 1.75, 0.0]) && period.holds([0.0; 3]));
        assert!(!period.holds([-2.0, 1.75, 0.0]) && !period.holds([-2.0, 3.5, 0.0]));
        assert!(!period.holds([f64::NAN, 0.0, 0.0]));
        // Its copies would be rounded.
        assert!(!period.holds([1e-15, 0.0, 0.0]));
        assert!(!Period::is_sound(BoxVectors([[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 1.0]])));
        assert!(!Period::is_sound(BoxVectors::of_sides([1.0, -1.0, 1.0])));
        assert!(!Period::is_sound(BoxVectors::of_sides([0.0; 3])));
        assert!(!Period::is_sound(BoxVectors([[1.0, 2.0, 0.0], [2.0, 4.0, 0.0], [0.0; 3]])));
        assert!(Period::is_sound(BoxVectors::of_sides([1.0, 2.0, 1.0])));
    }
}
