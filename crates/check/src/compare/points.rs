//! The points of two complexes or filtrations, matched by their positions.

use std::collections::BTreeSet;

use serde::Serialize;

/// A position where the weights differ.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct WeightDifference {
    /// The first point there, by A's indices.
    pub point: u32,
    /// The largest weight there in A.
    pub a: f64,
    /// The largest weight there in B.
    pub b: f64,
}

/// Numbers for positions, common to both complexes.
pub(super) struct CommonPositions {
    pub positions: Vec<[f64; 3]>,
    /// The number of each point of A.
    pub a: Vec<u32>,
    /// The number of each point of B.
    pub b: Vec<u32>,
}

impl CommonPositions {
    pub(super) fn new(a: &[[f64; 3]], b: &[[f64; 3]]) -> Self {
        let by_coordinates =
            |p: &[f64; 3], q: &[f64; 3]| p.partial_cmp(q).expect("coordinates are finite");
        let mut positions = [a, b].concat();
        positions.sort_unstable_by(by_coordinates);
        positions.dedup();
        let number = |p: &[f64; 3]| {
            positions
                .binary_search_by(|q| by_coordinates(q, p))
                .expect("every position has a number") as u32
        };
        let (a, b) = (a.iter().map(number).collect(), b.iter().map(number).collect());
        Self { positions, a, b }
    }

    /// Points of A at positions where B has none.
    pub(super) fn only_a(&self) -> Vec<u32> {
        only(&self.a, &self.b)
    }

    /// Points of B at positions where A has none.
    pub(super) fn only_b(&self) -> Vec<u32> {
        only(&self.b, &self.a)
    }

    /// The common positions at which the largest weights of A and B differ.
    pub(super) fn weight_differences(&self, a: &[f64], b: &[f64]) -> Vec<WeightDifference> {
        let mut in_a = weights_by_position(a, &self.a);
        let in_b = weights_by_position(b, &self.b);
        let difference = |(point, &position): (u32, &u32)| {
            // Each position once: its weight is replaced.
            let a = std::mem::replace(&mut in_a[position as usize], f64::NEG_INFINITY);
            let b = in_b.get(position as usize).copied().filter(|b| *b != f64::NEG_INFINITY)?;
            (a != b && a != f64::NEG_INFINITY).then_some(WeightDifference { point, a, b })
        };
        (0..).zip(&self.a).filter_map(difference).collect()
    }
}

fn only(own: &[u32], other: &[u32]) -> Vec<u32> {
    let other: BTreeSet<_> = other.iter().collect();
    (0..).zip(own).filter(|(_, position)| !other.contains(position)).map(|(i, _)| i).collect()
}

/// The largest weight at each position; −∞ where there is no point.
pub(super) fn weights_by_position(weights: &[f64], numbers: &[u32]) -> Vec<f64> {
    let count = numbers.iter().max().map_or(0, |&last| last as usize + 1);
    let mut largest = vec![f64::NEG_INFINITY; count];
    for (&number, &weight) in numbers.iter().zip(weights) {
        largest[number as usize] = largest[number as usize].max(weight);
    }
    largest
}
