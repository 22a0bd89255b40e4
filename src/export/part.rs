//! Files that are not complete yet, and how they go when the process is interrupted.

use std::collections::BTreeSet;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

/// The parts there are now. Held while one comes or goes.
static PARTS: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn parts() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    PARTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every file that is not complete, and ends the process before another can appear. For the
/// handler of an interrupt: files that stand under their names are complete.
pub fn abandon(code: i32) -> ! {
    let parts = parts();
    for part in parts.iter() {
        // It may have gone by itself; there is nobody to tell.
        let _ = std::fs::remove_file(part);
    }
    std::process::exit(code)
}

/// A temporary file beside the one it is to become.
#[derive(Debug)]
pub(super) struct Part {
    file: Option<NamedTempFile>,
    path: PathBuf,
}

impl Part {
    pub fn beside(path: &Path) -> io::Result<Self> {
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".walpha-").suffix(".part");
        // Temporary files are private by default; this one becomes an ordinary file.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut parts = parts();
        // Without the name of the temporary file, which means nothing to anybody.
        let file = builder.tempfile_in(folder).map_err(|error| io::Error::from(error.kind()))?;
        let path = file.path().to_owned();
        parts.insert(path.clone());
        Ok(Self { file: Some(file), path })
    }

    pub fn fill(
        mut self,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<Self> {
        if let Some(file) = &mut self.file {
            // The file itself: its errors do not name it.
            let mut buffered = BufWriter::new(file.as_file_mut());
            content(&mut buffered)?;
            buffered.flush()?;
        }
        Ok(self)
    }

    /// Gives the file its name.
    pub fn put(mut self, path: &Path) -> io::Result<()> {
        let Some(file) = self.file.take() else { return Ok(()) };
        let mut parts = parts();
        file.persist(path).map_err(|refused| refused.error)?;
        parts.remove(&self.path);
        Ok(())
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        let mut parts = parts();
        self.file = None;
        parts.remove(&self.path);
    }
}
