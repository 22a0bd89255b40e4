//! Certification: judges a complex that any engine or program made, without computing one.

mod causes;
mod certificate;
mod claim;
mod classes;
mod cover;
mod emptiness;
mod filtration;
mod finding;
mod flat;
mod gaps;
mod gathered;
mod geometry;
mod grid;
mod isosurface;
mod message;
mod missing;
mod non_vertices;
mod placed;
mod spheres;
mod structure;
mod ties;
mod torus;
mod verify;
mod voxels;

pub use causes::{Cause, LikelyCause, likely_cause, likely_cause_of_values};
pub use certificate::{Certificate, CertifyError, NotJudged, Verdict};
pub use claim::{Claim, Extent};
pub use filtration::{
    Bound, CertifyFiltrationError, FiltrationCertificate, FiltrationFinding, Unjudged,
    certify_filtration,
};
pub use finding::{Finding, Simplex};
pub use missing::Declined;
