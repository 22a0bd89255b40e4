//! Periodic boxes: sets of points that repeat along three vectors, or along one or two.

use std::cmp::Ordering;

use dashu_int::IBig;
use dashu_int::ops::DivEuclid;
use walpha_base::advice::{Advice, Advise, Setting, advice};
use walpha_base::parallel::prelude::*;
use walpha_base::shown::number;

use crate::number::{Number, cross, dot, integer, lowest_bit};

/// A box whose opposite faces are identified: a flat three-dimensional torus. A point stands for all its
/// copies, which are displaced by multiples of three vectors. The box is one along the axes, or the
/// parallelepiped of any three vectors.
///
/// Copies must be exact; otherwise ties between points and ties between their copies would be broken
/// differently. Vectors and coordinates are therefore rounded to multiples of a common
/// [`step`](Self::step), a power of two of at most 2⁻⁴⁹ times the longest side of the bounding box. Coordinates on a voxel
/// grid are unchanged. Every statement about a shape is exact for the rounded points, which the shape
/// lists.
///
/// Vectors are reduced ([`Self::of_vectors`]), so the copies that count are near: at most half of each vector
/// away, as measured along the three of them.
///
/// A box may repeat along one or two of its vectors only ([`Self::repeating`]): then a point has copies along these, space is not
/// closed along the others, and the others are 0. A part along a vector is measured perpendicular to what the vectors do not span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// Along the axes, if `is_box`.
    vectors: [[f64; 3]; 3],
    /// The rows of the inverse matrix, rounded: the scalar product with a way is about its part along a vector.
    inverse: [[f64; 3]; 3],
    step: f64,
    is_box: bool,
    /// Half of each side of a box along the axes; +∞ where it does not repeat.
    halves: [f64; 3],
}

/// Why a box cannot be periodic.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TorusError {
    /// A side is not a number between [`Torus::MIN_SIDE`] and [`Torus::MAX_SIDE`].
    #[error(
        "a periodic box has side {} along {axis}: it must be a positive number between {low:e} and {high:e}",
        number(*side),
        low = Torus::MIN_SIDE,
        high = Torus::MAX_SIDE
    )]
    Side {
        /// x, y or z.
        axis: char,
        /// The side.
        side: f64,
    },
    /// One side is far longer than another: rounding along the long side would be too coarse for the short side.
    #[error(
        "the sides of a periodic box go from {} to {}: none may be more than {} times another",
        number(*shortest),
        number(*longest),
        Torus::MAX_ASPECT_RATIO
    )]
    Elongated {
        /// The shortest side.
        shortest: f64,
        /// The longest side.
        longest: f64,
    },
    /// A vector has a component that is not a number, or is too long or too short.
    #[error(
        "vector {name} of a periodic box is {} long: its length must be between {low:e} and {high:e}",
        number(*length),
        low = Torus::MIN_SIDE,
        high = Torus::MAX_SIDE
    )]
    Vector {
        /// a, b or c.
        name: char,
        /// Its length.
        length: f64,
    },
    /// No vector repeats.
    #[error("none of the three vectors of a periodic box repeats")]
    Lone,
    /// Points are far from the origin along directions in which a slanted box does not repeat: rounding there would be too coarse.
    #[error(
        "a point is {} from the origin, and the longest vector of the periodic box is {}: copies along slanted vectors would be rounded",
        number(*reach),
        number(*longest)
    )]
    Far {
        /// The largest coordinate.
        reach: f64,
        /// The length of the longest vector.
        longest: f64,
    },
    /// The three vectors lie in one plane, or nearly.
    #[error(
        "the vectors of a periodic box span almost no volume: the longest is {} long, and the box is {} high",
        number(*longest),
        number(*height)
    )]
    Flat {
        /// The length of the longest vector.
        longest: f64,
        /// The smallest height of the box, rounded.
        height: f64,
    },
}

impl Advise for TorusError {
    fn advice(&self) -> Option<Advice> {
        Some(match self {
            Self::Side { .. } => {
                advice!["give ", Setting::Periodic, " three sides, in the unit of the points"]
            }
            Self::Elongated { .. } => "repeat the points along the shortest side".into(),
            Self::Vector { .. } => {
                advice!["give ", Setting::Periodic, " three vectors, in the unit of the points"]
            }
            Self::Flat { .. } => "give vectors that are independent of each other".into(),
            Self::Lone => {
                advice!["omit ", Setting::Periodic, ", or name a direction in which points repeat"]
            }
            Self::Far { .. } => "move the points near the origin".into(),
        })
    }
}

/// The names of the vectors of a box.
pub const VECTORS: [char; 3] = ['a', 'b', 'c'];

/// The names of the axes.
pub const AXES: [char; 3] = ['x', 'y', 'z'];

/// The vectors of a box along the axes.
const fn along_axes([x, y, z]: [f64; 3]) -> [[f64; 3]; 3] {
    [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]
}

/// A vector in units of the step.
type Steps = [i128; 3];

impl Torus {
    /// The shortest side accepted.
    pub const MIN_SIDE: f64 = 1e-100;
    /// The longest side accepted.
    pub const MAX_SIDE: f64 = 1e100;
    /// The largest ratio of the longest side to the shortest.
    pub const MAX_ASPECT_RATIO: f64 = 1000.0;

    /// The largest distance of points from the origin, in units of the longest vector, where a slanted box does not repeat.
    const MAX_REACH: f64 = 1e5;

    /// Bits that differences of coordinates of copies have beyond those of the longest side: copies are searched
    /// within one diagonal, at most √3 times that side, so all coordinates are below 4 times that side, and
    /// differences below 8 times. Of a slanted box, that side is the longest of its bounding box.
    const HEADROOM_BITS: i32 = 3;

    /// Parts along vectors that are farther than this from a half or a whole number are decided by doubles: reduced vectors are
    /// nearly orthogonal, so the error is a few roundings of a part that is at most 8 [`MAX_ASPECT_RATIO`](Self::MAX_ASPECT_RATIO).
    const PART_MARGIN: f64 = 1e-9;

    /// A box by its sides along x, y and z, in the unit of the points.
    ///
    /// # Errors
    /// A side out of range, or far longer than another; see [`TorusError`].
    pub fn new(sides: [f64; 3]) -> Result<Self, TorusError> {
        for (axis, side) in AXES.into_iter().zip(sides) {
            // NaN is outside every range.
            if !(Self::MIN_SIDE..=Self::MAX_SIDE).contains(&side) {
                return Err(TorusError::Side { axis, side });
            }
        }
        Self::of_sides(sides)
    }

    /// A box by its sides along the axes, 0 where it does not repeat.
    fn of_sides(sides: [f64; 3]) -> Result<Self, TorusError> {
        let repeating = || sides.into_iter().filter(|&side| side > 0.0);
        let shortest = repeating().fold(f64::INFINITY, f64::min);
        let longest = repeating().fold(0.0, f64::max);
        if longest > Self::MAX_ASPECT_RATIO * shortest {
            return Err(TorusError::Elongated { shortest, longest });
        }
        let step = step_of(longest);
        let vectors = along_axes(sides.map(|side| (side / step).round_ties_even() * step));
        Ok(Self::of_reduced(vectors, step, true))
    }

    /// A box by the three vectors along which points repeat, in the unit of the points. The vectors are rounded,
    /// by at most 2⁻⁴⁸ of the longest, and then reduced (Minkowski): each is replaced by a shorter one of the same lattice while
    /// there is one among its sums with the others and their differences. Vectors of a lattice along the axes give the box of [`Self::new`].
    ///
    /// # Errors
    /// Numbers out of range, or vectors that span almost no volume; see [`TorusError`].
    pub fn of_vectors(vectors: [[f64; 3]; 3]) -> Result<Self, TorusError> {
        Self::repeating(vectors, [true; 3])
    }

    /// Like [`Self::of_vectors`], for points that repeat along some of the vectors only. The others are ignored.
    ///
    /// # Errors
    /// No vector that repeats, numbers out of range, or vectors that nearly depend on each other; see [`TorusError`].
    pub fn repeating(vectors: [[f64; 3]; 3], repeats: [bool; 3]) -> Result<Self, TorusError> {
        if repeats == [false; 3] {
            return Err(TorusError::Lone);
        }
        let length = |v: &[f64; 3]| v[0].hypot(v[1]).hypot(v[2]);
        let vectors = [0, 1, 2].map(|k| if repeats[k] { vectors[k] } else { [0.0; 3] });
        for k in (0..3).filter(|&k| repeats[k]) {
            let (name, length) = (VECTORS[k], length(&vectors[k]));
            if !(Self::MIN_SIDE..=Self::MAX_SIDE).contains(&length) {
                return Err(TorusError::Vector { name, length });
            }
        }
        let longest = vectors.iter().map(length).fold(0.0, f64::max);
        let mut coarse = step_of(extent(&vectors));
        let (vectors, step) = loop {
            let steps = vectors.map(|v| v.map(|x| (x / coarse).round_ties_even() as i128));
            let vectors = reduced(steps, repeats).map(|v| v.map(|x| x as f64 * coarse));
            let step = step_of(extent(&vectors));
            if step <= coarse {
                break (vectors, step);
            }
            // Reduced vectors are shorter, and their bounding box may be larger all the same.
            coarse = step;
        };
        let inverse = inverse(&vectors, repeats, coarse);
        let heights = inverse.iter().zip(repeats).filter(|(_, repeats)| *repeats);
        // Vectors that depend on each other have none: rows are infinite or no numbers. `max` is 0 for these.
        let heights = heights.map(|(row, _)| (1.0 / length(row)).max(0.0));
        let height = heights.fold(f64::INFINITY, f64::min);
        if height * Self::MAX_ASPECT_RATIO < longest {
            return Err(TorusError::Flat { longest, height });
        }
        if let Some(sides) = sides_of(&vectors, repeats) {
            return Self::of_sides(sides);
        }
        Ok(Self::of_reduced(vectors, step, false))
    }

    fn of_reduced(vectors: [[f64; 3]; 3], step: f64, is_box: bool) -> Self {
        let inverse = inverse(&vectors, vectors.map(|v| v != [0.0; 3]), step);
        let half = |k: usize| match vectors[k][k] {
            side if is_box && side != 0.0 => side / 2.0,
            _ => f64::INFINITY,
        };
        Self { vectors, inverse, step, is_box, halves: [0, 1, 2].map(half) }
    }

    /// This box with a step that is coarse enough for copies of these positions to be exact. They matter only if the box is slanted
    /// and does not repeat along all vectors: otherwise all positions that are moved into the box are near.
    ///
    /// # Errors
    /// [`TorusError::Far`].
    pub fn holding(&self, positions: &[[f64; 3]]) -> Result<Self, TorusError> {
        let (reach, longest) = (self.reach(positions), extent(&self.vectors));
        if reach > Self::MAX_REACH * longest {
            return Err(TorusError::Far { reach, longest });
        }
        let step = step_of(longest + reach);
        if step <= self.step {
            return Ok(*self);
        }
        let vectors = self.vectors.map(|v| v.map(|x| (x / step).round_ties_even() * step));
        Ok(Self::of_reduced(vectors, step, self.is_box))
    }

    /// The largest coordinate of positions, moved into the box, along the axes along which copies differ: 0 where it is no larger than the box.
    fn reach(&self, positions: &[[f64; 3]]) -> f64 {
        if self.is_box || self.repeats() == [true; 3] {
            return 0.0;
        }
        let moves = self.moves();
        let of = |place: &[f64; 3]| {
            let parts = self.parts(*place).map(f64::floor);
            let near = |axis: usize| {
                place[axis] - (0..3).map(|k| parts[k] * self.vectors[k][axis]).sum::<f64>()
            };
            (0..3).filter(|&axis| moves[axis]).map(|axis| near(axis).abs()).fold(0.0, f64::max)
        };
        positions.par_iter().coarse().map(of).reduce(|| 0.0, f64::max)
    }

    /// This box and the box of several of its copies, as many along each vector as stated. The step of both is the larger one's, so
    /// that each point of the larger box is exactly a point of this one, moved by multiples of the vectors. Vectors are
    /// rounded to that step: by at most 2⁻⁵⁰ of the longest side of the larger bounding box. The step also [holds](Self::holding) the positions and
    /// their copies.
    ///
    /// # Panics
    /// If a number of copies is 0.
    pub fn covered(&self, copies: [u32; 3], positions: &[[f64; 3]]) -> [Self; 2] {
        assert!(!copies.contains(&0), "a box has at least one copy along each vector");
        let large = |vectors: [[f64; 3]; 3]| {
            [0, 1, 2].map(|k| vectors[k].map(|x| f64::from(copies[k]) * x))
        };
        let longest = large(self.vectors);
        let reach = self.reach(positions);
        // A copy is as far away as the larger box is long, and as its point is.
        let size = extent(&longest) + if reach > 0.0 { extent(&longest) + reach } else { 0.0 };
        // Rounding may lengthen the vectors to the next power of two.
        let step = step_of(size * (1.0 + f64::EPSILON)).max(self.step);
        let small = self.vectors.map(|v| v.map(|x| (x / step).round_ties_even() * step));
        [small, large(small)].map(|vectors| Self::of_reduced(vectors, step, self.is_box))
    }

    /// The three vectors; along x, y and z if the box is. Those along which it does not repeat are 0.
    pub fn vectors(&self) -> [[f64; 3]; 3] {
        self.vectors
    }

    /// Along which of its vectors the box repeats.
    #[inline]
    pub fn repeats(&self) -> [bool; 3] {
        self.vectors.map(|vector| vector != [0.0; 3])
    }

    /// The number of vectors along which the box repeats.
    pub fn dimension(&self) -> usize {
        self.repeats().into_iter().filter(|repeats| *repeats).count()
    }

    /// The axes along which vectors move a point. Coordinates along the others are as given, not rounded.
    fn moves(&self) -> [bool; 3] {
        [0, 1, 2].map(|axis| self.vectors.iter().any(|vector| vector[axis] != 0.0))
    }

    /// The sides along x, y and z, if the box is along the axes; 0 where it does not repeat.
    pub fn sides(&self) -> Option<[f64; 3]> {
        self.is_box.then(|| self.diagonal_components())
    }

    fn diagonal_components(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.vectors[k][k])
    }

    /// The lowest and the highest corner of the bounding box.
    pub fn extent(&self) -> [[f64; 3]; 2] {
        let sum = |k: usize, choose: fn(f64, f64) -> f64| {
            self.vectors.iter().map(|vector| choose(vector[k], 0.0)).sum::<f64>()
        };
        [[0, 1, 2].map(|k| sum(k, f64::min)), [0, 1, 2].map(|k| sum(k, f64::max))]
    }

    /// The power of two of which all coordinates and vectors are multiples.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The volume of the box; `None` if it does not repeat along all vectors.
    pub fn volume(&self) -> Option<f64> {
        let [a, b, c] = self.vectors;
        (self.repeats() == [true; 3]).then(|| dot(&a, &cross(&b, &c)).abs())
    }

    /// The height of the box over the vectors other than one, which repeats: how long a way along the vectors is at least whose part along
    /// that one is 1. Rounded.
    pub fn height(&self, k: usize) -> f64 {
        let [x, y, z] = self.inverse[k];
        1.0 / x.hypot(y).hypot(z)
    }

    /// The part of a way along each vector: the way is the sum of the vectors, each times its part, and of a way perpendicular to all of them.
    /// 0 along vectors that do not repeat. Rounded.
    pub fn parts(&self, way: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| dot(&self.inverse[k], &way))
    }

    /// A range of the part along a vector that repeats of the ways in a box from `low` to `high`. Rounded outward.
    pub fn part_range(&self, k: usize, low: [f64; 3], high: [f64; 3]) -> [f64; 2] {
        let mut range = [0.0; 2];
        for axis in 0..3 {
            let ends = [low[axis], high[axis]].map(|end| self.inverse[k][axis] * end);
            range[0] += ends[0].min(ends[1]);
            range[1] += ends[0].max(ends[1]);
        }
        [range[0] - Self::PART_MARGIN, range[1] + Self::PART_MARGIN]
    }

    /// The copy of a position in the box, rounded to the step. Its part along each vector is at least 0 and less than 1.
    pub fn wrap(&self, position: [f64; 3]) -> [f64; 3] {
        let mut position = position;
        for (x, moves) in position.iter_mut().zip(self.moves()) {
            let steps = *x / self.step;
            // Doubles of 2⁵² steps or more are multiples of the step already.
            if moves && steps.abs() < (1u64 << 52) as f64 {
                *x = steps.round_ties_even() * self.step;
            }
        }
        if !self.is_box {
            return if position.iter().all(|x| x.is_finite()) {
                self.wrap_exactly(position)
            } else {
                position
            };
        }
        for (x, side) in position.iter_mut().zip(self.diagonal_components()) {
            // Exact. −0 becomes 0.
            *x = if side == 0.0 { *x } else { x.rem_euclid(side) } + 0.0;
            if side != 0.0 && *x >= side {
                *x = 0.0;
            }
        }
        position
    }

    /// The copy in a slanted box of a position that is a multiple of the step.
    fn wrap_exactly(&self, position: [f64; 3]) -> [f64; 3] {
        let (parts, repeats, moves) = (self.parts(position), self.repeats(), self.moves());
        let clearly = |k: usize| {
            let terms: f64 =
                (0..3).map(|axis| (self.inverse[k][axis] * position[axis]).abs()).sum();
            terms < 1.0 / Self::PART_MARGIN
                && (parts[k] - parts[k].round()).abs() > Self::PART_MARGIN * (1.0 + terms)
        };
        let is_clearly_in_box =
            |k: usize| !repeats[k] || (clearly(k) && parts[k] > 0.0 && parts[k] < 1.0);
        if (0..3).all(is_clearly_in_box) {
            return position.map(|x| x + 0.0);
        }
        let unit = self.unit();
        let way = self.steps(&position);
        let vectors = self.vectors.map(|v| v.map(|x| integer(x, unit)));
        let whole = [0, 1, 2].map(|k| {
            if !repeats[k] {
                return IBig::ZERO;
            }
            if clearly(k) {
                return IBig::from(parts[k].floor() as i64);
            }
            let [part, volume] = part_of(&vectors, repeats, k, &way);
            part.div_euclid(volume)
        });
        let in_box = |axis: usize| {
            if !moves[axis] {
                return position[axis] + 0.0;
            }
            let moved = dot(&whole, &[0, 1, 2].map(|k| vectors[k][axis].clone()));
            let steps = i64::try_from(&way[axis] - moved).unwrap_or(i64::MAX);
            // Exact: positions in the box have at most 53 bits.
            steps as f64 * self.step
        };
        [in_box(0), in_box(1), in_box(2)]
    }

    /// A way in units of the step. Vectors have no part along an axis along which they do not move: 0 there.
    fn steps(&self, way: &[f64; 3]) -> [IBig; 3] {
        let (unit, moves) = (self.unit(), self.moves());
        [0, 1, 2].map(|axis| if moves[axis] { integer(way[axis], unit) } else { IBig::ZERO })
    }

    /// On which side of the plane of two vectors a way leads, if the box repeats along two: upwards, if the two vectors, in the order of
    /// their names beginning after the one that does not repeat, and the way are right-handed. Exact for multiples of the step.
    pub fn across(&self, way: [f64; 3]) -> Option<Ordering> {
        let out =
            self.repeats().iter().position(|repeats| !repeats).filter(|_| self.dimension() == 2)?;
        let [u, v] = [(out + 1) % 3, (out + 2) % 3].map(|k| self.vectors[k]);
        if let Some(axis) = self.moves().iter().position(|moves| !moves) {
            // Both vectors lie in the plane of the two other axes.
            let up = cross(&u.map(|x| x / self.step), &v.map(|x| x / self.step))[axis];
            return (up.signum() * way[axis]).partial_cmp(&0.0);
        }
        let unit = self.unit();
        let [u, v] = [u, v].map(|vector| vector.map(|x| integer(x, unit)));
        Some(dot(&cross(&u, &v), &self.steps(&way)).cmp(&IBig::ZERO))
    }

    /// The exponent of the step.
    fn unit(&self) -> i32 {
        lowest_bit(self.step).expect("the step is a power of two")
    }

    /// Whether a position is in the box: its part along each vector is at least 0 and less than 1.
    pub fn holds(&self, position: [f64; 3]) -> bool {
        if self.is_box {
            let mut sides = position.iter().zip(self.diagonal_components());
            return sides.all(|(x, side)| side == 0.0 || (0.0..side).contains(x));
        }
        let is_multiple = |(x, moves): (f64, bool)| !moves || (x / self.step).fract() == 0.0;
        let is_finite = position.iter().all(|x| x.is_finite());
        if is_finite && position.into_iter().zip(self.moves()).all(is_multiple) {
            self.wrap_exactly(position) == position
        } else {
            self.parts(position).iter().all(|part| (0.0..1.0).contains(part))
        }
    }

    /// The copy of `to` that is nearest to `from` along each vector, for two positions in the box; if two copies are equally near,
    /// `to` itself. Exact.
    #[inline]
    pub fn near(&self, from: [f64; 3], to: [f64; 3]) -> [f64; 3] {
        if self.is_box {
            let mut near = to;
            for k in 0..3 {
                let side = self.vectors[k][k];
                near[k] -= f64::from(beyond_half(to[k] - from[k], self.halves[k])) * side;
            }
            return near;
        }
        self.moved(to, self.windings(from, to))
    }

    /// The number of times the way from one position in the box to the nearest copy of another crosses its faces: for each
    /// vector, the multiple of it by which that copy differs from `to`.
    #[inline]
    pub fn windings(&self, from: [f64; 3], to: [f64; 3]) -> [i32; 3] {
        let way = [0, 1, 2].map(|k| to[k] - from[k]);
        if self.is_box {
            return [0, 1, 2].map(|k| -beyond_half(way[k], self.halves[k]));
        }
        [0, 1, 2].map(|k| {
            let part = dot(&self.inverse[k], &way);
            // Two copies are equally near if the part is a half: `to` itself stays.
            if self.compare_with_half(k, &way, part).is_gt() { -(part.signum() as i32) } else { 0 }
        })
    }

    /// Whether the way between two positions spans less than half of each vector, so that they are the nearest copies of their
    /// points. Exact for multiples of the step.
    pub fn are_near(&self, from: [f64; 3], to: [f64; 3]) -> bool {
        let way = [0, 1, 2].map(|k| to[k] - from[k]);
        if self.is_box {
            return (0..3).all(|k| way[k].abs() < self.halves[k]);
        }
        let parts = self.parts(way);
        (0..3).all(|k| self.compare_with_half(k, &way, parts[k]).is_lt())
    }

    /// Compares the magnitude of the part of a way along a vector, which is known about, with a half. Exact.
    #[inline(always)]
    fn compare_with_half(&self, k: usize, way: &[f64; 3], part: f64) -> Ordering {
        let beyond = part.abs() - 0.5;
        if beyond.abs() > Self::PART_MARGIN {
            return if beyond > 0.0 { Ordering::Greater } else { Ordering::Less };
        }
        self.compare_exactly(k, way)
    }

    #[cold]
    fn compare_exactly(&self, k: usize, way: &[f64; 3]) -> Ordering {
        let unit = self.unit();
        let vectors = self.vectors.map(|v| v.map(|x| integer(x, unit)));
        let [part, volume] = part_of(&vectors, self.repeats(), k, &self.steps(way));
        let magnitude = if part < IBig::ZERO { -part } else { part };
        (magnitude << 1).cmp(&volume)
    }

    /// A position moved by multiples of the vectors. Exact for positions near the box.
    #[inline]
    pub fn moved(&self, position: [f64; 3], windings: [i32; 3]) -> [f64; 3] {
        let times = windings.map(f64::from);
        if self.is_box {
            return [0, 1, 2].map(|k| position[k] + times[k] * self.vectors[k][k]);
        }
        let [a, b, c] = self.vectors;
        [0, 1, 2].map(|k| position[k] + (times[0] * a[k] + times[1] * b[k] + times[2] * c[k]))
    }

    /// The corners of a simplex: the first one, and for each other corner the copy nearest to it.
    #[inline]
    pub fn together<const N: usize>(&self, mut corners: [[f64; 3]; N]) -> [[f64; 3]; N] {
        let first = corners[0];
        corners.iter_mut().skip(1).for_each(|corner| *corner = self.near(first, *corner));
        corners
    }

    /// An upper bound of the length of the longest diagonal, larger by about 10⁻¹⁵ of it. No place is farther than half of it from
    /// all copies of a point.
    pub fn diagonal(&self) -> f64 {
        let [a, b, c] = self.vectors;
        let squared = |[v, w]: [f64; 2]| {
            let diagonal = [0, 1, 2].map(|k| a[k] + v * b[k] + w * c[k]);
            dot(&diagonal, &diagonal)
        };
        let ways = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        ways.map(squared).into_iter().fold(0.0, f64::max).sqrt() * (1.0 + 1e-15)
    }
}

/// The multiple of a side by which a way along an axis is to be shortened: 1 or −1 beyond half of the side, else 0.
#[inline(always)]
fn beyond_half(way: f64, half: f64) -> i32 {
    i32::from(way > half) - i32::from(way < -half)
}

/// The step of coordinates in a box that is `longest` along an axis.
fn step_of(longest: f64) -> f64 {
    let above = 2f64.powi(longest.log2().floor() as i32 + 1);
    above * 2f64.powi(Torus::HEADROOM_BITS - f64::MANTISSA_DIGITS as i32)
}

/// The longest side of the bounding box of three vectors.
fn extent(vectors: &[[f64; 3]; 3]) -> f64 {
    (0..3).map(|k| vectors.iter().map(|vector| vector[k].abs()).sum()).fold(0.0, f64::max)
}

/// The normal of the other vectors that repeat, in the span of all of them: a scalar product with it, divided by that of vector `k`, is the
/// part of a way along the vector. That of the vector itself is not negative unless there are three.
fn normal<T: Number + Clone>(vectors: &[[T; 3]; 3], repeats: [bool; 3], k: usize) -> [T; 3] {
    let [i, j] = [(k + 1) % 3, (k + 2) % 3];
    let other = match [repeats[i], repeats[j]] {
        [true, true] => return cross(&vectors[i], &vectors[j]),
        [false, false] => return vectors[k].clone(),
        [true, false] => i,
        [false, true] => j,
    };
    cross(&vectors[other], &cross(&vectors[k], &vectors[other]))
}

/// The rows of the inverse matrix of vectors that are multiples of a step, a power of two: those of the vectors that do not repeat are 0.
fn inverse(vectors: &[[f64; 3]; 3], repeats: [bool; 3], step: f64) -> [[f64; 3]; 3] {
    // So that products stay within the range of doubles.
    let vectors = vectors.map(|v| v.map(|x| x / step));
    [0, 1, 2].map(|k| {
        if !repeats[k] {
            return [0.0; 3];
        }
        let normal = normal(&vectors, repeats, k);
        let volume = dot(&vectors[k], &normal);
        normal.map(|x| x / volume / step)
    })
}

/// The part of a way along vector `k`, which repeats, times a positive number, and that number: of three vectors, the volume of the box.
fn part_of(vectors: &[[IBig; 3]; 3], repeats: [bool; 3], k: usize, way: &[IBig; 3]) -> [IBig; 2] {
    let normal = normal(vectors, repeats, k);
    let [part, volume] = [way, &vectors[k]].map(|of| dot(of, &normal));
    if volume < IBig::ZERO { [-part, -volume] } else { [part, volume] }
}

/// Sides along x, y and z, if each vector that repeats is along another axis; 0 along those of none.
fn sides_of(vectors: &[[f64; 3]; 3], repeats: [bool; 3]) -> Option<[f64; 3]> {
    let mut sides = [0.0; 3];
    for (vector, _) in vectors.iter().zip(repeats).filter(|(_, repeats)| *repeats) {
        let axis = (0..3).find(|&k| vector[k] != 0.0)?;
        if vector[axis + 1..].iter().any(|x| *x != 0.0) || sides[axis] != 0.0 {
            return None;
        }
        sides[axis] = vector[axis].abs();
    }
    Some(sides)
}

/// A Minkowski-reduced basis of the lattice of the vectors that repeat: no vector is longer than its sum with another two, each of them
/// added, subtracted or left out (which suffices in three dimensions). Vectors that are reduced already stay as they are.
fn reduced(mut vectors: [Steps; 3], repeats: [bool; 3]) -> [Steps; 3] {
    let dot = |u: &Steps, v: &Steps| (0..3).map(|k| u[k] * v[k]).sum::<i128>();
    let with = |u: &Steps, n: i128, v: &Steps| [0, 1, 2].map(|k| u[k] + n * v[k]);
    loop {
        let mut shorter = false;
        for i in (0..3).filter(|&i| repeats[i]) {
            let [j, k] = [(i + 1) % 3, (i + 2) % 3];
            let mut best = vectors[i];
            // A whole multiple of one other vector, which takes long steps, then sums with both.
            for other in [j, k].into_iter().filter(|&other| repeats[other]) {
                let square = dot(&vectors[other], &vectors[other]);
                if square == 0 {
                    return vectors;
                }
                let times = (2 * dot(&best, &vectors[other]) + square).div_euclid(2 * square);
                let tried = with(&best, -times, &vectors[other]);
                if dot(&tried, &tried) < dot(&best, &best) {
                    best = tried;
                }
            }
            for [n, m] in [[1, 1], [1, -1], [-1, 1], [-1, -1]] {
                let tried = with(&with(&best, n, &vectors[j]), m, &vectors[k]);
                if dot(&tried, &tried) < dot(&best, &best) {
                    best = tried;
                }
            }
            shorter |= best != vectors[i];
            vectors[i] = best;
        }
        if !shorter {
            return vectors;
        }
    }
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;

    #[test]
    fn reduced_vectors_are_multiples_of_the_step() {
        let mut random = Random::new(5);
        let mut coarser = 0;
        for k in 0..2000 {
            // Hexagonal boxes, whose reduced vectors may have a larger bounding box, and any.
            let a = 1.0 + f64::from(k) * 0.01;
            let vectors = match k % 3 {
                0 => [[a, 0.0, 0.0], [-a / 2.0, a * 0.75f64.sqrt(), 0.0], [0.0, 0.0, 1.2 * a]],
                1 => [[a, 0.0, 0.0], [a / 2.0, a * 0.75f64.sqrt(), 0.0], [0.0, 0.0, 1.2 * a]],
                _ => [[0; 3]; 3].map(|v| v.map(|_| 2.0 * random.unit() - 1.0)),
            };
            let Ok(torus) = Torus::of_vectors(vectors) else { continue };
            let is_multiple = |x: &f64| (x / torus.step).fract() == 0.0;
            assert!(torus.vectors.as_flattened().iter().all(is_multiple), "{vectors:?}");
            coarser += u32::from(torus.step > step_of(extent(&vectors)));
            // What is read again is the same box.
            assert_eq!(Torus::of_vectors(torus.vectors).unwrap().vectors, torus.vectors);
            let place = torus.wrap([0.0; 3].map(|_: f64| 100.0 * a * (random.unit() - 0.5)));
            assert_eq!(torus.wrap(place), place);
        }
        assert!(coarser > 20, "{coarser}");
    }

    #[test]
    fn places_are_wrapped_exactly() {
        let torus = Torus::new([4.0, 5.0, 6.0]).unwrap();
        assert_eq!(torus.sides(), Some([4.0, 5.0, 6.0]));
        assert_eq!(torus.wrap([4.0, -1.0, 17.5]), [0.0, 4.0, 5.5]);
        assert_eq!(torus.wrap([-1e-30, 5.0 - 1e-30, 0.25]), [0.0, 0.0, 0.25]);
        assert_eq!(torus.wrap([-0.0, 0.0, 1e300])[0].to_bits(), 0);
        assert_eq!(torus.near([0.5, 0.5, 0.5], [3.5, 2.5, 3.5]), [-0.5, 2.5, 3.5]);
        assert_eq!(torus.windings([0.5, 0.5, 0.5], [3.5, 4.5, 3.5]), [-1, -1, 0]);
    }

    #[test]
    fn copies_of_any_place_are_exact() {
        let torus = Torus::new([0.1, 0.3, 7.7]).unwrap();
        let place = torus.wrap([0.07, 0.123456789, 3.3]);
        assert_eq!(torus.wrap(place), place);
        for windings in [[1, -1, 1], [-3, 2, -1], [60, -20, 1]] {
            let moved = torus.moved(place, windings);
            let back = torus.moved(moved, windings.map(|w| -w));
            assert_eq!((back, torus.wrap(moved)), (place, place));
        }
    }

    /// The lattice of face-centred cubes, by its primitive vectors.
    const FCC: [[f64; 3]; 3] = [[0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]];

    #[test]
    fn vectors_are_reduced() {
        let torus = Torus::of_vectors(FCC).unwrap();
        assert_eq!((torus.vectors(), torus.sides(), torus.volume()), (FCC, None, Some(0.25)));
        // A long basis of the same lattice.
        let [a, b, c] = FCC;
        let sum = |u: [f64; 3], n: f64, v: [f64; 3]| [0, 1, 2].map(|k| u[k] + n * v[k]);
        let long = [sum(sum(a, 7.0, b), -3.0, c), sum(b, 11.0, c), c];
        let reduced = Torus::of_vectors(long).unwrap();
        assert_eq!(reduced.volume(), Some(0.25));
        for [x, y, z] in reduced.vectors() {
            assert_eq!(x * x + y * y + z * z, 0.5);
        }
        // A box, askew and out of order.
        let askew = [[0.0, 5.0, 0.0], [4.0, 15.0, 0.0], [8.0, -5.0, -6.0]];
        assert_eq!(Torus::of_vectors(askew).unwrap(), Torus::new([4.0, 5.0, 6.0]).unwrap());
    }

    /// Reduced vectors are moved into the box, and nearest copies found, as by integers.
    #[test]
    fn copies_in_slanted_boxes_are_exact() {
        let random = &mut Random::new(3);
        let mut halves = 0;
        for round in 0..200 {
            // Some on a coarse lattice, where ways of half a vector are common.
            let fine = if round % 2 == 0 { 0.0 } else { 2f64.powi(-40) };
            let mut number = |most: usize| (random.below(2 * most + 1) as f64) - most as f64;
            let mut vector = || [0; 3].map(|_| number(6) + fine * number(1000));
            let Ok(torus) = Torus::of_vectors([vector(), vector(), vector()]) else { continue };
            if torus.sides().is_some() {
                continue;
            }
            let mut place = || torus.wrap(vector());
            for _ in 0..50 {
                let [p, q] = [place(), place()];
                for place in [p, q] {
                    assert!(torus.holds(place) && torus.wrap(place) == place);
                    let moved = torus.moved(place, [2, -1, 1]);
                    assert_eq!(torus.wrap(moved), place);
                    assert!(!torus.holds(moved));
                }
                let unit = torus.unit();
                let vectors = torus.vectors().map(|v| v.map(|x| integer(x, unit)));
                let way = [0, 1, 2].map(|k| integer(q[k], unit) - integer(p[k], unit));
                let expected = [0, 1, 2].map(|k| {
                    let [part, volume] = part_of(&vectors, [true; 3], k, &way);
                    halves += u32::from(&part + &part == volume || &part + &part == -&volume);
                    i32::from(-(&part << 1) > volume) - i32::from(part << 1 > volume)
                });
                assert_eq!(torus.windings(p, q), expected);
                let near = torus.near(p, q);
                assert_eq!(near, torus.moved(q, expected));
                assert!(torus.windings(p, near) == [0; 3]);
            }
        }
        assert!(halves > 100, "{halves}");
    }

    #[test]
    fn far_positions_are_moved_into_a_slanted_box() {
        let torus = Torus::of_vectors(FCC).unwrap();
        for far in [[1e300, 2.5, -7.25], [1e18, -1e20, 3.0], [-0.0, -0.0, 0.0]] {
            let place = torus.wrap(far);
            assert!(torus.holds(place), "{far:?} {place:?}");
            assert!(place.iter().all(|x| x.to_bits() != (-0.0f64).to_bits()));
        }
        assert!(torus.wrap([f64::NAN, 0.0, 0.0])[0].is_nan());
    }

    #[test]
    fn bad_vectors_are_refused() {
        let of = |vectors| Torus::of_vectors(vectors).unwrap_err();
        let [a, b, c] = FCC;
        assert!(matches!(of([a, [f64::NAN; 3], c]), TorusError::Vector { name: 'b', .. }));
        assert!(matches!(of([a, b, [0.0; 3]]), TorusError::Vector { name: 'c', .. }));
        let sum = [0, 1, 2].map(|k| a[k] - 2.0 * b[k]);
        assert!(matches!(of([a, b, sum]), TorusError::Flat { height: 0.0, .. }));
        assert!(matches!(of([a, b, [0.5, 0.5, 1.0 - 1e-4]]), TorusError::Flat { .. }));
        // The smallest and the largest vectors.
        for scale in [1e-99, 1e99] {
            let torus = Torus::of_vectors(FCC.map(|v| v.map(|x| scale * x))).unwrap();
            assert!(torus.holds(torus.wrap([scale, 0.1 * scale, -0.3 * scale])));
        }
    }

    /// A lattice in a plane and on a line, along the axes and not, with parts that are measured perpendicular to the rest.
    #[test]
    fn boxes_repeat_along_some_vectors() {
        let slab = Torus::repeating(
            [[4.0, 0.0, 0.0], [9.0, 9.0, 9.0], [0.0, 0.0, 2.0]],
            [true, false, true],
        );
        let slab = slab.unwrap();
        assert_eq!((slab.sides(), slab.volume()), (Some([4.0, 0.0, 2.0]), None));
        assert_eq!((slab.repeats(), slab.dimension()), ([true, false, true], 2));
        // What does not repeat is not rounded.
        assert_eq!(slab.wrap([5.0, -7e300, -0.5]), [1.0, -7e300, 1.5]);
        assert_eq!(slab.windings([0.0, 0.0, 0.0], [3.0, 1e9, 0.75]), [-1, 0, 0]);
        assert_eq!(slab.near([0.0; 3], [3.0, 1e9, 0.75]), [-1.0, 1e9, 0.75]);
        assert!(
            slab.are_near([0.0; 3], [1.5, 50.0, 0.5]) && !slab.are_near([0.0; 3], [2.0, 0.0, 0.5])
        );
        assert!(slab.holds([3.0, -1e200, 1.0]) && !slab.holds([3.0, 0.0, 2.0]));
        // z, x and up are right-handed.
        assert_eq!(slab.across([1.0, 1e-300, 0.0]), Some(Ordering::Greater));
        assert_eq!(slab.across([1.0, 0.0, 0.0]), Some(Ordering::Equal));

        // A long basis of hexagons in a tilted plane; whatever is perpendicular to it has no part.
        let [a, b] = [[1.0, -1.0, 0.0], [0.0, 1.0, -1.0]];
        let long = [[0.0; 3], [0, 1, 2].map(|k| a[k] + 5.0 * b[k]), b];
        let tilted = Torus::repeating(long, [false, true, true]).unwrap();
        let tilted = tilted.holding(&[[70.0, 70.0, 70.0]]).unwrap();
        assert_eq!((tilted.vectors()[0], tilted.dimension(), tilted.sides()), ([0.0; 3], 2, None));
        let squares = tilted.vectors().map(|v| dot(&v, &v));
        assert_eq!(squares, [0.0, 2.0, 2.0]);
        let far = [70.25, 69.5, 70.5];
        let place = tilted.wrap(far);
        assert!(tilted.holds(place) && (place[0] + place[1] + place[2] - 210.25).abs() == 0.0);
        for by in [[0, 3, -2], [0, -1, 1]] {
            let moved = tilted.moved(place, by);
            assert_eq!(tilted.wrap(moved), place);
        }
        // What is rounded once stays.
        let places = [[70.0, 70.0, 70.0]];
        let [small, large] = tilted.covered([1, 3, 40], &places);
        assert!(small.step() == large.step() && large.step() > tilted.step());
        assert_eq!(small.covered([1, 3, 40], &places), [small, large]);
        assert_eq!(small.holding(&places).unwrap(), small);
        let copies = [small.moved(places[0], [0, 2, 39])];
        assert_eq!(large.holding(&copies).unwrap(), large);
        let [_, u, v] = tilted.vectors();
        let up = cross(&u, &v);
        assert_eq!(tilted.across(up), Some(Ordering::Greater));
        assert_eq!(tilted.across(a), Some(Ordering::Equal));
        assert_eq!(tilted.across(up.map(|x| -x)), Some(Ordering::Less));
        assert!(matches!(tilted.holding(&[[1e7, 1e7, 1e7]]), Err(TorusError::Far { .. })));
        // Along the plane, points are near wherever they are.
        assert_eq!(tilted.holding(&[[1e7, -1e7, 0.0]]).unwrap(), tilted);

        let rod =
            Torus::repeating([[1.0, 2.0, 2.0], [0.0; 3], [0.0; 3]], [true, false, false]).unwrap();
        assert_eq!((rod.dimension(), rod.across([1.0, 0.0, 0.0])), (1, None));
        // Four ninths and five ninths of the vector along it.
        assert_eq!(rod.windings([0.0; 3], [0.0, 2.0, 0.0]), [0; 3]);
        assert_eq!(rod.windings([0.0; 3], [0.0, 2.0, 0.5]), [-1, 0, 0]);
        // A half stays.
        assert_eq!(rod.windings([0.0; 3], [0.5, 2.0, 0.0]), [0; 3]);
        assert!(!rod.are_near([0.0; 3], [0.5, 2.0, 0.0]));
        assert_eq!(rod.wrap([-0.5, -2.0, 0.0]), [0.5, 0.0, 2.0]);
        assert!(matches!(Torus::repeating([[1.0; 3]; 3], [false; 3]), Err(TorusError::Lone)));
        let parallel = Torus::repeating([a, a, b], [true, true, false]);
        assert!(matches!(parallel, Err(TorusError::Flat { height: 0.0, .. })));
    }

    /// Far away, doubles do not tell on which side of a boundary a position is.
    #[test]
    fn far_positions_near_a_boundary_are_moved_into_the_box() {
        let torus = Torus::of_vectors([[1.0, 0.0, 0.0], [0.0, 1.0, 0.3], [0.1, 0.0, 1.0]]).unwrap();
        for steps in [-3, -1, 0, 1, 3] {
            for far in [1 << 20, 1 << 30] {
                let near = f64::from(steps) * torus.step();
                let place = torus.moved([near, 0.0, 0.0], [0, far, 1 - far]);
                let wrapped = torus.wrap(place);
                assert!(torus.holds(wrapped), "{steps} {far} {wrapped:?}");
            }
        }
    }

    #[test]
    fn bad_boxes_are_refused() {
        for side in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e200] {
            let error = Torus::new([1.0, side, 1.0]).unwrap_err();
            assert!(matches!(error, TorusError::Side { axis: 'y', .. }), "{error}");
        }
        assert!(matches!(Torus::new([1.0, 1.0, 1001.0]), Err(TorusError::Elongated { .. })));
        let tiny = Torus::new([1e-300, 1.0, 1.0]).unwrap_err().to_string();
        assert!(tiny.contains("side 1e-300 along x"), "{tiny}");
    }
}
