//! Folders that appear when they are complete.

use std::io;
use std::path::{Path, PathBuf};

use crate::filled::Filled;
use crate::partial::PartialFolder;

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
    let part = filled_beside(folder, failed, fill)?;
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
    filled_beside(folder, &failed, fill)?.put(folder).map_err(failed)
}

fn filled_beside<E>(
    folder: &Path,
    failed: impl Fn(io::Error) -> E,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<PartialFolder, E> {
    if folder.exists() {
        return Err(failed(io::ErrorKind::AlreadyExists.into()));
    }
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let part: PathBuf = folder.with_file_name(format!(".walpha-{name}.part"));
    // Of a run that was killed.
    let _ = std::fs::remove_dir_all(&part);
    std::fs::create_dir(&part).map_err(&failed)?;
    let made = PartialFolder::of(part.clone());
    fill(&part)?;
    Ok(made)
}
