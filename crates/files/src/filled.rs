use std::path::{Path, PathBuf};

use crate::destination::Claim;
use crate::error::TargetError;
use crate::partial::{CompleteFile, PartialFolder};
use crate::unfinished::gate;

/// A complete file or folder that has not been moved to its destination yet; dropped before that, it is removed.
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
    /// Written already.
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
/// Those of the system for the first that cannot be moved; the others after it are removed.
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
