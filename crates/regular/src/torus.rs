//! Periodic boxes: sets of points that repeat along the axes.

use walpha_base::advice::{Advice, Advise, Setting, advice};

/// A box whose opposite faces are identified: a flat three-dimensional torus. A point stands for all its
/// copies, which are displaced along the axes by multiples of the sides.
///
/// Copies must be exact; otherwise ties between points and ties between their copies would be broken
/// differently. Sides and coordinates are therefore rounded to multiples of a common
/// [`step`](Self::step), a power of two below 2⁻⁴⁹ times the diagonal. Coordinates on a voxel grid are
/// unchanged. Every statement about a shape is exact for the rounded points, which the shape lists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    sides: [f64; 3],
    step: f64,
}

/// Why a box cannot be periodic.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TorusError {
    /// A side is not a number between [`Torus::MIN_SIDE`] and [`Torus::MAX_SIDE`].
    #[error(
        "a periodic box has side {side} along {axis}: it must be a positive number between {low:e} and {high:e}",
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
        "the sides of a periodic box go from {shortest} to {longest}: none may be more than {} times another",
        Torus::MAX_ASPECT_RATIO
    )]
    Elongated {
        /// The shortest side.
        shortest: f64,
        /// The longest side.
        longest: f64,
    },
}

impl Advise for TorusError {
    fn advice(&self) -> Option<Advice> {
        Some(match self {
            Self::Side { .. } => {
                advice!["give ", Setting::Periodic, " three sides, in the unit of the points"]
            }
            Self::Elongated { .. } => "repeat the points along the shortest side".into(),
        })
    }
}

/// The names of the axes.
pub const AXES: [char; 3] = ['x', 'y', 'z'];

impl Torus {
    /// The shortest side accepted.
    pub const MIN_SIDE: f64 = 1e-100;
    /// The longest side accepted.
    pub const MAX_SIDE: f64 = 1e100;
    /// The largest ratio of the longest side to the shortest.
    pub const MAX_ASPECT_RATIO: f64 = 1000.0;

    /// Bits that differences of coordinates of copies have beyond those of the longest side: copies are searched
    /// within one diagonal, at most √3 times that side, so all coordinates are below 4 times that side, and
    /// differences below 8 times.
    const HEADROOM_BITS: i32 = 3;

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
        let shortest = sides.into_iter().fold(f64::INFINITY, f64::min);
        let longest = sides.into_iter().fold(0.0, f64::max);
        if longest > Self::MAX_ASPECT_RATIO * shortest {
            return Err(TorusError::Elongated { shortest, longest });
        }
        let above = 2f64.powi(longest.log2().floor() as i32 + 1);
        let step = above * 2f64.powi(Self::HEADROOM_BITS - f64::MANTISSA_DIGITS as i32);
        let sides = sides.map(|side| (side / step).round_ties_even() * step);
        Ok(Self { sides, step })
    }

    /// The sides, along x, y and z.
    pub fn sides(&self) -> [f64; 3] {
        self.sides
    }

    /// The power of two of which all coordinates and sides are multiples.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The volume of the box.
    pub fn volume(&self) -> f64 {
        self.sides.iter().product()
    }

    /// The copy of a position in the box, rounded to the step. Along each axis it is at least 0 and less than the side.
    pub fn wrap(&self, position: [f64; 3]) -> [f64; 3] {
        let mut position = position;
        for (x, side) in position.iter_mut().zip(self.sides) {
            let steps = *x / self.step;
            // Doubles of 2⁵² steps or more are multiples of the step already.
            if steps.abs() < (1u64 << 52) as f64 {
                *x = steps.round_ties_even() * self.step;
            }
            // Exact. −0 becomes 0.
            *x = x.rem_euclid(side) + 0.0;
            if *x >= side {
                *x = 0.0;
            }
        }
        position
    }

    /// Whether a position is in the box: at least 0 and less than the side along each axis.
    pub fn holds(&self, position: [f64; 3]) -> bool {
        position.iter().zip(self.sides).all(|(x, side)| (0.0..side).contains(x))
    }

    /// The copy of `to` that is nearest to `from` along each axis, for two positions in the box; if two copies are equally near,
    /// `to` itself. Exact.
    #[inline]
    pub fn near(&self, from: [f64; 3], to: [f64; 3]) -> [f64; 3] {
        let mut near = to;
        for k in 0..3 {
            near[k] -= f64::from(self.winding(k, from[k], to[k])) * self.sides[k];
        }
        near
    }

    /// The number of times the way from one position in the box to the nearest copy of another crosses its faces: along each
    /// axis, the multiple of the side by which that copy differs from `to`.
    #[inline]
    pub fn windings(&self, from: [f64; 3], to: [f64; 3]) -> [i32; 3] {
        [0, 1, 2].map(|k| -self.winding(k, from[k], to[k]))
    }

    #[inline(always)]
    fn winding(&self, k: usize, from: f64, to: f64) -> i32 {
        let (way, half) = (to - from, self.sides[k] / 2.0);
        i32::from(way > half) - i32::from(way < -half)
    }

    /// A position moved by multiples of the sides. Exact for positions near the box.
    #[inline]
    pub fn moved(&self, position: [f64; 3], windings: [i32; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| position[k] + f64::from(windings[k]) * self.sides[k])
    }

    /// The corners of a simplex: the first one, and for each other corner the copy nearest to it.
    #[inline]
    pub fn together<const N: usize>(&self, mut corners: [[f64; 3]; N]) -> [[f64; 3]; N] {
        let first = corners[0];
        corners.iter_mut().skip(1).for_each(|corner| *corner = self.near(first, *corner));
        corners
    }

    /// An upper bound of the length of the diagonal, larger by about 10⁻¹⁵ of it.
    pub fn diagonal(&self) -> f64 {
        self.sides.iter().map(|side| side * side).sum::<f64>().sqrt() * (1.0 + 1e-15)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_wrapped_exactly() {
        let torus = Torus::new([4.0, 5.0, 6.0]).unwrap();
        assert_eq!(torus.sides(), [4.0, 5.0, 6.0]);
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

    #[test]
    fn bad_boxes_are_refused() {
        for side in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e200] {
            let error = Torus::new([1.0, side, 1.0]).unwrap_err();
            assert!(matches!(error, TorusError::Side { axis: 'y', .. }), "{error}");
        }
        assert!(matches!(Torus::new([1.0, 1.0, 1001.0]), Err(TorusError::Elongated { .. })));
    }
}
