//! Unions of balls, with certified bounds.

#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(missing_debug_implementations, unreachable_pub)]

mod cavities;
mod components;
mod curve;
mod discs;
mod error;
mod gradient;
mod points;
mod quick;
mod real;
mod scatter;
mod simplex;
mod union;

pub use cavities::{Cavity, Pocket};
pub use components::BallComponent;
pub use curve::{UnionLevel, union_curve};
pub use discs::DiscUnion;
pub use error::BallsError;
pub use gradient::{Gradient, Gradients};
pub use real::Bounded;
pub use union::{BallUnion, Contacts, Measured};
