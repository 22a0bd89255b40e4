use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// A file to be: opened before the long work, so that a bad place is known at once, and put under
/// its name only when it is complete. Dropped before that, it leaves nothing behind.
#[derive(Debug)]
pub struct Target {
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
}

/// A file cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {why}; nothing was left behind, choose a place with room that you may write to", path.display())]
pub struct TargetError {
    path: PathBuf,
    why: io::Error,
}

impl Target {
    /// Opens a temporary file in the folder of `path`.
    ///
    /// # Errors
    /// When the folder does not exist or cannot be written, or `path` is a folder itself.
    pub fn open(path: &Path) -> Result<Self, TargetError> {
        let fail = |why| TargetError { path: path.to_owned(), why };
        if path.is_dir() {
            return Err(fail(io::Error::from(io::ErrorKind::IsADirectory)));
        }
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".walpha-").suffix(".part");
        // Temporary files are private by default; this one becomes an ordinary file.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        // The name of the temporary file, which the error tells, means nothing to anybody.
        let file = builder.tempfile_in(folder).map_err(|why| fail(why.kind().into()))?;
        Ok(Self { path: path.to_owned(), file: BufWriter::new(file) })
    }

    /// Where the file will stand.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the content and puts the file in its place, replacing what stood there.
    ///
    /// # Errors
    /// What the system said, with the path; the place is then as it was.
    pub fn write(
        self,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), TargetError> {
        let Self { path, mut file } = self;
        let finish = || -> io::Result<()> {
            content(&mut file)?;
            file.flush()
        };
        if let Err(why) = finish() {
            return Err(TargetError { path, why });
        }
        let persisted: Result<File, io::Error> = file
            .into_inner()
            .map_err(|e| e.into_error())
            .and_then(|temporary| temporary.persist(&path).map_err(|refused| refused.error));
        match persisted {
            Ok(_) => Ok(()),
            Err(why) => Err(TargetError { path, why }),
        }
    }
}
