use std::borrow::Cow;

use walpha_base::parallel::prelude::*;

use super::order::{self, Keyed, position_bits};
use super::{SitesError, Torus};

/// Weighted points of space (or, with `D` = 2, of the plane) that can be triangulated: all numbers are
/// finite and within [`MAX_COORDINATE`] and [`MAX_WEIGHT`], and no two positions are equal. Checked once,
/// then trusted. In space there are at least four points; in the plane one point, or points on one line,
/// are enough.
#[derive(Clone, Debug)]
pub struct Sites<'a, const D: usize = 3> {
    positions: Cow<'a, [[f64; D]]>,
    weights: Cow<'a, [f64]>,
    /// Input index of each site.
    input: Vec<u32>,
    duplicates: Vec<[u32; 2]>,
    /// The sites along a Hilbert curve.
    curve: Vec<u32>,
    /// The periodic box, if there is one; all positions are in it.
    torus: Option<Torus>,
}

/// The largest magnitude of a coordinate, 2⁵⁰⁰ ≈ 3.3e150: its square, and so every power distance, is a
/// finite double.
pub const MAX_COORDINATE: f64 = power_of_two(500);
/// The largest magnitude of a weight, 2¹⁰⁰⁰: weights are squared lengths.
pub const MAX_WEIGHT: f64 = power_of_two(1000);

const fn power_of_two(exponent: u64) -> f64 {
    f64::from_bits((f64::MAX_EXP as u64 - 1 + exponent) << (f64::MANTISSA_DIGITS - 1))
}

impl<'a> Sites<'a> {
    /// Checks points and removes duplicates. Of points with equal positions, the one with the largest weight is kept, and of
    /// equal weights the one with the lowest index. −0 and 0 are equal. O(n log n).
    ///
    /// # Errors
    /// See [`SitesError`]. Coplanar points are reported later, by the triangulation.
    pub fn new(positions: &'a [[f64; 3]], weights: &'a [f64]) -> Result<Self, SitesError> {
        let sites = Self::distinct(positions, weights)?;
        if sites.input.len() < 4 {
            return Err(SitesError::TooFew { distinct: sites.input.len() });
        }
        Ok(sites)
    }

    /// Like [`Self::new`], for at least one point; points need not span a volume.
    ///
    /// # Errors
    /// [`SitesError::Empty`], [`SitesError::TooMany`], [`SitesError::Lengths`] and [`SitesError::Value`].
    pub fn any(positions: &'a [[f64; 3]], weights: &'a [f64]) -> Result<Self, SitesError> {
        let sites = Self::distinct(positions, weights)?;
        if sites.input.is_empty() { Err(SitesError::Empty) } else { Ok(sites) }
    }

    /// Like [`Self::any`], for points of a torus, all of them in its box.
    ///
    /// # Errors
    /// [`SitesError::Empty`], [`SitesError::TooMany`], [`SitesError::Lengths`] and [`SitesError::Value`].
    pub fn on_torus(
        positions: &'a [[f64; 3]],
        weights: &'a [f64],
        torus: Torus,
    ) -> Result<Self, SitesError> {
        debug_assert!(positions.iter().all(|&place| torus.wrap(place) == place));
        Ok(Self { torus: Some(torus), ..Self::any(positions, weights)? })
    }

    /// The periodic box, if there is one.
    pub fn torus(&self) -> Option<Torus> {
        self.torus
    }

    /// The sites along a Hilbert curve.
    pub fn curve(&self) -> &[u32] {
        &self.curve
    }
}

impl<'a> Sites<'a, 2> {
    /// Like [`Sites::any`], for points of the plane.
    ///
    /// # Errors
    /// [`SitesError::Empty`], [`SitesError::TooMany`], [`SitesError::Lengths`] and [`SitesError::Value`].
    pub fn in_plane(positions: &'a [[f64; 2]], weights: &'a [f64]) -> Result<Self, SitesError> {
        let sites = Self::distinct(positions, weights)?;
        if sites.input.is_empty() { Err(SitesError::Empty) } else { Ok(sites) }
    }
}

impl<'a, const D: usize> Sites<'a, D> {
    fn distinct(positions: &'a [[f64; D]], weights: &'a [f64]) -> Result<Self, SitesError> {
        check(positions, weights)?;
        let mut curve = order::along_curve(positions);
        let duplicates = duplicates(&mut curve, positions, weights);
        if duplicates.is_empty() {
            return Ok(Self {
                positions: Cow::Borrowed(positions),
                weights: Cow::Borrowed(weights),
                input: (0..positions.len() as u32).collect(),
                duplicates,
                curve: curve.into_par_iter().coarse().map(|(_, point)| point).collect(),
                torus: None,
            });
        }
        const DUPLICATE: u32 = u32::MAX;
        let mut site: Vec<u32> = vec![0; positions.len()];
        duplicates.iter().for_each(|&[removed, _]| site[removed as usize] = DUPLICATE);
        let kept = |i: &u32| site[*i as usize] != DUPLICATE;
        let input: Vec<u32> = (0..positions.len() as u32).filter(kept).collect();
        input.iter().enumerate().for_each(|(at, &i)| site[i as usize] = at as u32);
        let along = curve.into_iter().map(|(_, point)| site[point as usize]);
        Ok(Self {
            positions: input.iter().map(|&i| positions[i as usize]).collect(),
            weights: input.iter().map(|&i| weights[i as usize]).collect(),
            curve: along.filter(|&at| at != DUPLICATE).collect(),
            input,
            duplicates,
            torus: None,
        })
    }

    /// Positions, one per site.
    pub fn positions(&self) -> &[[f64; D]] {
        &self.positions
    }

    /// Power weights, one per site.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The input index of each site, ascending.
    pub fn input(&self) -> &[u32] {
        &self.input
    }

    /// Pairs of input indices: a removed point, and the point kept at the same position. Ascending.
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.duplicates
    }
}

/// Checks that every number is within the range of the predicates. Coordinates are x, y and, in space, z.
///
/// # Errors
/// [`SitesError::Lengths`] and [`SitesError::Value`].
#[expect(clippy::missing_panics_doc, reason = "the point at fault has a number at fault")]
pub fn check<const D: usize>(positions: &[[f64; D]], weights: &[f64]) -> Result<(), SitesError> {
    if positions.len() != weights.len() {
        return Err(SitesError::Lengths { positions: positions.len(), weights: weights.len() });
    }
    if positions.len() > u32::MAX as usize {
        return Err(SitesError::TooMany(positions.len()));
    }
    let sane = |(p, w): (&[f64; D], &f64)| {
        p.iter().all(|x| x.abs() <= MAX_COORDINATE) && w.abs() <= MAX_WEIGHT
    };
    let Some(index) =
        positions.par_iter().zip(weights).coarse().position_first(|point| !sane(point))
    else {
        return Ok(());
    };
    let coordinates = ["x", "y", "z"].into_iter().zip(positions[index]);
    let mut numbers = coordinates.map(|(what, value)| (what, value, MAX_COORDINATE)).chain([(
        "weight",
        weights[index],
        MAX_WEIGHT,
    )]);
    let insane = numbers.find(|(_, value, limit)| value.is_nan() || value.abs() > *limit);
    let (what, value, limit) = insane.expect("one of the numbers of this point");
    Err(SitesError::Value { index, what, value, limit })
}

/// Pairs (removed, kept) of points with equal positions, ascending. Equal positions have equal indices on
/// the curve; points of one curve index are sorted by position, then by number.
fn duplicates<const D: usize>(
    curve: &mut [Keyed],
    positions: &[[f64; D]],
    weights: &[f64],
) -> Vec<[u32; 2]> {
    let bits = |i: u32| position_bits(positions[i as usize]);
    let mut duplicates = Vec::new();
    for same_index in curve.chunk_by_mut(|a, b| a.0 == b.0).filter(|points| points.len() > 1) {
        same_index.sort_unstable_by_key(|&(_, i)| (bits(i), i));
        for equal in same_index.chunk_by(|a, b| bits(a.1) == bits(b.1)) {
            let mut best = equal[0].1;
            for &(_, i) in equal {
                // Of equal weights, the lowest index, which comes first.
                if weights[i as usize] > weights[best as usize] {
                    best = i;
                }
            }
            duplicates.extend(equal.iter().filter(|(_, i)| *i != best).map(|&(_, i)| [i, best]));
        }
    }
    duplicates.sort_unstable();
    duplicates
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_duplicates_the_heaviest_stays() {
        let at = |x: f64| [x, 0.0, 0.0];
        let positions = [at(1.0), at(0.0), at(-0.0), at(1.0), at(2.0), at(0.0), at(1.0), at(3.0)];
        let weights = [1.0, 5.0, 5.0, 2.0, 0.0, 4.0, 2.0, 0.0];
        let sites = Sites::new(&positions, &weights).unwrap();
        assert_eq!(sites.input(), [1, 3, 4, 7]);
        assert_eq!(sites.duplicates(), [[0, 3], [2, 1], [5, 1], [6, 3]]);
        assert_eq!(sites.weights(), [5.0, 2.0, 0.0, 0.0]);
    }
}
