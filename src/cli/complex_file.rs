//! Complexes and filtrations that any program wrote.

use std::io::ErrorKind;
use std::path::Path;

use crate::check::schema::{ComplexFile, FiltrationFile, PlacedComplex, SchemaError};
use crate::points::read_points;
use crate::shown::shown;
use anyhow::Context;

use super::said::{Said, refused, said};

/// Whether a file is a complex by its name: `.json` or `.npz`.
pub fn is_complex(path: &Path) -> bool {
    ComplexFile::is_named(path)
}

/// Whether a file holds a filtration.
pub fn is_filtration(path: &Path) -> bool {
    FiltrationFile::is_in(path)
}

/// Reads a filtration, with points (and weights, if it has some) from a file of their own if one is
/// given.
pub fn read_filtration(path: &Path, points: Option<&Path>) -> anyhow::Result<FiltrationFile> {
    let mut file = opened(path, FiltrationFile::open(path))?;
    if let Some(points) = points {
        let points = read_points(points, None)?;
        file.points = points.positions;
        file.weights = points.weights.or(file.weights);
    }
    match file.check() {
        Err(error) => Err(refusal(path, error)),
        Ok(()) => Ok(file),
    }
}

/// Reads a complex, with points (and weights, if it has some) from a file of their own if one is
/// given.
pub fn read(path: &Path, points: Option<&Path>) -> anyhow::Result<PlacedComplex> {
    let mut file = opened(path, ComplexFile::open(path))?;
    if let Some(points) = points {
        let points = read_points(points, None)?;
        file.points = points.positions;
        file.weights = points.weights.or(file.weights);
    }
    file.into_complex().map_err(|error| refusal(path, error))
}

/// What was read, or why it was not.
fn opened<T>(path: &Path, read: Result<T, SchemaError>) -> anyhow::Result<T> {
    match read {
        Ok(file) => Ok(file),
        Err(SchemaError::Extension) => {
            refused!("{}: a complex is read from .json or .npz", shown(path) => "see docs/cross-checking.md")
        }
        Err(SchemaError::Io(error)) => {
            let missing = error.kind() == ErrorKind::NotFound;
            let next = missing.then(|| "check the path".to_owned());
            Err(Said { next, ..said!("cannot read {}: {error}", shown(path)) }.into())
        }
        Err(other) => Err(other).with_context(|| shown(path)),
    }
}

/// Why what was read makes no complex.
fn refusal(path: &Path, error: SchemaError) -> anyhow::Error {
    match error {
        SchemaError::NoPoints => said!(
            "{}: the file lists no points", shown(path) =>
            "add `points`, or give them in a file of their own with --points"
        )
        .into(),
        other => anyhow::Error::new(other).context(shown(path)),
    }
}
