//! An exact checker for weighted alpha shapes and regular triangulations in 3D, written only in Rust.
//!
//! [`enumerate`] computes the complex of a few points from the definition; [`Claim`] judges complexes of any size, by rules that
//! take linear time; [`compare()`] finds the differences of two complexes; [`certify_filtration`] and [`compare_filtrations`] do
//! the same for all values of α together; [`schema`] reads and writes complexes, [`meshes`] reads files of other programs. Every
//! decision is exact on the input doubles.
//!
//! ```
//! use walpha_check::{Alpha, Claim, Placed, Verdict, compare, enumerate};
//!
//! let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]];
//! let weights = [0.0; 5];
//! let alpha = Alpha::from_squared(0.75)?;
//! let made = enumerate(&positions, &weights, alpha)?;
//! let right = Placed::new(&positions, &weights, alpha, &made.complex);
//! assert_eq!(Claim::new(right).verdict()?, Verdict::Exact);
//!
//! // One cell less, and the checker names what is missing.
//! let mut damaged = made.complex.clone();
//! damaged.cells = made.complex.cells.clone().into_iter().skip(1).collect();
//! let wrong = Placed::new(&positions, &weights, alpha, &damaged);
//! let finding = Claim::new(wrong).first_finding()?.expect("a cell is missing");
//! assert!(finding.to_string().starts_with("cell [0, 1, 2, 3] is missing"));
//! assert!(!compare(right, wrong)?.is_equal());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(unreachable_pub)]

mod certify;
mod compare;
mod enumerate;
mod exact;
mod flat;
mod index;
pub mod meshes;
mod parallel;
mod period;
mod repeated;
mod rules;
pub mod schema;

pub use certify::{
    Bound, Cause, Certificate, CertifyError, CertifyFiltrationError, Claim, Declined, Extent,
    FiltrationCertificate, FiltrationFinding, Finding, LikelyCause, NotJudged, Simplex, Unjudged,
    Verdict, certify_filtration, likely_cause, likely_cause_of_values,
};
pub use compare::{
    ClassDifference, CompareError, CompareFiltrationsError, Comparison, Differences, Domain,
    FiltrationComparison, ValueDifference, WeightDifference, compare, compare_filtrations,
};
pub use enumerate::{EnumerateError, Enumeration, enumerate};
pub use exact::Exact;
pub use rules::{count_by_rule, keep_causes};
/// Progress and cancelling of long work.
pub use walpha_base::advice::Advise;
pub use walpha_base::{Cancelled, Monitor};
pub use walpha_complex::{
    Alpha, AlphaError, ByClass, Class, Complex, Placed, Simplices, SimplicesError, Voxels,
};

/// The example in the README runs.
#[cfg(all(doctest, feature = "json"))]
#[doc = include_str!("../README.md")]
struct Readme;
