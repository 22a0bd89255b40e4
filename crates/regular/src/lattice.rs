use super::number::{decode, lowest_bit};

/// The lattice that contains all coordinates of a set of points.
///
/// A polynomial of degree k in differences of coordinates (weights count as degree 2) is evaluated without rounding if the
/// magnitudes of its terms sum to at most 2⁵³ stepᵏ. On voxel grids this decides every tie; otherwise the many cospherical and
/// coplanar tuples there would all require integers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// A power of two, between 2⁻¹⁰⁰ and 2¹⁰⁰, of which every coordinate is a multiple; 0 if there is none.
    pub step: f64,
    /// Whether every weight is a multiple of the squared step.
    pub holds_weights: bool,
}

impl Lattice {
    /// The number of bits by which the step may be refined to hold the weights. A bit of the step takes, from the 53 bits of a
    /// double, as many bits as the degree of the polynomial, up to 8.
    const MAX_REFINEMENT: i32 = 2;
    /// The largest magnitude of the exponent of the step: its powers up to the eighth are doubles.
    const MAX_EXPONENT: i32 = 100;

    /// No lattice: no polynomial counts as exact in doubles.
    pub(crate) const NONE: Self = Self { step: 0.0, holds_weights: false };

    /// The lattice of points. O(n).
    pub fn of(positions: &[[f64; 3]], weights: &[f64]) -> Self {
        let lowest = |numbers: &mut dyn Iterator<Item = f64>| numbers.filter_map(lowest_bit).min();
        let coordinates = lowest(&mut positions.as_flattened().iter().copied()).unwrap_or(0);
        // Differences of equal weights are 0, but α + ω would still be rounded off the lattice.
        let weight = lowest(&mut weights.iter().copied());
        let wanted = weight.map_or(coordinates, |bit| bit.div_euclid(2).min(coordinates));
        let holds_weights = wanted >= coordinates - Self::MAX_REFINEMENT;
        let exponent = if holds_weights { wanted } else { coordinates };
        if exponent.abs() > Self::MAX_EXPONENT {
            return Self::NONE;
        }
        Self { step: 2f64.powi(exponent), holds_weights }
    }
}

/// The range of bits, from the lowest to the highest, of a set of coordinates. It decides whether triple products of differences,
/// including those with a position given later, are exact in doubles.
#[derive(Clone, Copy, Debug)]
pub struct BitRange {
    /// All coordinates are multiples of two to this power…
    lowest: i32,
    /// …and of magnitude below two to this power.
    above: i32,
}

impl BitRange {
    /// The largest number of bits of a coordinate, in units of the lowest bit. A difference has one more, a triple
    /// product of differences three times as many, and a sum of up to 24 such products 5 more: 3·16 + 5 = 53, the
    /// bits of a double.
    const MAX_BITS: i32 = 15;
    /// The largest magnitude of the exponent of the lowest bit: third powers stay within the range of doubles.
    const MAX_EXPONENT: i32 = 300;

    /// The bit range of positions. O(n).
    pub fn of(positions: &[[f64; 3]]) -> Self {
        Self::of_all(positions.iter().copied())
    }

    /// The bit range of positions from an iterator. O(n).
    pub fn of_all(positions: impl Iterator<Item = [f64; 3]>) -> Self {
        positions.flatten().fold(Self { lowest: i32::MAX, above: i32::MIN }, Self::with)
    }

    /// The bit range of the union of two sets.
    #[must_use]
    pub fn with_all(self, other: Self) -> Self {
        Self { lowest: self.lowest.min(other.lowest), above: self.above.max(other.above) }
    }

    fn with(self, x: f64) -> Self {
        let (mantissa, bit) = decode(x);
        if mantissa == 0 {
            return self;
        }
        let bits = (mantissa.unsigned_abs().ilog2() + 1) as i32;
        Self { lowest: self.lowest.min(bit), above: self.above.max(bit + bits) }
    }

    /// Whether triple products of differences of these positions and one more are exact in doubles.
    pub fn is_exact_with(self, position: [f64; 3]) -> bool {
        position.into_iter().fold(self, Self::with).is_exact()
    }

    /// Whether triple products of differences of these positions are exact in doubles.
    pub fn is_exact(self) -> bool {
        let Self { lowest, above } = self;
        let all_zero = above == i32::MIN;
        above <= lowest.saturating_add(Self::MAX_BITS) && lowest.abs() <= Self::MAX_EXPONENT
            || all_zero
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps() {
        let of = |x: f64, w: f64| Lattice::of(&[[x, 2.0, 4.0]], &[w]);
        assert_eq!(of(6.0, 0.0), Lattice { step: 2.0, holds_weights: true });
        assert_eq!(of(3.0, 10.0), Lattice { step: 1.0, holds_weights: true });
        assert_eq!(of(3.0, 0.5), Lattice { step: 0.5, holds_weights: true });
        assert_eq!(of(3.0, 0.1), Lattice { step: 1.0, holds_weights: false });
        assert_eq!(of(1e-300, 0.0), Lattice { step: 0.0, holds_weights: false });
    }

    #[test]
    fn bit_ranges_know_where_doubles_round() {
        let range = BitRange::of(&[[0.0, 63.0, 12.0], [-5.0, 32767.0, 1.0]]);
        assert!(range.is_exact_with([1.0, 2.0, 0.0]));
        assert!(!range.is_exact_with([0.5, 2.0, 0.0]));
        assert!(!range.is_exact_with([32768.0, 2.0, 0.0]));
        let halves = BitRange::of(&[[0.5, 100.0, 511.5]]);
        assert!(halves.is_exact_with([0.25; 3]) && !halves.is_exact_with([0.1; 3]));
        assert!(!BitRange::of(&[[1e-200; 3]]).is_exact_with([0.0; 3]));
        assert!(BitRange::of(&[[0.0; 3]]).is_exact_with([0.0; 3]));
    }
}
