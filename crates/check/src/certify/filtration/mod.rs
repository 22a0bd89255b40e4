//! Certification of a filtration: is each simplex there, and does it enter when the file says?

mod certificate;
mod finding;
mod judge;
mod order;
mod pairs;
mod row_numbers;
mod spans;
mod values;

pub use certificate::{CertifyFiltrationError, FiltrationCertificate, Unjudged};
pub use finding::{Bound, FiltrationFinding};
pub use judge::{certify_filtration, certify_filtration_monitored};
