//! Complexes that any program wrote.

use std::fs::File;
use std::io::{BufReader, ErrorKind};
use std::path::Path;

use super::said::{Said, refused, said};
use anyhow::Context;
use walpha::check::schema::{ComplexFile, PlacedComplex};
use walpha::points::read_points;
use walpha::shown::shown;

/// Whether a file is a complex by its name: `.json` or `.npz`.
pub fn is_complex(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    extension == "json" || extension == "npz"
}

/// Reads a complex, with points (and weights, if it has some) from a file of their own if one is
/// given.
pub fn read(path: &Path, points: Option<&Path>) -> anyhow::Result<PlacedComplex> {
    if !is_complex(path) {
        refused!("{}: a complex is read from .json or .npz", shown(path) => "see docs/cross-checking.md");
    }
    let named = |error: std::io::Error| {
        let missing = error.kind() == ErrorKind::NotFound;
        let next = missing.then(|| "check the path".to_owned());
        Said { next, ..said!("cannot read {}: {error}", shown(path)) }
    };
    let file = BufReader::new(File::open(path).map_err(named)?);
    let json = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
    let file = if json { ComplexFile::read_json(file) } else { ComplexFile::read_npz(file) };
    let mut file = file.with_context(|| shown(path))?;
    if let Some(points) = points {
        let points = read_points(points, None)?;
        file.points = points.positions;
        file.weights = points.weights.or(file.weights);
    }
    file.into_complex().with_context(|| shown(path))
}
