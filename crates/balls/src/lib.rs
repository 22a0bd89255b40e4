//! Unions of balls, with certified bounds.

#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(missing_debug_implementations, unreachable_pub)]

mod error;
mod points;
mod real;
mod scatter;
mod simplex;
mod union;

pub use error::BallsError;
pub use real::Bounded;
pub use union::{BallUnion, Contacts, Measured};
