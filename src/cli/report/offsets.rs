//! The offsets that files in single precision have subtracted from coordinates.

use std::fmt::{self, Display};
use std::path::Path;

use serde::Serialize;
use walpha_base::shown::{number, shown};

use crate::AlphaShape;
use crate::cli::process::output::name;
use crate::export::{Exporter, Target};

/// A file whose coordinates are those of the points minus an offset.
#[derive(Serialize)]
pub(crate) struct FileOffset {
    file: String,
    /// The offset along x, y and z, in the unit of the points.
    offset: [f64; 3],
}

impl FileOffset {
    /// The offset of a file, if it has one. Warns about the offset, or that single precision does not represent the mesh.
    pub(crate) fn of(path: &Path, exporter: &dyn Exporter, shape: &AlphaShape) -> Option<Self> {
        let single = exporter.single_precision(shape)?;
        tracing::warn!("{}: {}", shown(path), single.remark()?);
        Self::quietly(path, exporter, shape)
    }

    /// Like [`of`](Self::of), without a warning.
    pub(crate) fn quietly(
        path: &Path,
        exporter: &dyn Exporter,
        shape: &AlphaShape,
    ) -> Option<Self> {
        let single = exporter.single_precision(shape)?;
        single
            .has_offset()
            .then(|| Self { file: path.display().to_string(), offset: single.offset })
    }
}

/// The offsets of the files of a shape.
pub(crate) fn offsets(
    files: &[(Target, Box<dyn Exporter>)],
    shape: &AlphaShape,
) -> Vec<FileOffset> {
    let of = |(target, exporter): &(Target, Box<dyn Exporter>)| {
        FileOffset::of(target.path(), exporter.as_ref(), shape)
    };
    files.iter().filter_map(of).collect()
}

impl Display for FileOffset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.offset.map(number);
        writeln!(f, "offset    {x}, {y}, {z} is subtracted from x, y, z in {}", name(&self.file))
    }
}
