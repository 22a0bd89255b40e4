//! Unfinished files, and their removal when the process ends early.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use tempfile::TempPath;

use crate::identity::Key;

/// A file or folder that is removed unless it is finished. Entries are never freed, and their list is read without a lock, as a
/// signal handler may read it at any moment.
#[derive(Debug)]
pub(super) struct Entry {
    name: Name,
    folder: bool,
    unfinished: AtomicBool,
    next: OnceLock<&'static Entry>,
}

/// A path in the form that the system takes, so that removing it needs no memory.
#[cfg(unix)]
type Name = std::ffi::CString;
#[cfg(not(unix))]
type Name = PathBuf;

static FIRST: OnceLock<&'static Entry> = OnceLock::new();

/// The outputs of the run. Locked while a file or folder is made or removed.
#[derive(Debug, Default)]
pub(super) struct Gate {
    last: Option<&'static Entry>,
    /// The files that targets are open for.
    pub claimed: Vec<Key>,
}

pub(super) fn gate() -> MutexGuard<'static, Gate> {
    static GATE: Mutex<Gate> = Mutex::new(Gate { last: None, claimed: Vec::new() });
    GATE.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Gate {
    /// Enters a path before a file or folder is created there.
    pub(super) fn enter(&mut self, path: &Path, folder: bool) -> io::Result<&'static Entry> {
        let (unfinished, next) = (AtomicBool::new(true), OnceLock::new());
        let entry: &Entry =
            Box::leak(Box::new(Entry { name: name(path)?, folder, unfinished, next }));
        let place = self.last.map_or(&FIRST, |last| &last.next);
        place.set(entry).expect("the last entry has no next");
        self.last = Some(entry);
        Ok(entry)
    }
}

impl Entry {
    /// Marks the file or folder as complete or removed.
    pub(super) fn finish(&self) {
        self.unfinished.store(false, Ordering::Release);
    }

    fn remove(&self) {
        // It may have been removed already; a failure cannot be reported here.
        #[cfg(unix)]
        let _ = if self.folder {
            rustix::fs::rmdir(&*self.name)
        } else {
            rustix::fs::unlink(&*self.name)
        };
        #[cfg(not(unix))]
        let _ = match self.folder {
            true => fs::remove_dir(&self.name),
            false => fs::remove_file(&self.name),
        };
    }
}

#[cfg(unix)]
fn name(path: &Path) -> io::Result<Name> {
    use std::os::unix::ffi::OsStrExt;
    Ok(Name::new(path.as_os_str().as_bytes())?)
}

#[cfg(not(unix))]
fn name(path: &Path) -> io::Result<Name> {
    Ok(path.to_owned())
}

/// Removes every incomplete file, and every folder that was created for such files and contains no others. On Unix this takes no
/// lock, allocates no memory, and calls only `unlink` and `rmdir`: any signal handler may call it if the process ends then.
pub fn sweep() {
    // Files come first, so that their folders are empty.
    for folders in [false, true] {
        let mut next = FIRST.get();
        while let Some(entry) = next {
            if entry.folder == folders && entry.unfinished.load(Ordering::Acquire) {
                entry.remove();
            }
            next = entry.next.get();
        }
    }
}

/// Removes everything incomplete, and ends the process before another file can appear. This is for the handler of an interrupt,
/// in a separate thread. Files under their final names are complete.
pub fn abandon(code: i32) -> ! {
    let _never_unlocked = gate();
    sweep();
    std::process::exit(code)
}

/// A file that is removed when it is dropped, and also when the process is interrupted.
#[derive(Debug)]
pub(super) struct Temporary {
    path: Option<TempPath>,
    entry: &'static Entry,
}

impl Temporary {
    /// Creates a temporary file in a folder by `create`. Errors do not contain its name, which means nothing to users.
    pub(super) fn make(
        names: &tempfile::Builder<'_, '_>,
        folder: &Path,
        create: impl Fn(&Path) -> io::Result<fs::File>,
    ) -> io::Result<(fs::File, Self)> {
        let mut gate = gate();
        let mut entry = None;
        // The entry is made before the file exists, so that a signal handler never misses it.
        let made = names.make_in(folder, |path| {
            let entered = gate.enter(path, false)?;
            let file = create(path).inspect_err(|_| entered.finish())?;
            entry = Some(entered);
            Ok(file)
        });
        let (file, path) = made?.into_parts();
        let entry = entry.expect("entered before it was created");
        Ok((file, Self { path: Some(path), entry }))
    }

    /// The path of the file, until it is taken.
    pub(super) fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Takes the path, to be renamed or dropped while the gate is locked.
    pub(super) fn take(&mut self) -> Option<TempPath> {
        self.path.take()
    }

    /// Marks the file as renamed or removed.
    pub(super) fn finish(&self, _: &Gate) {
        self.entry.finish();
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _gate = gate();
        self.path = None;
        self.entry.finish();
    }
}

/// A folder created for outputs. If it is dropped before it is kept, it is removed, provided that it is empty.
#[derive(Debug)]
pub struct NewFolder {
    path: PathBuf,
    entry: &'static Entry,
}

impl NewFolder {
    /// Creates a folder; `None` if it exists.
    ///
    /// # Errors
    /// Errors of the file system: a file of that name exists, the parent folder is missing, and so on.
    pub fn make(path: &Path) -> io::Result<Option<Self>> {
        let path = std::path::absolute(path)?;
        let mut gate = gate();
        match fs::create_dir(&path) {
            Ok(()) => {}
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && path.is_dir() => {
                return Ok(None);
            }
            Err(error) => return Err(error),
        }
        let entry = gate.enter(&path, true)?;
        Ok(Some(Self { path, entry }))
    }

    /// Keeps the folder.
    pub fn keep(self) {
        self.entry.finish();
    }
}

impl Drop for NewFolder {
    fn drop(&mut self) {
        let _gate = gate();
        if self.entry.unfinished.swap(false, Ordering::AcqRel) {
            // This fails if the folder is not empty.
            let _ = fs::remove_dir(&self.path);
        }
    }
}
