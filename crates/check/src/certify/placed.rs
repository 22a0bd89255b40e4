//! Judging complexes from files.

use walpha_base::Monitor;

use super::certificate::{Certificate, CertifyError};
use super::claim::Claim;
use super::finding::Finding;
use super::{isosurface, torus, voxels};
use crate::Placed;
use crate::schema::{ComplexFile, PlacedComplex};

impl PlacedComplex {
    /// The claim of the complex, judged as one in space.
    pub fn claim(&self) -> Claim<'_> {
        Claim::new(self.placed())
            .with_hidden(self.hidden.as_deref())
            .with_duplicates(self.duplicates.as_deref())
            .with_lowest(self.lowest)
    }

    /// All broken rules, and the certificate. For labels, the rules are that the cells fill exactly the voxels, face to face, and
    /// that classes follow from the cells. Inside an isosurface the rules are that cells meet face to face, and that classes follow
    /// from the cells: which cells belong to it is not judged, as the samples of the volume decide. In space the rules are those of [`Claim::visit`]. On a torus they are the same around
    /// each simplex; in addition, no edge may span half of the box, and a whole triangulation must fill the box, instead of the
    /// rules for the hull.
    ///
    /// # Errors
    /// [`CertifyError`].
    pub fn findings(&self) -> Result<(Vec<Finding>, Certificate), CertifyError> {
        let monitor = &*Monitor::current();
        if let Some(region) = &self.voxels {
            return voxels::findings(self, region, monitor);
        }
        if self.isovalue.is_some() {
            return isosurface::findings(self, monitor);
        }
        match self.periodic {
            None => monitor.watch(|| self.claim().findings()),
            Some(vectors) => torus::findings(self, vectors, monitor),
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
            lowest: claim.lowest,
            voxels: None,
            copies: 1,
            isovalue: None,
        }
    }
}

/// The file includes the claimed lists of hidden points and duplicates.
impl From<Claim<'_>> for ComplexFile {
    fn from(claim: Claim<'_>) -> Self {
        let mut file = Self::new(claim.placed);
        file.hidden = claim.hidden.map(<[_]>::to_vec);
        file.duplicates = claim.duplicates.map(<[_]>::to_vec);
        file
    }
}
