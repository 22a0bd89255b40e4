//! Folders that appear when they are complete.

use std::io;
use std::path::{Path, PathBuf};

use crate::Filled;

/// A folder beside the one it is to become. Dropped before it is put there, it goes with all that is in it.
#[derive(Debug)]
pub(super) struct PartFolder(Option<PathBuf>);

impl PartFolder {
    /// Gives the folder its name.
    pub(super) fn put(&mut self, path: &Path) -> io::Result<()> {
        let Some(part) = &self.0 else { return Ok(()) };
        std::fs::rename(part, path)?;
        self.0 = None;
        Ok(())
    }
}

impl Drop for PartFolder {
    fn drop(&mut self) {
        if let Some(part) = &self.0 {
            // The error reported is an earlier one.
            let _ = std::fs::remove_dir_all(part);
        }
    }
}

/// Makes a folder that is not there yet: `fill` fills one beside it, which gets its name by
/// [`put_all`](crate::put_all). `failed` says what an error of the system is called.
///
/// # Errors
/// The folder is there, cannot be made, or what `fill` returns. Nothing is left behind then.
pub fn fill_folder<E>(
    folder: &Path,
    failed: impl Fn(io::Error) -> E,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<Filled, E> {
    let part = part_of(folder, failed, fill)?;
    Ok(Filled::folder(folder, part))
}

/// The same, put in its place at once.
///
/// # Errors
/// As [`fill_folder`].
pub fn make_folder<E>(
    folder: &Path,
    failed: impl Fn(io::Error) -> E,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), E> {
    part_of(folder, &failed, fill)?.put(folder).map_err(failed)
}

fn part_of<E>(
    folder: &Path,
    failed: impl Fn(io::Error) -> E,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<PartFolder, E> {
    if folder.exists() {
        return Err(failed(io::ErrorKind::AlreadyExists.into()));
    }
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let part: PathBuf = folder.with_file_name(format!(".walpha-{name}.part"));
    // Of a run that was killed.
    let _ = std::fs::remove_dir_all(&part);
    std::fs::create_dir(&part).map_err(&failed)?;
    let made = PartFolder(Some(part.clone()));
    fill(&part)?;
    Ok(made)
}
