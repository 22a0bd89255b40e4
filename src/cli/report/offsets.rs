//! The offsets that files in single precision have subtracted from coordinates.

use std::fmt;
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
        Told::default().offset(path, exporter, shape)
    }
}

/// Whether an offset of several files, and that one of them does not represent its mesh, have been told: each is told once.
#[derive(Default)]
pub(crate) struct Told {
    offset: bool,
    lossy: bool,
}

impl Told {
    /// Like [`FileOffset::of`], of one of several files.
    pub(crate) fn offset(
        &mut self,
        path: &Path,
        exporter: &dyn Exporter,
        shape: &AlphaShape,
    ) -> Option<FileOffset> {
        let single = exporter.single_precision(shape)?;
        let is_news = single.has_offset() && !self.offset || single.is_lossy && !self.lossy;
        if let Some(remark) = single.remark().filter(|_| is_news) {
            tracing::warn!("{}: {remark}", shown(path));
        }
        self.offset |= single.has_offset();
        self.lossy |= single.is_lossy;
        single
            .has_offset()
            .then(|| FileOffset { file: path.display().to_string(), offset: single.offset })
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

/// Prints a line for each offset, with the first file that has it, and how many more do.
pub(crate) fn print_offsets<'a>(
    offsets: impl IntoIterator<Item = &'a FileOffset>,
    f: &mut fmt::Formatter<'_>,
) -> fmt::Result {
    let offsets: Vec<&FileOffset> = offsets.into_iter().collect();
    for alike in offsets.chunk_by(|one, next| one.offset == next.offset) {
        let [x, y, z] = alike[0].offset.map(number);
        write!(
            f,
            "offset    {x}, {y}, {z} is subtracted from x, y, z in {}",
            name(&alike[0].file)
        )?;
        match alike.len() - 1 {
            0 => writeln!(f)?,
            more => writeln!(f, " and {more} more")?,
        }
    }
    Ok(())
}
