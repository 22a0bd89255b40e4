use rayon::prelude::*;

/// Weighted points that CGAL can stand: all numbers finite and of sane magnitude, no two places
/// equal, at least four points. Checked once, then trusted.
#[derive(Clone, Debug)]
pub struct Sites {
    positions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    /// Input index of each site.
    input: Vec<u32>,
    duplicates: Vec<[u32; 2]>,
}

/// Why points make no sites.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SitesError {
    /// Positions and weights do not pair up.
    #[error("{positions} positions but {weights} weights: each point needs one weight")]
    Lengths {
        /// Positions given.
        positions: usize,
        /// Weights given.
        weights: usize,
    },
    /// More points than 32-bit indices.
    #[error("{0} points are too many: at most {max} fit a 32-bit index; select fewer", max = u32::MAX)]
    TooMany(usize),
    /// NaN, infinity or an absurd magnitude.
    #[error(
        "point {index} has {what} {value}: it must be a finite number of magnitude at most {limit:e}; clean or rescale the input"
    )]
    Value {
        /// Input index of the point.
        index: usize,
        /// Which of its numbers.
        what: &'static str,
        /// The number.
        value: f64,
        /// The largest magnitude accepted.
        limit: f64,
    },
    /// No point at all, where one would do.
    #[error("there is no point: at least 1 is needed; select some")]
    Empty,
    /// Fewer than four different places.
    #[error(
        "{distinct} distinct points cannot span a tetrahedron: at least 4 are needed; select more points"
    )]
    TooFew {
        /// Different places among the input.
        distinct: usize,
    },
    /// All points in one plane or on one line.
    #[error(
        "all {points} points lie {on}: a 3D triangulation needs points that span a volume; select more points, or perturb them knowingly"
    )]
    Flat {
        /// Different places among the input.
        points: usize,
        /// "in one plane" or "on one line".
        on: &'static str,
    },
}

impl Sites {
    /// The largest coordinate accepted, 2⁵⁰⁰ ≈ 3.3e150: its square, and so every power distance,
    /// is still a finite double.
    pub const MAX_COORDINATE: f64 = f64::from_bits((1023 + 500) << 52);
    /// The largest weight accepted, 2¹⁰⁰⁰: a squared length.
    pub const MAX_WEIGHT: f64 = f64::from_bits((1023 + 1000) << 52);

    /// Checks points and removes duplicates: of several at one place the largest weight stays, of
    /// equal weights the lowest index. −0 and 0 are one place. O(n log n).
    ///
    /// # Errors
    /// See [`SitesError`]; points in one plane are found later, by the triangulation.
    pub fn new(positions: &[[f64; 3]], weights: &[f64]) -> Result<Self, SitesError> {
        check(positions, weights)?;
        let (kept, duplicates) = keep_heaviest(positions, weights);
        if kept.len() < 4 {
            return Err(SitesError::TooFew { distinct: kept.len() });
        }
        Ok(Self {
            positions: kept.iter().map(|&i| positions[i as usize]).collect(),
            weights: kept.iter().map(|&i| weights[i as usize]).collect(),
            input: kept,
            duplicates,
        })
    }

    /// Positions, one per site.
    pub fn positions(&self) -> &[[f64; 3]] {
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

    /// Pairs of input indices: a point that went, and the one at the same place that stayed.
    /// Ascending.
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.duplicates
    }
}

/// Whether every number is one that CGAL can stand; coordinates are x, y and perhaps z.
pub(super) fn check<const N: usize>(
    positions: &[[f64; N]],
    weights: &[f64],
) -> Result<(), SitesError> {
    if positions.len() != weights.len() {
        return Err(SitesError::Lengths { positions: positions.len(), weights: weights.len() });
    }
    if positions.len() > u32::MAX as usize {
        return Err(SitesError::TooMany(positions.len()));
    }
    for (index, (p, &weight)) in positions.iter().zip(weights).enumerate() {
        let coordinates = ["x", "y", "z"].into_iter().zip(*p);
        for (what, value) in coordinates.chain([("weight", weight)]) {
            let limit = if what == "weight" { Sites::MAX_WEIGHT } else { Sites::MAX_COORDINATE };
            if value.is_nan() || value.abs() > limit {
                return Err(SitesError::Value { index, what, value, limit });
            }
        }
    }
    Ok(())
}

/// Indices that stay, and pairs (went, stayed), both ascending.
pub(super) fn keep_heaviest<const N: usize>(
    positions: &[[f64; N]],
    weights: &[f64],
) -> (Vec<u32>, Vec<[u32; 2]>) {
    // Adding 0.0 turns −0.0 into 0.0, so equal numbers have equal bits.
    let place = |i: u32| positions[i as usize].map(|v| (v + 0.0).to_bits());
    let mut by_place: Vec<([u64; N], u32)> =
        (0..positions.len() as u32).into_par_iter().map(|i| (place(i), i)).collect();
    by_place.par_sort_unstable();
    let mut duplicates = Vec::new();
    for equal in by_place.chunk_by(|a, b| a.0 == b.0).filter(|equal| equal.len() > 1) {
        let mut best = equal[0].1;
        for &(_, i) in equal {
            // Of equal weights the lowest index, which comes first.
            if weights[i as usize] > weights[best as usize] {
                best = i;
            }
        }
        duplicates.extend(equal.iter().filter(|(_, i)| *i != best).map(|&(_, i)| [i, best]));
    }
    duplicates.sort_unstable();
    let mut gone = duplicates.iter().map(|pair| pair[0]).peekable();
    let stays = |i: &u32| gone.next_if_eq(i).is_none();
    ((0..positions.len() as u32).filter(stays).collect(), duplicates)
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
