//! Folders that appear when they are complete.

use std::io;
use std::path::{Path, PathBuf};

use crate::filled::Filled;
use crate::partial::PartialFolder;

/// Creates a folder: `fill` fills a temporary one next to it, which
/// [`put_all`](crate::put_all) renames. `failed` converts errors of the system.
///
/// # Errors
/// The folder exists or cannot be created; errors of `fill`. Then nothing is left behind.
pub fn fill_folder<E>(
    folder: &Path,
    failed: impl Fn(io::Error) -> E,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<Filled, E> {
    let part = filled_temporary(folder, failed, fill)?;
    Ok(Filled::folder(folder, part))
}

/// The same, renamed at once.
///
/// # Errors
/// As [`fill_folder`].
pub fn make_folder<E>(
    folder: &Path,
    failed: impl Fn(io::Error) -> E,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), E> {
    filled_temporary(folder, &failed, fill)?.put(folder).map_err(failed)
}

fn filled_temporary<E>(
    folder: &Path,
    failed: impl Fn(io::Error) -> E,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<PartialFolder, E> {
    if folder.exists() {
        return Err(failed(io::ErrorKind::AlreadyExists.into()));
    }
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let part: PathBuf = folder.with_file_name(format!(".walpha-{name}.part"));
    // Left by a run that was killed.
    let _ = std::fs::remove_dir_all(&part);
    std::fs::create_dir(&part).map_err(&failed)?;
    let made = PartialFolder::of(part.clone());
    fill(&part)?;
    Ok(made)
}
