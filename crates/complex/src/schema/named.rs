//! Triangulations under the names that other programs give their arrays.

use std::path::Path;

#[cfg(feature = "json")]
use super::json;
#[cfg(feature = "npz")]
use super::npz;
use super::open::{Format, open};
use super::{ComplexFile, SchemaError};

/// What others call points, as n×3 numbers: `SciPy`, distmesh and scikit-fem, trimesh.
const POINTS: [&str; 3] = ["points", "p", "vertices"];
/// What others call tetrahedra: `SciPy`, meshio, distmesh and scikit-fem.
const CELLS: [&str; 3] = ["simplices", "tetra", "t"];
/// Our own name, which is one of a triangulation only beside these.
const OUR_CELLS: &str = "cells";
const BESIDE: [&str; 5] = ["points", "p", "vertices", "weights", OUR_CELLS];

impl ComplexFile {
    /// Reads a file whose points and cells have the names that others use, or that has no more than these two and weights,
    /// with α = ∞ if it states none. `None` for a file of other names.
    pub(super) fn open_named(path: &Path) -> Result<Option<Self>, SchemaError> {
        match Format::of(path) {
            None => Ok(None),
            #[cfg(feature = "json")]
            Some(Format::Json) => {
                let names = names_of(&json::names(open(path)?));
                names.map(|names| json::read_named(open(path)?, names)).transpose()
            }
            #[cfg(feature = "npz")]
            Some(Format::Npz) => {
                let names = names_of(&npz::names(open(path)?));
                names.map(|names| npz::read_named(open(path)?, names)).transpose()
            }
        }
    }
}

/// The names of points and cells among those of a file.
fn names_of(names: &[String]) -> Option<[&'static str; 2]> {
    let first_of = |known: &[&'static str]| {
        known.iter().copied().find(|known| names.iter().any(|name| name == known))
    };
    let is_bare = names.iter().all(|name| BESIDE.contains(&&name[..]));
    let cells = first_of(&CELLS).or_else(|| first_of(&[OUR_CELLS]).filter(|_| is_bare));
    Some([first_of(&POINTS)?, cells?])
}
