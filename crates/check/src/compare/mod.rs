//! Comparison of two complexes, or of two filtrations, over the same points.

mod complexes;
mod domain;
mod filtration;
mod points;

pub use complexes::{ClassDifference, CompareError, Comparison, Differences, compare};
pub use domain::Domain;
pub use filtration::{
    CompareFiltrationsError, FiltrationComparison, ValueDifference, compare_filtrations,
};
pub use points::WeightDifference;
