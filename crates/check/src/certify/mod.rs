//! Certification: judging a complex that some engine or program made, without making one.

mod certificate;
mod claim;
mod classes;
mod emptiness;
mod filtration;
mod finding;
mod flat;
mod gaps;
mod geometry;
mod hull;
mod index;
mod linked;
mod message;
mod near;
mod non_vertices;
mod placed;
mod points;
mod rules;
mod simplex;
mod structure;
mod ties;
mod torus;
mod verify;

use points::Points;

pub use certificate::{Certificate, CertifyError, NotJudged, Verdict};
pub use claim::{Claim, Extent};
pub use filtration::{
    Bound, CertifyFiltrationError, FiltrationCertificate, FiltrationFinding, Unjudged,
    certify_filtration, certify_filtration_monitored,
};
pub use finding::Finding;
pub use simplex::Simplex;
