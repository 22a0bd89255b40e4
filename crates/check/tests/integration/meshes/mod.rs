//! Meshes as other programs write them.

mod damaged;
mod literal;
mod named;
mod options;
mod round_trip;
mod writers;

use std::path::{Path, PathBuf};

use walpha_check::meshes::{Mesh, MeshError};
use walpha_check::schema::PlacedComplex;
use walpha_check::{Finding, count_by_rule};

/// An empty folder of its own for each test, below Cargo's for tests.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("meshes").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Writes files into a folder, and reads the first of them.
fn read(folder: &Path, files: &[(&str, &[u8])]) -> Result<Mesh, MeshError> {
    for (name, bytes) in files {
        std::fs::write(folder.join(name), bytes).unwrap();
    }
    Mesh::open(folder.join(files[0].0))
}

/// The verdict on a mesh, and what is found by rule.
fn judge(mesh: Mesh) -> (String, Vec<(&'static str, usize)>) {
    let placed = PlacedComplex::try_from(mesh.complex).unwrap();
    let (findings, certificate) = placed.findings().unwrap();
    (certificate.to_string(), count_by_rule(findings.iter().map(Finding::rule)))
}
