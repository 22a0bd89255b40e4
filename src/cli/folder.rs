//! A folder that results go to.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use walpha::export::Target;

/// The folder results go to: found writable before the long work.
pub struct Folder {
    path: PathBuf,
    /// Whether it is ours, to be taken away again if nothing comes of it.
    made: bool,
    written: Vec<String>,
}

impl Folder {
    /// Makes the folder if it is not there; `option` names the option it was given by.
    pub fn open(path: &Path, option: &str) -> anyhow::Result<Self> {
        let made = match fs::create_dir(path) {
            Ok(()) => true,
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && path.is_dir() => false,
            Err(error) => {
                let path = path.display();
                return Err(anyhow!(
                    "cannot make the folder {path}: {error}; choose another with {option}"
                ));
            }
        };
        let folder = Self { path: path.to_owned(), made, written: Vec::new() };
        Target::open(&path.join("report"))?;
        Ok(folder)
    }

    /// Writes a file, complete or not at all; says how many bytes it has.
    pub fn write(
        &mut self,
        name: &str,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> anyhow::Result<u64> {
        let path = self.path.join(name);
        Target::open(&path)?.write(content)?;
        self.written.push(path.display().to_string());
        Ok(fs::metadata(&path)?.len())
    }

    /// The paths of the files written so far.
    pub fn written(&self) -> &[String] {
        &self.written
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if self.made && self.written.is_empty() {
            // Only if it is empty.
            let _ = fs::remove_dir(&self.path);
        }
    }
}
