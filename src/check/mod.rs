//! Floor 3: the exact checker, in Rust alone. It shares no code with what it judges.

mod canonical;
mod certify;
mod enumerate;
pub mod exact;

pub use certify::{Certificate, Claim, Extent, Finding, NotCertifiable, NotJudged, Simplex};
pub use enumerate::{Enumeration, NotEnumerable, enumerate};
