//! Floor 3: the exact checker, in Rust alone. It shares no code with what it judges.
//!
//! [`enumerate`] makes the answer of few points from the definition; [`Claim`] judges any answer,
//! of any size, by rules that are linear in it; [`compare()`] says how two answers differ;
//! [`schema`] reads and writes the answers of other programs. Every decision is exact, from the
//! input doubles on.
//!
//! ```
//! use walpha::check::{Claim, Extent, Placed, compare, enumerate};
//!
//! let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]];
//! let weights = [0.0; 5];
//! let made = enumerate(&positions, &weights, 0.75)?;
//! let mut claim = Claim {
//!     positions: &positions,
//!     weights: &weights,
//!     alpha: 0.75,
//!     complex: &made.complex,
//!     extent: Extent::Whole,
//!     hidden: Some(&made.hidden),
//!     duplicates: Some(&made.duplicates),
//! };
//! assert!(claim.is_valid()?);
//! // A cell less, and the checker says what is missing.
//! let mut damaged = made.complex.clone();
//! damaged.cells.vertices.pop();
//! damaged.cells.classes.pop();
//! claim.complex = &damaged;
//! assert!(claim.first_finding()?.is_some());
//! let placed = |complex| Placed { positions: &positions, weights: &weights, alpha: 0.75, complex };
//! let [a, b] = [&made.complex, &damaged].map(placed);
//! assert!(!compare(a, b)?.is_equal());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::shape::Class;

mod canonical;
mod certify;
mod compare;
mod enumerate;
mod exact;
mod flat;
pub mod schema;

pub use certify::{
    Bound, Certificate, Claim, Extent, FiltrationCertificate, FiltrationFinding, Finding,
    NotAFiltration, NotCertifiable, NotJudged, Simplex, Unjudged, certify_filtration,
};
pub use compare::{
    ClassDifference, Comparison, Differences, Domain, FiltrationComparison, NotComparable, Placed,
    ValueDifference, WeightDifference, compare, compare_filtrations,
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
