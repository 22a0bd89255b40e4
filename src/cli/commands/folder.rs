//! The output folder of a command.

use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use walpha_base::shown::shown;

use crate::export::{self, Filled, NewFolder, Target, put_all};
use crate::points;

use crate::cli::process::errors::{Result, command_error, fail_usage};

/// An output folder, checked to be writable before the long work. At the end all files appear in it, or none.
pub(crate) struct Folder {
    path: PathBuf,
    files: Vec<Filled>,
    written: Vec<String>,
    /// The folder, if this command created it: it is removed on failure, after the files.
    new: Option<NewFolder>,
}

/// The extensions of pages and pictures, which no table of formats lists.
const PAGES_AND_PICTURES: [&str; 2] = ["html", "png"];

/// Whether a folder has the extension of a file by mistake: of a shape, of points, or of another output of commands.
fn is_of_file(extension: &OsStr) -> bool {
    let of_shapes = export::FORMATS.iter().map(|format| format.extension);
    let of_points = points::FORMATS.iter().flat_map(|format| format.extensions).copied();
    let mut all = of_shapes.chain(of_points).chain(PAGES_AND_PICTURES);
    all.any(|of_file| extension.eq_ignore_ascii_case(of_file))
}

/// Creates a folder if needed; `instead` tells the user how to choose another.
pub(crate) fn make(path: &Path, instead: &str) -> Result<Option<NewFolder>> {
    NewFolder::make(path).map_err(|error| {
        command_error!("cannot make the folder {}: {error}", shown(path) => "choose another {instead}")
    })
}

impl Folder {
    /// Creates the folder if needed. `option` is the option that names it; `names` are files that are certain to be written.
    pub(crate) fn open(path: &Path, option: &str, names: &[&str]) -> Result<Self> {
        if let Some(extension) = path.extension().filter(|_| !path.is_dir())
            && is_of_file(extension)
        {
            let folder = path.with_extension("");
            fail_usage!("{option} takes a folder, and {} is named as a file", shown(path) => "name a folder, as in {option} {}", shown(&folder));
        }
        let new = make(path, &format!("with {option}"))?;
        let folder = Self { path: path.to_owned(), files: Vec::new(), written: Vec::new(), new };
        for name in names {
            Target::open(path.join(name))?;
        }
        Ok(folder)
    }

    /// Writes a file, which appears when all files are complete; returns its size in bytes.
    pub(crate) fn write(
        &mut self,
        name: &str,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<u64> {
        let path = self.path.join(name);
        let filled = Target::open(&path)?.fill(content)?;
        let bytes = filled.bytes();
        self.written.push(path.display().to_string());
        self.files.push(filled);
        Ok(bytes)
    }

    /// The paths of the files written so far.
    pub(crate) fn written(&self) -> &[String] {
        &self.written
    }

    /// Moves all files into place.
    pub(crate) fn finish(self) -> Result<()> {
        put_all(self.files)?;
        if let Some(new) = self.new {
            new.keep();
        }
        Ok(())
    }
}
