//! A lock on a folder that other processes can see.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use crate::unfinished::{Entry, gate};

/// A lock file: it tells other processes that this one is at work. The lock ends with the process, however that ends. On Unix it
/// is `flock`, which network file systems may not pass on to other machines.
///
/// If it is dropped before it is [kept](Self::keep), or the process is interrupted, a new file is removed.
#[derive(Debug)]
pub struct Lock {
    file: Option<File>,
    path: PathBuf,
    /// The entry of a new file.
    entry: Option<&'static Entry>,
}

impl Lock {
    /// Makes a file and locks it.
    ///
    /// # Errors
    /// Errors of the file system; the file exists already.
    pub fn make(path: &Path) -> io::Result<Self> {
        let path = std::path::absolute(path)?;
        let mut gate = gate();
        let entry = gate.enter(&path, false)?;
        let made = locked(OpenOptions::new().write(true).create_new(true), &path);
        let file = made.inspect_err(|_| entry.finish())?;
        Ok(Self { file, path, entry: Some(entry) })
    }

    /// Locks an existing file; `None` if another process has locked it.
    ///
    /// # Errors
    /// Errors of the file system; the file does not exist.
    pub fn take(path: &Path) -> io::Result<Option<Self>> {
        let path = std::path::absolute(path)?;
        let locked = locked(OpenOptions::new().write(true), &path)?;
        Ok(locked.map(|file| Self { file: Some(file), path, entry: None }))
    }

    /// Keeps the file instead of removing it when this is dropped.
    pub fn keep(&mut self) {
        if let Some(entry) = self.entry.take() {
            entry.finish();
        }
    }

    /// Removes the file.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn remove(mut self) -> io::Result<()> {
        self.keep();
        // Some systems cannot remove a file while it is open.
        self.file = None;
        fs::remove_file(&self.path)
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        let _gate = gate();
        if let Some(entry) = self.entry {
            self.file = None;
            let _ = fs::remove_file(&self.path);
            entry.finish();
        }
    }
}

#[cfg(unix)]
fn locked(options: &mut OpenOptions, path: &Path) -> io::Result<Option<File>> {
    use rustix::fs::{FlockOperation, OFlags, flock};
    use std::os::unix::fs::OpenOptionsExt;
    let file = options.custom_flags(OFlags::NOFOLLOW.bits().cast_signed()).open(path)?;
    match flock(&file, FlockOperation::NonBlockingLockExclusive) {
        Ok(()) => Ok(Some(file)),
        Err(rustix::io::Errno::WOULDBLOCK) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

#[cfg(windows)]
fn locked(options: &mut OpenOptions, path: &Path) -> io::Result<Option<File>> {
    use std::os::windows::fs::OpenOptionsExt;
    /// The error of opening a file that another process has open without sharing it.
    const SHARING_VIOLATION: i32 = 32;
    match options.share_mode(0).open(path) {
        Ok(file) => Ok(Some(file)),
        Err(error) if error.raw_os_error() == Some(SHARING_VIOLATION) => Ok(None),
        Err(error) => Err(error),
    }
}

/// For platforms without other processes.
#[cfg(not(any(unix, windows)))]
fn locked(options: &mut OpenOptions, path: &Path) -> io::Result<Option<File>> {
    options.open(path).map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_holds_a_lock_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lock");
        assert_eq!(Lock::take(&path).unwrap_err().kind(), io::ErrorKind::NotFound);
        drop(Lock::make(&path).unwrap());
        assert!(!path.exists(), "a file that is not kept is removed");
        let mut first = Lock::make(&path).unwrap();
        assert_eq!(Lock::make(&path).unwrap_err().kind(), io::ErrorKind::AlreadyExists);
        assert!(Lock::take(&path).unwrap().is_none());
        first.keep();
        drop(first);
        let second = Lock::take(&path).unwrap().expect("nobody holds it");
        assert!(Lock::take(&path).unwrap().is_none());
        second.remove().unwrap();
        assert!(!path.exists());
    }
}
