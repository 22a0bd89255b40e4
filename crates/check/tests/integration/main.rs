//! All integration tests in one program: each program links everything once more.

#[cfg(feature = "npz")]
mod archive;
mod base;
#[cfg(feature = "cli")]
mod command;
mod common;
mod compare;
#[cfg(feature = "json")]
mod compare_filtrations;
mod each_simplex;
mod flat;
mod flat_claims;
mod geometry;
mod mutations;
#[cfg(all(feature = "json", feature = "npz"))]
mod nonsense;
#[cfg(feature = "npz")]
mod npz;
#[cfg(all(feature = "json", feature = "npz"))]
mod schema;
mod ties;
mod torus;
mod types;
