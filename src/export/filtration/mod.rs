//! Filtrations as files: every simplex and when it comes.

mod json;
mod npz;
mod text;

use std::fmt;
use std::io::{self, Write};
use std::path::Path;

use crate::ladder::Ordered;
use crate::volume::UnknownFormat;
use walpha_base::Monitor;

/// A format that filtrations are written in, chosen by file name extension.
#[derive(Clone, Copy)]
pub struct FiltrationFormat {
    /// For people.
    pub name: &'static str,
    /// Its extension, without the dot.
    pub extension: &'static str,
    /// What it holds.
    pub about: &'static str,
    write: fn(&Ordered<'_>, &mut dyn Write, &Monitor) -> io::Result<()>,
}

/// The formats there are. The [`schema`](crate::check::schema::FiltrationFile) of NPZ and JSON is that
/// which `walpha check` and `walpha compare` read.
pub static FILTRATION_FORMATS: [FiltrationFormat; 3] = [
    FiltrationFormat {
        name: "NPZ",
        extension: "npz",
        about: "NumPy arrays, compressed: points, simplices, their values and order, pairs.",
        write: npz::write,
    },
    FiltrationFormat {
        name: "JSON",
        extension: "json",
        about: "The same as text.",
        write: json::write,
    },
    FiltrationFormat {
        name: "text",
        extension: "txt",
        about: "A line for each simplex, in order: value, Gabriel or not, intervals, vertices.",
        write: text::write,
    },
];

impl FiltrationFormat {
    /// The format a path asks for.
    ///
    /// # Errors
    /// [`UnknownFormat`] names the ones there are.
    pub fn of(path: &Path) -> Result<&'static Self, UnknownFormat> {
        let all = FILTRATION_FORMATS.iter().map(|format| (format.extension, format));
        UnknownFormat::find(path, "a filtration", all)
    }

    /// Writes the whole file. The same filtration gives the same bytes. Of the pairs those are written
    /// whose simplices have different values.
    ///
    /// # Errors
    /// Whatever `out` returns; no memory.
    pub fn write(&self, ordered: &Ordered<'_>, out: &mut dyn Write) -> io::Result<()> {
        self.write_monitored(ordered, out, &Monitor::noop())
    }

    /// The same, which says how far it is and can be cancelled.
    ///
    /// # Errors
    /// Those of [`write`](Self::write), and one of the kind `Other` around [`Cancelled`](crate::progress::Cancelled).
    pub fn write_monitored(
        &self,
        ordered: &Ordered<'_>,
        out: &mut dyn Write,
        monitor: &Monitor,
    ) -> io::Result<()> {
        (self.write)(ordered, out, monitor)
    }
}

impl fmt::Debug for FiltrationFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FiltrationFormat").field("name", &self.name).finish_non_exhaustive()
    }
}

/// Those of some pairs whose simplices have different values.
fn lasting(ordered: &Ordered<'_>, pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    pairs.iter().copied().filter(|&pair| ordered.lasts(pair)).collect()
}
