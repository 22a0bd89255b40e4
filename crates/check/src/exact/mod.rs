//! Exact geometric predicates over doubles, independent of those that the checker judges.
//!
//! Every finite double is an integer times a power of two. A predicate brings its arguments to
//! common powers of two (one for coordinates, one for squared lengths) and evaluates a polynomial
//! without any rounding or division; only its sign is used. A running error bound in doubles
//! decides the cases that are far from a tie; `i128` decides the others where the number of digits
//! proves that it can; big integers decide the rest.

mod binary;
mod center;
mod formulas;
mod frame;
mod lift;
mod number;
mod perturb;
mod point;
mod predicates;
mod solid;
mod value;

pub(crate) use center::RoundedSphere;
pub(crate) use lift::Lift;
pub(crate) use perturb::in_conflict;
pub(crate) use point::WeightedPoint;
pub(crate) use predicates::{Side, collinear, orientation, radius, side};
pub(crate) use solid::{Lattice, Star};
pub use value::Exact;
pub(crate) use value::{power_value, radius_value, six_volume};
