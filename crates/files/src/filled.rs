//! Files and folders that are complete, before they are moved to their destinations.

use std::io;
use std::path::{Path, PathBuf};

use crate::destination::Claim;
use crate::error::TargetError;
use crate::partial::{CompleteFile, PartialFolder};
use crate::unfinished::gate;

/// A complete file or folder that has not been moved to its destination yet. It is removed if it is dropped before that.
#[derive(Debug)]
pub struct Filled {
    path: PathBuf,
    output: Output,
    bytes: u64,
    _claim: Option<Claim>,
}

#[derive(Debug)]
#[expect(clippy::large_enum_variant, reason = "nearly all are files")]
enum Output {
    File(CompleteFile),
    Folder(PartialFolder),
    /// A stream, which has been written already.
    Stream,
}

impl Filled {
    pub(super) fn file(
        path: PathBuf,
        whole: CompleteFile,
        bytes: u64,
        claim: Option<Claim>,
    ) -> Self {
        Self { path, output: Output::File(whole), bytes, _claim: claim }
    }

    pub(super) fn stream(path: PathBuf, claim: Option<Claim>) -> Self {
        Self { path, output: Output::Stream, bytes: 0, _claim: claim }
    }

    pub(super) fn folder(path: &Path, part: PartialFolder) -> Self {
        Self { path: path.to_owned(), output: Output::Folder(part), bytes: 0, _claim: None }
    }

    /// The number of bytes of the file; 0 for a stream.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

/// Moves complete files to their destinations. An interrupt waits until all are there.
///
/// # Errors
/// Errors of the file system for the first file that cannot be moved; that file and all after it are removed.
pub fn put_all(mut files: Vec<Filled>) -> Result<(), TargetError> {
    // Files that are dropped lock the gate themselves.
    let gate = gate();
    for (done, Filled { path, output, .. }) in files.iter_mut().enumerate() {
        let left = match done {
            0 => TargetError::NOTHING_LEFT.to_owned(),
            1 => "one other output is complete, ".to_owned(),
            _ => format!("{done} other outputs are complete, "),
        };
        let put = match output {
            Output::File(whole) => whole.put(&gate),
            Output::Folder(part) => part.put(path),
            Output::Stream => continue,
        };
        put.map_err(TargetError::of(path, left))?;
    }
    drop(gate);
    Ok(())
}

/// Creates a folder. `fill` fills a temporary folder next to it, which [`put_all`](crate::put_all) renames. `failed` converts
/// errors of the file system.
///
/// # Errors
/// The folder exists or cannot be created, or `fill` fails. Nothing is left behind then.
pub fn fill_folder<E>(
    folder: &Path,
    failed: impl Fn(io::Error) -> E,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<Filled, E> {
    let part = filled_temporary(folder, failed, fill)?;
    Ok(Filled::folder(folder, part))
}

/// Like [`fill_folder`], and renames the folder at once.
///
/// # Errors
/// See [`fill_folder`].
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
    // A run that was killed may have left one.
    let _ = std::fs::remove_dir_all(&part);
    std::fs::create_dir(&part).map_err(&failed)?;
    let made = PartialFolder::of(part.clone());
    fill(&part)?;
    Ok(made)
}
