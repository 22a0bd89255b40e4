use crate::Placed;
use crate::exact::WeightedPoint;

/// The input points.
#[derive(Clone, Copy)]
pub(super) struct Points<'a> {
    pub positions: &'a [[f64; 3]],
    pub weights: &'a [f64],
}

impl<'a> Points<'a> {
    /// The points of a complex.
    pub(super) fn of(placed: Placed<'a>) -> Self {
        Self { positions: placed.positions, weights: placed.weights }
    }

    pub(super) fn len(self) -> usize {
        self.positions.len()
    }

    pub(super) fn get(self, i: u32) -> WeightedPoint {
        WeightedPoint { position: self.positions[i as usize], weight: self.weights[i as usize] }
    }

    /// The corners of a row.
    pub(super) fn corners<const N: usize>(self, row: [u32; N]) -> [WeightedPoint; N] {
        row.map(|i| self.get(i))
    }

    /// Their positions.
    pub(super) fn positions_of<const N: usize>(self, row: [u32; N]) -> [[f64; 3]; N] {
        row.map(|i| self.positions[i as usize])
    }
}
