use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use walpha_base::advice::{Advice, Advise};
use walpha_base::shown::shown;

use crate::inputs::Refused;

/// The error for a file that cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", shown(path))]
pub struct TargetError {
    path: PathBuf,
    source: io::Error,
    /// The state that the outputs are left in; empty where that is obvious.
    left: String,
}

impl Advise for TargetError {
    fn wrapped(&self) -> Option<&dyn Advise> {
        Some(&self.source)
    }

    /// The state that the outputs are left in, and how to resolve the error.
    fn advice(&self) -> Option<Advice> {
        let content = self.source.get_ref();
        if content.and_then(|error| error.downcast_ref::<Refused>()).is_some() {
            return Some(Refused::advice());
        }
        let next = self.source.advice().unwrap_or_else(|| next_step(&self.source).into());
        Some(Advice::from(self.left.clone()).and(next))
    }
}

impl TargetError {
    pub(super) const NOTHING_LEFT: &str = "nothing was left behind, ";

    pub(super) fn of(path: &Path, left: impl Into<String>) -> impl FnOnce(io::Error) -> Self {
        move |source| Self { path: path.to_owned(), source, left: left.into() }
    }
}

/// How to resolve an error of the operating system, or of a format that cannot hold what is to be written.
fn next_step(error: &io::Error) -> &'static str {
    #[cfg(unix)]
    if error.raw_os_error() == Some(rustix::io::Errno::MFILE.raw_os_error()) {
        return "allow more with `ulimit -n`";
    }
    match error.kind() {
        ErrorKind::NotFound => "create the folder, or choose an existing one",
        ErrorKind::AlreadyExists => "give each output a name of its own",
        ErrorKind::InvalidFilename => "choose a shorter name",
        ErrorKind::IsADirectory => "name a file in it",
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "make it writable, or choose a folder that you may write to"
        }
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
            "choose a disk with enough space"
        }
        ErrorKind::InvalidInput | ErrorKind::InvalidData | ErrorKind::Other
            if error.get_ref().is_some() =>
        {
            "choose another format, or other options"
        }
        _ => "choose a folder that you may write to, on a disk with enough space",
    }
}
