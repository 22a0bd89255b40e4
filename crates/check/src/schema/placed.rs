use super::ComplexFile;
use crate::certify::torus;
use crate::{Alpha, Certificate, CertifyError, Claim, Complex, Finding, Placed};

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
    /// The sides of the box that repeats, if one does.
    pub periodic: Option<[f64; 3]>,
}

impl PlacedComplex {
    /// Borrowed, to be compared.
    pub fn placed(&self) -> Placed<'_> {
        Placed::new(&self.positions, &self.weights, self.alpha, &self.complex)
    }

    /// What it claims, to be judged as a complex in space.
    pub fn claim(&self) -> Claim<'_> {
        Claim::new(self.placed())
            .with_hidden(self.hidden.as_deref())
            .with_duplicates(self.duplicates.as_deref())
    }

    /// In a box that repeats with these sides, or in space.
    #[must_use]
    pub fn with_periodic(self, periodic: Option<[f64; 3]>) -> Self {
        Self { periodic, ..self }
    }

    /// All broken rules, and what was judged: in space those of [`Claim::visit`]. On a torus the same, around
    /// each simplex; that no edge spans half of the box; and of a whole triangulation that it fills the
    /// box, instead of the rules on the hull.
    ///
    /// # Errors
    /// [`CertifyError`].
    pub fn findings(&self) -> Result<(Vec<Finding>, Certificate), CertifyError> {
        match self.periodic {
            None => self.claim().findings(),
            Some(sides) => torus::findings(self, sides),
        }
    }
}

impl From<Claim<'_>> for PlacedComplex {
    fn from(claim: Claim<'_>) -> Self {
        let Placed { positions, weights, alpha, complex } = claim.placed;
        Self {
            positions: positions.to_vec(),
            weights: weights.to_vec(),
            alpha,
            complex: complex.clone(),
            hidden: claim.hidden.map(<[_]>::to_vec),
            duplicates: claim.duplicates.map(<[_]>::to_vec),
            periodic: None,
        }
    }
}

/// With what it claims of hidden points and duplicates.
impl From<Claim<'_>> for ComplexFile {
    fn from(claim: Claim<'_>) -> Self {
        let mut file = Self::new(claim.placed);
        file.hidden = claim.hidden.map(<[_]>::to_vec);
        file.duplicates = claim.duplicates.map(<[_]>::to_vec);
        file
    }
}
