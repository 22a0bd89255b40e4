//! All integration tests in one program, because each program links everything again.

/// NPZ by hand, shared with the tests of walpha-complex.
#[cfg(all(feature = "json", feature = "npz"))]
#[path = "../../../complex/tests/integration/archive.rs"]
mod archive;
mod base;
#[cfg(feature = "json")]
mod causes;
#[cfg(feature = "cli")]
mod command;
mod common;
mod compare;
#[cfg(feature = "json")]
mod compare_filtrations;
mod completeness;
mod each_simplex;
mod flat;
mod flat_claims;
mod geometry;
#[cfg(feature = "cli")]
mod meshes;
mod monitor;
mod mutations;
#[cfg(all(feature = "json", feature = "npz"))]
mod nonsense;
#[cfg(feature = "json")]
mod rules;
#[cfg(feature = "json")]
mod schema;
mod ties;
mod torus;
