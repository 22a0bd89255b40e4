use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use walpha_base::advice::Advice;
use walpha_base::shown::shown;

use crate::inputs::Refused;

/// A file cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", shown(path))]
pub struct TargetError {
    path: PathBuf,
    source: io::Error,
    /// What became of the outputs; empty where that is plain.
    left: String,
}

impl TargetError {
    /// What became of the outputs, and what to do.
    pub fn advice(&self) -> Advice {
        let refused = self.source.get_ref().and_then(|error| error.downcast_ref::<Refused>());
        if refused.is_some() {
            return Refused::advice();
        }
        format!("{}{}", self.left, next_step(&self.source)).into()
    }

    pub(super) const NOTHING_LEFT: &str = "nothing was left behind, ";

    pub(super) fn of(path: &Path, left: impl Into<String>) -> impl FnOnce(io::Error) -> Self {
        move |source| Self { path: path.to_owned(), source, left: left.into() }
    }
}

/// What to do about an error of the system.
fn next_step(error: &io::Error) -> &'static str {
    #[cfg(unix)]
    if error.raw_os_error() == Some(rustix::io::Errno::MFILE.raw_os_error()) {
        return "allow more with `ulimit -n`";
    }
    match error.kind() {
        ErrorKind::NotFound => "make it first, or choose a place that is there",
        ErrorKind::AlreadyExists => "give each output a name of its own",
        ErrorKind::InvalidFilename => "choose a shorter name",
        ErrorKind::IsADirectory => "name a file in it",
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "make it writable, or choose a place that you may write to"
        }
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
            "choose a place with room"
        }
        _ => "choose a place with room that you may write to",
    }
}
