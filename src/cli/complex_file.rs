//! Complexes and filtrations that any program wrote.

use std::fs::File;
use std::io::{BufReader, ErrorKind};
use std::path::Path;

use anyhow::{Context, bail};
use walpha::check::schema::{ComplexFile, FiltrationFile, PlacedComplex};
use walpha::points::read_points;
use walpha::shown::shown;

/// Whether a file is a complex by its name: `.json` or `.npz`.
pub fn is_complex(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    extension == "json" || extension == "npz"
}

/// Whether such a file holds a filtration.
pub fn is_filtration(path: &Path) -> bool {
    let Ok(file) = File::open(path) else { return false };
    if is_json(path) { FiltrationFile::is_json(file) } else { FiltrationFile::is_npz(file) }
}

/// Reads a filtration, with points (and weights, if it has some) from a file of their own if one is
/// given.
pub fn read_filtration(path: &Path, points: Option<&Path>) -> anyhow::Result<FiltrationFile> {
    let file = BufReader::new(open(path)?);
    let json = is_json(path);
    let file = if json { FiltrationFile::read_json(file) } else { FiltrationFile::read_npz(file) };
    let mut file = file.with_context(|| shown(path))?;
    if let Some(points) = points {
        let points = read_points(points, None)?;
        file.points = points.positions;
        file.weights = points.weights.or(file.weights);
    }
    Ok(file)
}

fn is_json(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"))
}

fn open(path: &Path) -> anyhow::Result<File> {
    File::open(path).map_err(|error| {
        let hint = if error.kind() == ErrorKind::NotFound { "; check the path" } else { "" };
        anyhow::anyhow!("cannot read {}: {error}{hint}", shown(path))
    })
}

/// Reads a complex, with points (and weights, if it has some) from a file of their own if one is
/// given.
pub fn read(path: &Path, points: Option<&Path>) -> anyhow::Result<PlacedComplex> {
    if !is_complex(path) {
        bail!("{}: a complex is read from .json or .npz; see docs/cross-checking.md", shown(path));
    }
    let file = BufReader::new(open(path)?);
    let file =
        if is_json(path) { ComplexFile::read_json(file) } else { ComplexFile::read_npz(file) };
    let mut file = file.with_context(|| shown(path))?;
    if let Some(points) = points {
        let points = read_points(points, None)?;
        file.points = points.positions;
        file.weights = points.weights.or(file.weights);
    }
    file.into_complex().with_context(|| shown(path))
}
