//! Comparison of two complexes, or of two filtrations, over the same points.

mod common_positions;
mod complexes;
mod domain;
mod filtration;
mod text;

pub use complexes::{
    ClassDifference, CompareError, Comparison, Differences, WeightDifference, compare,
    compare_monitored,
};
pub use domain::Domain;
pub use filtration::{
    CompareFiltrationsError, FiltrationComparison, ValueDifference, compare_filtrations,
    compare_filtrations_monitored,
};
