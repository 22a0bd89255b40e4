//! Floor 3: the exact checker, in Rust alone. It shares no code with what it judges.

use crate::shape::Class;

mod canonical;
mod certify;
mod compare;
mod enumerate;
pub mod exact;
pub mod schema;

pub use certify::{Certificate, Claim, Extent, Finding, NotCertifiable, NotJudged, Simplex};
pub use compare::{
    ClassDifference, Comparison, Differences, Domain, NotComparable, Placed, compare,
};
pub use enumerate::{Enumeration, NotEnumerable, enumerate};

/// A class in words.
fn class_name(class: Class) -> &'static str {
    match class {
        Class::Exterior => "exterior",
        Class::Interior => "interior",
        Class::Regular => "regular",
        Class::Singular => "singular",
    }
}
