//! Where a file will be, and whether two names are one place.

use std::fs::{self, Metadata, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use walpha_base::shown::shown;

use crate::inputs;
use crate::unfinished::gate;

/// A place for a file, with all links followed, and what is there now.
#[derive(Debug)]
pub(super) struct Destination {
    pub path: PathBuf,
    pub existing: Option<Metadata>,
}

impl Destination {
    /// Refuses at once what can be known to fail later: a missing folder, a name that is too long, a
    /// folder or a write-protected file of this name.
    pub(super) fn of(path: &Path) -> io::Result<Self> {
        let existing = match fs::metadata(path) {
            Ok(existing) => Some(existing),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return Err(error),
        };
        let path = behind_links(path);
        match &existing {
            None => {
                let folder = folder(&path);
                if !folder.exists() {
                    let what = format!("there is no folder {}", shown(folder));
                    return Err(io::Error::new(ErrorKind::NotFound, what));
                }
            }
            Some(existing) if existing.is_dir() => return Err(ErrorKind::IsADirectory.into()),
            Some(existing) if existing.is_file() => {
                // The system lets root write to files that nobody may write to.
                if existing.permissions().readonly() {
                    let what = "it is there and write-protected";
                    return Err(io::Error::new(ErrorKind::PermissionDenied, what));
                }
                OpenOptions::new().write(true).open(&path)?;
            }
            Some(_) => {}
        }
        Ok(Self { path, existing })
    }

    /// Whether it is a pipe, a device or the like, which is written to directly.
    pub(super) fn is_stream(&self) -> bool {
        self.existing.as_ref().is_some_and(|existing| !existing.is_file())
    }

    pub(super) fn folder(&self) -> &Path {
        folder(&self.path)
    }
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// The path that links of this name lead to, whether it exists or not.
fn behind_links(path: &Path) -> PathBuf {
    /// As many as Linux follows.
    const MOST_LINKS: usize = 40;
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(link) = fs::read_link(&path) else { break };
        path = folder(&path).join(link);
    }
    path
}

/// The identity of a place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Key {
    pub path: PathBuf,
    /// Device and inode of an existing file: hard links are one file.
    file: Option<(u64, u64)>,
}

impl Key {
    /// That of a place, whose folder is there.
    pub(super) fn of(path: &Path) -> io::Result<Self> {
        let path = behind_links(path);
        let name = path.file_name().ok_or(ErrorKind::InvalidFilename)?;
        let file = fs::metadata(&path).ok().as_ref().and_then(number);
        Ok(Self { path: fs::canonicalize(folder(&path))?.join(name), file })
    }

    /// That of a file that is there.
    pub(super) fn of_existing(path: &Path) -> Option<Self> {
        let file = fs::metadata(path).ok().as_ref().and_then(number);
        fs::canonicalize(path).ok().map(|path| Self { path, file })
    }

    /// Whether two places are one.
    pub(super) fn is(&self, other: &Self) -> bool {
        self.path == other.path || self.file.is_some() && self.file == other.file
    }
}

/// A place that is one target's alone, until this is dropped.
#[derive(Debug)]
pub(super) struct Claim(Key);

impl Claim {
    /// Refuses a place that another target is open for: one of the two files would be lost.
    pub(super) fn of(place: &Destination) -> io::Result<Self> {
        let key = Key::of(&place.path)?;
        inputs::check(&key)?;
        Self::new(key)
    }

    /// The same for standard output.
    pub(super) fn of_stdout() -> io::Result<Self> {
        Self::new(Key { path: crate::Target::STDOUT.into(), file: None })
    }

    fn new(key: Key) -> io::Result<Self> {
        let mut gate = gate();
        if gate.claimed.iter().any(|other| key.is(other)) {
            return Err(io::Error::new(ErrorKind::AlreadyExists, "another output goes there, too"));
        }
        gate.claimed.push(key.clone());
        Ok(Self(key))
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        let claimed = &mut gate().claimed;
        if let Some(at) = claimed.iter().position(|key| *key == self.0) {
            claimed.swap_remove(at);
        }
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
