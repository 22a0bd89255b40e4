use crate::number::lowest_bit;

/// What the numbers of a set have in common.
///
/// A polynomial of degree k in coordinate differences (weights count as degree 2) whose terms stay
/// below 2⁵³ stepᵏ in sum of magnitudes is computed without any rounding. On voxel grids that decides
/// every tie; without it, each of the many cospherical and coplanar tuples there would go to
/// integers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
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
}
