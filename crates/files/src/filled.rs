use std::path::{Path, PathBuf};

use crate::destination::Claim;
use crate::error::TargetError;
use crate::partial::{PartialFolder, Whole};
use crate::unfinished::gate;

/// A complete file or folder to be put in its place; dropped before that, it is removed.
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
    File(Whole),
    Folder(PartialFolder),
    /// It has taken all there is.
    Stream,
}

impl Filled {
    pub(super) fn file(path: PathBuf, whole: Whole, bytes: u64, claim: Option<Claim>) -> Self {
        Self { path, output: Output::File(whole), bytes, _claim: claim }
    }

    pub(super) fn stream(path: PathBuf, claim: Option<Claim>) -> Self {
        Self { path, output: Output::Stream, bytes: 0, _claim: claim }
    }

    pub(super) fn folder(path: &Path, part: PartialFolder) -> Self {
        Self { path: path.to_owned(), output: Output::Folder(part), bytes: 0, _claim: None }
    }

    /// Bytes of the file; 0 of a stream.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

/// Puts complete files in their places. An interrupt waits until all are in place.
///
/// # Errors
/// What the system said of the first that cannot be put there; the others after it go.
pub fn put_all(mut files: Vec<Filled>) -> Result<(), TargetError> {
    // Files that are dropped take the gate themselves.
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
