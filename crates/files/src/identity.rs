//! Decides whether two paths name one file.

use std::fs::{self, Metadata};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// The path that means standard output.
pub(super) const STDOUT: &str = "-";

/// The folder that contains a file.
pub(super) fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// The path that symbolic links lead to. The file itself need not exist.
pub(super) fn behind_links(path: &Path) -> PathBuf {
    /// The limit of Linux on links in one path.
    const MOST_LINKS: usize = 40;
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(link) = fs::read_link(&path) else { break };
        path = folder(&path).join(link);
    }
    path
}

/// The identity of a file or destination.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Key {
    pub path: PathBuf,
    /// The device and inode of an existing file. Hard links to one file share them.
    file: Option<(u64, u64)>,
}

impl Key {
    /// The key of a path whose folder exists, with links followed.
    pub(super) fn of(path: &Path) -> io::Result<Self> {
        let path = behind_links(path);
        Self::at(&path, fs::metadata(&path).ok().as_ref())
    }

    /// The key of a path whose folder exists, and of the file that is there; a last link is not followed.
    pub(super) fn at(path: &Path, existing: Option<&Metadata>) -> io::Result<Self> {
        let name = path.file_name().ok_or(ErrorKind::InvalidFilename)?;
        Ok(Self {
            path: fs::canonicalize(folder(path))?.join(name),
            file: existing.and_then(number),
        })
    }

    /// The key of an existing file.
    pub(super) fn of_existing(path: &Path) -> Option<Self> {
        let file = fs::metadata(path).ok().as_ref().and_then(number);
        fs::canonicalize(path).ok().map(|path| Self { path, file })
    }

    /// The key of standard output.
    pub(super) fn of_stdout() -> Self {
        Self { path: STDOUT.into(), file: None }
    }

    /// Whether both are the same file.
    pub(super) fn is(&self, other: &Self) -> bool {
        self.path == other.path || self.file.is_some() && self.file == other.file
    }
}

#[cfg(unix)]
#[expect(clippy::unnecessary_wraps, reason = "elsewhere there is none")]
fn number(existing: &Metadata) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    Some((existing.dev(), existing.ino()))
}

#[cfg(not(unix))]
fn number(_: &Metadata) -> Option<(u64, u64)> {
    None
}
