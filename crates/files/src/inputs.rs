//! Files that outputs must not replace: inputs, and everything in a working folder.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use walpha_base::advice::{Advice, Setting};

use crate::identity::Key;

/// Lists the files that belong to an input: those that a header names, or those that are read from a folder.
pub type FilesOf = fn(&Path) -> Vec<PathBuf>;

/// A file or folder that must not be replaced.
enum Protected {
    /// A file that is read.
    Input(Key),
    /// A file whose header may name others that are read, and the function that lists them.
    Header(PathBuf, FilesOf),
    /// A folder that is read, and the function that lists the files read from it.
    Folder(PathBuf, FilesOf),
    /// A folder that only its owner may write to.
    Working(PathBuf),
}

static PROTECTED: Mutex<Vec<Protected>> = Mutex::new(Vec::new());

fn protected() -> MutexGuard<'static, Vec<Protected>> {
    PROTECTED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Why an output is refused.
#[derive(Debug, thiserror::Error)]
pub(super) enum Refused {
    #[error("it is an input, which would be lost")]
    Input,
    #[error("it is in the working folder of a plan")]
    Working,
}

impl Refused {
    /// How to resolve the error.
    pub(super) fn advice() -> Advice {
        Advice::new(["name another destination, or give ".into(), Setting::InPlace.into()])
    }
}

/// Protects an input from being replaced by any [`Target`](crate::Target) from now on, under all its names: a file and those that
/// its header names, or the files of a volume in a folder. `files_of` lists the files that belong to the input. Files that do not
/// exist are ignored.
pub fn keep_input(path: &Path, files_of: FilesOf) {
    let mut found = Vec::new();
    match fs::canonicalize(path) {
        Ok(folder) if folder.is_dir() => found.push(Protected::Folder(folder, files_of)),
        Ok(_) => {
            found.extend(Key::of_existing(path).map(Protected::Input));
            found.push(Protected::Header(path.to_owned(), files_of));
        }
        Err(_) => {}
    }
    protected().extend(found);
}

/// A folder in which no target can be opened until this is dropped.
#[derive(Debug)]
pub struct Working(PathBuf);

impl Working {
    /// Reserves a folder, whether it exists or not.
    pub fn folder(folder: &Path) -> Self {
        let folder = Key::of(folder).map_or_else(|_| folder.to_owned(), |key| key.path);
        let folder = fs::canonicalize(&folder).unwrap_or(folder);
        protected().push(Protected::Working(folder.clone()));
        Self(folder)
    }
}

impl Drop for Working {
    fn drop(&mut self) {
        let mut protected = protected();
        if let Some(at) = protected.iter().position(
            |protected| matches!(protected, Protected::Working(folder) if *folder == self.0),
        ) {
            protected.swap_remove(at);
        }
    }
}

/// Refuses a destination that is protected.
pub(super) fn check(destination: &Key) -> io::Result<()> {
    // A folder or header is looked at only if a file would be replaced.
    let is_of = |path: &Path, files_of: FilesOf| {
        destination.path.exists()
            && files_of(path)
                .iter()
                .filter_map(|file| Key::of_existing(file))
                .any(|file| file.is(destination))
    };
    let refused = protected().iter().find_map(|protected| match protected {
        Protected::Input(file) => file.is(destination).then_some(Refused::Input),
        Protected::Header(header, files_of) => is_of(header, *files_of).then_some(Refused::Input),
        Protected::Folder(folder, files_of) => {
            let is_within = destination.path.starts_with(folder);
            (is_within && is_of(folder, *files_of)).then_some(Refused::Input)
        }
        Protected::Working(folder) => {
            destination.path.starts_with(folder).then_some(Refused::Working)
        }
    });
    refused.map_or(Ok(()), |why| Err(io::Error::other(why)))
}
