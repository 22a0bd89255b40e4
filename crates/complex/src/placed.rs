use crate::{Alpha, Complex};

/// A complex with its weighted points and α, to be judged or compared.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// x, y, z of each input point.
    pub positions: &'a [[f64; 3]],
    /// The power weight of each, a squared length.
    pub weights: &'a [f64],
    /// α.
    pub alpha: Alpha,
    /// The complex, by input indices.
    pub complex: &'a Complex,
}

impl<'a> Placed<'a> {
    /// A complex over points with these weights, at α. Consistency is not checked here, but by what judges or
    /// compares it.
    pub fn new(
        positions: &'a [[f64; 3]],
        weights: &'a [f64],
        alpha: Alpha,
        complex: &'a Complex,
    ) -> Self {
        Self { positions, weights, alpha, complex }
    }

    /// Another complex over the same points, at the same α.
    #[must_use]
    pub fn with_complex(self, complex: &'a Complex) -> Self {
        Self { complex, ..self }
    }
}
