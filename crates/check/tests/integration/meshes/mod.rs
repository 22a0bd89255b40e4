//! Meshes as other programs write them.

mod damaged;
mod literal;
mod named;
mod options;
mod round_trip;
mod writers;

use std::path::Path;

use tempfile::TempDir;
use walpha_check::meshes::{Mesh, MeshError};
use walpha_check::schema::PlacedComplex;
use walpha_check::{Finding, count_by_rule};

/// An empty folder, removed when it goes out of scope. Each call makes its own, since tests run at the same time.
fn folder() -> TempDir {
    tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap()
}

/// Writes files into a folder, and reads the first of them.
fn read(folder: impl AsRef<Path>, files: &[(&str, &[u8])]) -> Result<Mesh, MeshError> {
    for (name, bytes) in files {
        std::fs::write(folder.as_ref().join(name), bytes).unwrap();
    }
    Mesh::open(folder.as_ref().join(files[0].0))
}

/// The verdict on a mesh, and what is found by rule.
fn judge(mesh: Mesh) -> (String, Vec<(&'static str, usize)>) {
    let placed = PlacedComplex::try_from(mesh.complex).unwrap();
    let (findings, certificate) = placed.findings().unwrap();
    (certificate.to_string(), count_by_rule(findings.iter().map(Finding::rule)))
}
