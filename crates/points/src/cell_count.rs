//! The numbers of cells in a file, as `info` reports them.

use std::fmt;

use serde::Serialize;

/// The number of cells of one kind in a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct CellCount {
    /// The name of the kind, in the plural: tetrahedra, faces.
    pub kind: &'static str,
    /// The number of cells.
    pub count: usize,
}

/// Displays the count, for example `200 tetrahedra`.
impl fmt::Display for CellCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, count } = self;
        write!(f, "{count} {kind}")
    }
}

impl CellCount {
    pub(super) fn new(kind: &'static str, count: usize) -> Self {
        Self { kind, count }
    }
}
