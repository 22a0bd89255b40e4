use super::Claim;
use crate::exact::WeightedPoint;

/// The input points.
#[derive(Clone, Copy)]
pub(super) struct Points<'a> {
    pub positions: &'a [[f64; 3]],
    pub weights: &'a [f64],
}

impl<'a> Points<'a> {
    /// Those of a claim.
    pub(super) fn of(claim: &Claim<'a>) -> Self {
        Self { positions: claim.placed.positions, weights: claim.placed.weights }
    }

    pub(super) fn len(self) -> usize {
        self.positions.len()
    }

    pub(super) fn get(self, i: u32) -> WeightedPoint {
        WeightedPoint { position: self.positions[i as usize], weight: self.weights[i as usize] }
    }

    pub(super) fn at<const N: usize>(self, row: [u32; N]) -> [WeightedPoint; N] {
        row.map(|i| self.get(i))
    }

    pub(super) fn places<const N: usize>(self, row: [u32; N]) -> [[f64; 3]; N] {
        row.map(|i| self.positions[i as usize])
    }
}
