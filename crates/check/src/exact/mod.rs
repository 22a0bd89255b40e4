//! Exact geometric predicates over doubles, independent of those that the checker judges.
//!
//! Every finite double is an integer times a power of two. A predicate converts its arguments to common powers of two (one for
//! coordinates, one for squared lengths) and evaluates a polynomial without any rounding or division; only its sign is used.
//! Doubles decide the cases that are far from a tie, by a bound that counts roundings; `i128` decides the others if the number of
//! digits proves that it can; big integers decide the rest.

mod center;
mod formulas;
mod frame;
mod lattice;
mod number;
mod predicates;
mod value;
mod wide;

pub(crate) use center::RoundedSphere;
pub(crate) use frame::WeightedPoint;
pub(crate) use lattice::{Lattice, Lift, Star, compare_part};
pub(crate) use predicates::{Side, collinear, in_conflict, orientation, radius, side};
pub use value::Exact;
pub(crate) use value::{power_value, radius_value, six_volume};
