//! Folders that appear when they are complete.

use std::io;
use std::path::{Path, PathBuf};

/// Makes a folder that is not there yet: `fill` fills one beside it, which gets its name at the end. `failed`
/// says what an error of the system is called.
///
/// # Errors
/// The folder is there, cannot be made, or what `fill` returns. Nothing is left behind then.
pub(crate) fn make_folder<E>(
    folder: &Path,
    failed: impl Fn(io::Error) -> E,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), E> {
    if folder.exists() {
        return Err(failed(io::ErrorKind::AlreadyExists.into()));
    }
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let part: PathBuf = folder.with_file_name(format!(".walpha-{name}.part"));
    // Of a run that was killed.
    let _ = std::fs::remove_dir_all(&part);
    std::fs::create_dir(&part).map_err(&failed)?;
    let done = fill(&part).and_then(|()| std::fs::rename(&part, folder).map_err(failed));
    if done.is_err() {
        // The error reported is the first one.
        let _ = std::fs::remove_dir_all(&part);
    }
    done
}
