/// A point with a power weight; all four numbers finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WeightedPoint {
    /// x, y, z.
    pub position: [f64; 3],
    /// The weight, a squared length.
    pub weight: f64,
}

impl WeightedPoint {
    /// A point without its weight: orientations must not spend digits on weights.
    pub(super) fn bare(position: [f64; 3]) -> Self {
        Self { position, weight: 0.0 }
    }
}
