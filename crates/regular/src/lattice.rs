use super::number::{decode, lowest_bit};

/// What the numbers of a set have in common.
///
/// A polynomial of degree k in coordinate differences (weights count as degree 2) whose terms stay
/// below 2⁵³ stepᵏ in sum of magnitudes is computed without any rounding. On voxel grids that decides
/// every tie; without it, each of the many cospherical and coplanar tuples there would go to
/// integers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// A power of two of which every coordinate is an integer multiple; 0 when none is useful.
    pub step: f64,
    /// Whether every weight is a multiple of the squared step.
    pub holds_weights: bool,
}

impl Lattice {
    /// How much finer than the coordinates the step may become for the sake of the weights, in
    /// bits: a step costs each predicate its degree, up to 8, times as many of the 53 bits.
    const FINER: i32 = 2;
    /// Powers of the step up to the eighth stay within the range of doubles.
    const FINEST: i32 = -100;

    /// The lattice of some points. O(n).
    pub fn of(positions: &[[f64; 3]], weights: &[f64]) -> Self {
        let lowest = |numbers: &mut dyn Iterator<Item = f64>| numbers.filter_map(lowest_bit).min();
        let coordinates = lowest(&mut positions.as_flattened().iter().copied()).unwrap_or(0);
        // Where all weights are alike their differences are 0, but α + ω is still rounded.
        let weight = lowest(&mut weights.iter().copied());
        let wanted = weight.map_or(coordinates, |bit| bit.div_euclid(2).min(coordinates));
        let holds_weights = wanted >= coordinates - Self::FINER;
        let exponent = if holds_weights { wanted } else { coordinates };
        if exponent.abs() > Self::FINEST.abs() {
            return Self { step: 0.0, holds_weights: false };
        }
        Self { step: 2f64.powi(exponent), holds_weights }
    }
}

/// From the lowest to the highest bit of a set of coordinates: whether third powers of their differences
/// are exact in doubles, with a place that comes later.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    /// All coordinates are integers times two to this power…
    unit: i32,
    /// …and less than two to this power.
    reach: i32,
}

impl Reach {
    /// Bits of a coordinate in units. A difference has one more; a triple product of such three
    /// times that; sums of 24 of these five more: 3·16 + 5 = 53, what a double holds.
    const BITS: i32 = 15;
    /// Third powers of larger or smaller units leave the range of doubles.
    const RANGE: i32 = 300;

    /// The reach of some places. O(n).
    pub fn of(places: &[[f64; 3]]) -> Self {
        Self::of_all(places.iter().copied())
    }

    /// The same of places that are not in memory.
    pub fn of_all(places: impl Iterator<Item = [f64; 3]>) -> Self {
        places.flatten().fold(Self { unit: i32::MAX, reach: i32::MIN }, Self::with)
    }

    /// The reach of places of both.
    #[must_use]
    pub fn with_all(self, other: Self) -> Self {
        Self { unit: self.unit.min(other.unit), reach: self.reach.max(other.reach) }
    }

    fn with(self, x: f64) -> Self {
        let (mantissa, bit) = decode(x);
        if mantissa == 0 {
            return self;
        }
        let bits = (mantissa.unsigned_abs().ilog2() + 1) as i32;
        Self { unit: self.unit.min(bit), reach: self.reach.max(bit + bits) }
    }

    /// Whether formulas over these places and one more are exact in doubles.
    pub fn is_exact_with(self, place: [f64; 3]) -> bool {
        place.into_iter().fold(self, Self::with).is_exact()
    }

    /// Whether formulas over these places are exact in doubles.
    pub fn is_exact(self) -> bool {
        let Self { unit, reach } = self;
        reach <= unit.saturating_add(Self::BITS) && unit.abs() <= Self::RANGE || reach == i32::MIN
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
    fn reaches_know_where_doubles_round() {
        let reach = Reach::of(&[[0.0, 63.0, 12.0], [-5.0, 32767.0, 1.0]]);
        assert!(reach.is_exact_with([1.0, 2.0, 0.0]));
        assert!(!reach.is_exact_with([0.5, 2.0, 0.0]));
        assert!(!reach.is_exact_with([32768.0, 2.0, 0.0]));
        let halves = Reach::of(&[[0.5, 100.0, 511.5]]);
        assert!(halves.is_exact_with([0.25; 3]) && !halves.is_exact_with([0.1; 3]));
        assert!(!Reach::of(&[[1e-200; 3]]).is_exact_with([0.0; 3]));
        assert!(Reach::of(&[[0.0; 3]]).is_exact_with([0.0; 3]));
    }
}
