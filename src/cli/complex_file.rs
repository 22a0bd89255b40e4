//! Complexes that any program wrote.

use std::io::ErrorKind;
use std::path::Path;

use anyhow::Context;
use walpha::check::schema::{ComplexFile, PlacedComplex, SchemaError};
use walpha::points::read_points;
use walpha::shown::shown;

use super::said::{Said, refused, said};

/// Whether a file is a complex by its name: `.json` or `.npz`.
pub fn is_complex(path: &Path) -> bool {
    ComplexFile::is_named(path)
}

/// Reads a complex, with points (and weights, if it has some) from a file of their own if one is
/// given.
pub fn read(path: &Path, points: Option<&Path>) -> anyhow::Result<PlacedComplex> {
    let mut file = match ComplexFile::open(path) {
        Ok(file) => file,
        Err(SchemaError::Extension) => {
            refused!("{}: a complex is read from .json or .npz", shown(path) => "see docs/cross-checking.md")
        }
        Err(SchemaError::Io(error)) => {
            let missing = error.kind() == ErrorKind::NotFound;
            let next = missing.then(|| "check the path".to_owned());
            return Err(Said { next, ..said!("cannot read {}: {error}", shown(path)) }.into());
        }
        Err(other) => return Err(other).with_context(|| shown(path)),
    };
    if let Some(points) = points {
        let points = read_points(points, None)?;
        file.points = points.positions;
        file.weights = points.weights.or(file.weights);
    }
    match file.into_complex() {
        Err(SchemaError::NoPoints) => refused!(
            "{}: the file lists no points", shown(path) =>
            "add `points`, or give them in a file of their own with --points"
        ),
        made => made.with_context(|| shown(path)),
    }
}
