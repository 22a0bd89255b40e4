//! All integration tests in one program: each program links everything once more.

#[cfg(feature = "npz")]
mod archive;
#[cfg(all(feature = "json", feature = "npz"))]
mod files;
#[cfg(feature = "npz")]
mod npz;
mod types;
