//! The destination of a file, and the claim that no other target has the same one.

use std::fs::{self, Metadata, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use walpha_base::shown::shown;

use crate::identity::{Key, behind_links, folder};
use crate::inputs;
use crate::unfinished::gate;

/// The destination of a file, with all links followed unless they are replaced, and the metadata of an existing file.
#[derive(Debug)]
pub(super) struct Destination {
    pub path: PathBuf,
    pub existing: Option<Metadata>,
}

impl Destination {
    /// Refuses at once what would fail later: a missing folder, a name that is too long, a
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
                // The system lets root write to files that are write-protected.
                if existing.permissions().readonly() {
                    let what = "it exists and is write-protected";
                    return Err(io::Error::new(ErrorKind::PermissionDenied, what));
                }
                OpenOptions::new().write(true).open(&path)?;
            }
            Some(_) => {}
        }
        Ok(Self { path, existing })
    }

    /// Prepares a destination at which anything but a folder is replaced: links are not followed, and a file that has other names
    /// is not overwritten.
    pub(super) fn replacing(path: &Path) -> io::Result<Self> {
        match fs::symlink_metadata(path) {
            Ok(existing) if existing.is_dir() => Err(ErrorKind::IsADirectory.into()),
            Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
            _ => Ok(Self { path: path.to_owned(), existing: None }),
        }
    }

    /// Whether the destination is a pipe, a device or the like, which is written directly.
    pub(super) fn is_stream(&self) -> bool {
        self.existing.as_ref().is_some_and(|existing| !existing.is_file())
    }

    pub(super) fn folder(&self) -> &Path {
        folder(&self.path)
    }
}

/// A destination that belongs to one target until this is dropped.
#[derive(Debug)]
pub(super) struct Claim(Key);

impl Claim {
    /// Refuses a destination that another target is open for: one of the two files would be lost.
    pub(super) fn of(destination: &Destination) -> io::Result<Self> {
        let key = Key::at(&destination.path, destination.existing.as_ref())?;
        inputs::check(&key)?;
        Self::new(key)
    }

    /// Claims standard output, like [`of`](Self::of) a destination.
    pub(super) fn of_stdout() -> io::Result<Self> {
        Self::new(Key::of_stdout())
    }

    fn new(key: Key) -> io::Result<Self> {
        let mut gate = gate();
        if gate.claimed.iter().any(|other| key.is(other)) {
            return Err(io::Error::new(
                ErrorKind::AlreadyExists,
                "it is the destination of another output, too",
            ));
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
