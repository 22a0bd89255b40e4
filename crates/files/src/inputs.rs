//! What outputs must not replace: what is read, and what is in a working folder.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use walpha_base::advice::{Advice, Setting};

use crate::identity::Key;

/// What lists the files that belong to an input: those that a header names, or those of a folder that are read.
pub type FilesOf = fn(&Path) -> Vec<PathBuf>;

/// What is not to be replaced.
enum Kept {
    /// A file that is read.
    Input(Key),
    /// A folder that is read, and what lists the files in it that are.
    Folder(PathBuf, FilesOf),
    /// A folder that nothing else is to be written to.
    Working(PathBuf),
}

static KEPT: Mutex<Vec<Kept>> = Mutex::new(Vec::new());

fn kept() -> MutexGuard<'static, Vec<Kept>> {
    KEPT.lock().unwrap_or_else(PoisonError::into_inner)
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
    /// What to do.
    pub(super) fn advice() -> Advice {
        Advice::new(["name another place, or say ".into(), Setting::InPlace.into()])
    }
}

/// Keeps an input from being replaced by any [`Target`](crate::Target) from now on: a file, those that
/// its header names, or the files of a volume in a folder; under all their names. `files_of` lists the files that belong to it. What is not there is left out.
pub fn keep_input(path: &Path, files_of: FilesOf) {
    let mut found = Vec::new();
    match fs::canonicalize(path) {
        Ok(folder) if folder.is_dir() => found.push(Kept::Folder(folder, files_of)),
        Ok(_) => {
            let files = std::iter::once(path.to_owned()).chain(files_of(path));
            found.extend(files.filter_map(|file| Key::of_existing(&file)).map(Kept::Input));
        }
        Err(_) => {}
    }
    kept().extend(found);
}

/// A folder that no target is opened in, until this is dropped.
#[derive(Debug)]
pub struct Working(PathBuf);

impl Working {
    /// Of a folder, whether it is there or not.
    pub fn folder(folder: &Path) -> Self {
        let folder = Key::of(folder).map_or_else(|_| folder.to_owned(), |key| key.path);
        let folder = fs::canonicalize(&folder).unwrap_or(folder);
        kept().push(Kept::Working(folder.clone()));
        Self(folder)
    }
}

impl Drop for Working {
    fn drop(&mut self) {
        let mut kept = kept();
        if let Some(at) =
            kept.iter().position(|kept| matches!(kept, Kept::Working(folder) if *folder == self.0))
        {
            kept.swap_remove(at);
        }
    }
}

/// Refuses a place that is kept.
pub(super) fn check(place: &Key) -> io::Result<()> {
    // Lists of folders are read when something in one of them would be replaced.
    let is_of = |folder: &Path, files_of: FilesOf| {
        place.path.starts_with(folder)
            && place.path.exists()
            && files_of(folder)
                .iter()
                .filter_map(|file| Key::of_existing(file))
                .any(|file| file.is(place))
    };
    let refused = kept().iter().find_map(|kept| match kept {
        Kept::Input(file) => file.is(place).then_some(Refused::Input),
        Kept::Folder(folder, files_of) => is_of(folder, *files_of).then_some(Refused::Input),
        Kept::Working(folder) => place.path.starts_with(folder).then_some(Refused::Working),
    });
    refused.map_or(Ok(()), |why| Err(io::Error::other(why)))
}
