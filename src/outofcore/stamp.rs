//! How the files of an input look without reading them.

use std::fs::{self, Metadata};
use std::path::Path;
use std::time::UNIX_EPOCH;

use serde::{Deserialize, Serialize};

use super::Job;
use crate::volume::files_of;

/// How many files an input has, how large they are, and when one was written last. A hint: a file may be touched
/// and stay what it was. What was read of it is known by its digests ([`ReadDigests`](super::read_digests::ReadDigests)).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Stamp {
    files: u64,
    bytes: u64,
    /// Nanoseconds since 1970.
    newest: u64,
}

impl Stamp {
    /// That of the input of a job as it is now; nothing of a sample. Looks at each file of a folder.
    pub(super) fn of(job: &Job) -> Self {
        let mut stamp = Self::default();
        if !job.input.starts_with("sample:") {
            let files = files_of(Path::new(&job.input)).into_iter();
            // Whoever reads says what is wrong with one that is not there.
            files.filter_map(|path| fs::metadata(path).ok()).for_each(|file| stamp.add(&file));
        }
        stamp
    }

    fn add(&mut self, file: &Metadata) {
        self.files += 1;
        self.bytes = self.bytes.wrapping_add(file.len());
        let written = file.modified().ok().and_then(|at| at.duration_since(UNIX_EPOCH).ok());
        self.newest = self.newest.max(written.map_or(0, |at| at.as_nanos() as u64));
    }
}
