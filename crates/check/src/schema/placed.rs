use crate::{Alpha, Complex, Placed};

/// A complex with its points, in canonical order, ready to be judged.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedComplex {
    /// x, y, z of each point.
    pub positions: Vec<[f64; 3]>,
    /// Power weights.
    pub weights: Vec<f64>,
    /// α.
    pub alpha: Alpha,
    /// The complex.
    pub complex: Complex,
    /// Points listed as hidden, if they are listed.
    pub hidden: Option<Vec<u32>>,
    /// Duplicates, if they are listed.
    pub duplicates: Option<Vec<[u32; 2]>>,
    /// The sides of the periodic box, if there is one.
    pub periodic: Option<[f64; 3]>,
}

impl PlacedComplex {
    /// The complex, borrowed for comparison.
    pub fn placed(&self) -> Placed<'_> {
        Placed::new(&self.positions, &self.weights, self.alpha, &self.complex)
    }

    /// The same complex in a periodic box with these sides, or in space.
    #[must_use]
    pub fn with_periodic(self, periodic: Option<[f64; 3]>) -> Self {
        Self { periodic, ..self }
    }
}
