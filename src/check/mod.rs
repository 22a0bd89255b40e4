//! Floor 3: the exact checker, in Rust alone. It shares no code with what it judges.
//!
//! [`enumerate`] makes the answer of few points from the definition; [`Claim`] judges any answer,
//! of any size, by rules that are linear in it; [`compare()`] says how two answers differ;
//! [`schema`] reads and writes the answers of other programs. Every decision is exact, from the
//! input doubles on.

use crate::shape::Class;

mod canonical;
mod certify;
mod compare;
mod enumerate;
mod exact;
pub mod schema;

pub use certify::{Certificate, Claim, Extent, Finding, NotCertifiable, NotJudged, Simplex};
pub use compare::{
    ClassDifference, Comparison, Differences, Domain, NotComparable, Placed, compare,
};
pub use enumerate::{Enumeration, NotEnumerable, enumerate};
pub use exact::Exact;

/// A class in words.
fn class_name(class: Class) -> &'static str {
    match class {
        Class::Exterior => "exterior",
        Class::Interior => "interior",
        Class::Regular => "regular",
        Class::Singular => "singular",
    }
}
