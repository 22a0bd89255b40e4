//! All integration tests in one program, because each program links everything again.

#[cfg(feature = "npz")]
mod archive;
#[cfg(all(feature = "json", feature = "npz"))]
mod files;
#[cfg(feature = "npz")]
mod npz;
mod types;
