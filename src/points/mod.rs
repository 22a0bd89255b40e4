//! Floor 2: which samples become points, and what they weigh.

/// Points with their power weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WeightedPoints {
    /// Positions, (x, y, z).
    pub positions: Vec<[f64; 3]>,
    /// Weights ω, squared lengths.
    pub weights: Vec<f64>,
    /// The value F at each point, where there is one.
    pub values: Option<Vec<f64>>,
}
