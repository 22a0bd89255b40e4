//! Complexes and filtrations that any program wrote.

use std::io::ErrorKind;
use std::path::Path;

use anyhow::Context;
use walpha_base::shown::shown;

use crate::check::schema::{AnyFile, ComplexFile, FiltrationFile, PlacedComplex, SchemaError};
use crate::points::read_points;

use super::said::{Said, refused, said};

/// What a file holds, to be judged or compared.
#[expect(clippy::large_enum_variant, reason = "there are one or two, moved a few times")]
pub(super) enum Judged {
    /// A complex, whose fields fit together.
    Complex(PlacedComplex),
    /// A filtration, whose fields fit together.
    Filtration(FiltrationFile),
}

/// Whether a file is a complex or filtration by its name: `.json` or `.npz`.
pub(super) fn is_named(path: &Path) -> bool {
    ComplexFile::is_named(path)
}

/// Reads a complex or filtration, with points (and weights, if it has some) from a file of their own
/// if one is given.
pub(super) fn read(path: &Path, points: Option<&Path>) -> anyhow::Result<Judged> {
    let mut file = opened(path)?;
    if let Some(points) = points {
        let points = read_points(points, None)?;
        let (positions, weights) = match &mut file {
            AnyFile::Complex(file) => (&mut file.points, &mut file.weights),
            AnyFile::Filtration(file) => (&mut file.points, &mut file.weights),
        };
        *positions = points.positions;
        *weights = points.weights.or(weights.take());
    }
    let judged = match file {
        AnyFile::Complex(file) => PlacedComplex::try_from(file).map(Judged::Complex),
        AnyFile::Filtration(file) => file.check().map(|()| Judged::Filtration(file)),
    };
    judged.map_err(|error| refusal(path, error))
}

/// What was read, or why it was not.
fn opened(path: &Path) -> anyhow::Result<AnyFile> {
    match AnyFile::open(path) {
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

/// Why the fields of a file do not fit together.
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
