//! A folder that results go to.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use walpha_base::shown::shown;

use crate::export::{Filled, NewFolder, Target, put_all};

use super::errors::{CommandError, command_error};

/// The folder results go to: found writable before the long work. All files appear in it at the end,
/// or none.
pub(super) struct Folder {
    path: PathBuf,
    files: Vec<Filled>,
    written: Vec<String>,
    /// It is ours, to be taken away again if nothing comes of it: after the files.
    new: Option<NewFolder>,
}

/// Makes a folder if it is not there; `instead` says how another is chosen.
pub(super) fn make(path: &Path, instead: &str) -> Result<Option<NewFolder>, CommandError> {
    NewFolder::make(path).map_err(|error| {
        command_error!("cannot make the folder {}: {error}", shown(path) => "choose another {instead}")
    })
}

impl Folder {
    /// Makes the folder if it is not there; `option` names the option it was given by, `names` files
    /// that will be written for certain.
    pub(super) fn open(path: &Path, option: &str, names: &[&str]) -> anyhow::Result<Self> {
        let new = make(path, &format!("with {option}"))?;
        let folder = Self { path: path.to_owned(), files: Vec::new(), written: Vec::new(), new };
        for name in names {
            Target::open(&path.join(name))?;
        }
        Ok(folder)
    }

    /// Writes a file, which appears when all are finished; says how many bytes it has.
    pub(super) fn write(
        &mut self,
        name: &str,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> anyhow::Result<u64> {
        let path = self.path.join(name);
        let filled = Target::open(&path)?.fill(content)?;
        let bytes = filled.bytes();
        self.written.push(path.display().to_string());
        self.files.push(filled);
        Ok(bytes)
    }

    /// The paths of the files written so far.
    pub(super) fn written(&self) -> &[String] {
        &self.written
    }

    /// Puts all files in their places.
    pub(super) fn finish(self) -> anyhow::Result<()> {
        put_all(self.files)?;
        if let Some(new) = self.new {
            new.keep();
        }
        Ok(())
    }
}
