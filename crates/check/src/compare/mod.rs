//! Comparison of two complexes, or of two filtrations, over the same points.

mod complexes;
mod domain;
mod filtration;
mod points;

pub use complexes::{
    ClassDifference, CompareError, Comparison, Differences, compare, compare_monitored,
};
pub use domain::Domain;
pub use filtration::{
    CompareFiltrationsError, FiltrationComparison, ValueDifference, compare_filtrations,
    compare_filtrations_monitored,
};
pub use points::WeightDifference;
