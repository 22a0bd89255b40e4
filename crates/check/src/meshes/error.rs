use std::io;
use std::path::Path;

use walpha_base::advice::{Advice, Advise};
use walpha_base::memory::NoMemory;

/// The reason why a mesh cannot be read: the place in the file, the fault, and advice.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}{why}")]
pub struct MeshError {
    /// The file, if it is not the named one, and the line or byte; empty for the whole file.
    place: String,
    why: String,
    next: Option<Advice>,
}

impl MeshError {
    /// An error of a whole file.
    pub(super) fn new(why: impl Into<String>) -> Self {
        Self { place: String::new(), why: why.into(), next: None }
    }

    /// Adds a place to the error, such as `line 3`.
    pub(super) fn at(self, place: &str) -> Self {
        Self { place: format!("{place}: "), ..self }
    }

    /// Adds advice to the error.
    pub(super) fn with_advice(self, next: impl Into<Advice>) -> Self {
        Self { next: Some(next.into()), ..self }
    }

    /// Attributes the error to another file than the named one.
    #[must_use]
    pub fn of_file(self, path: &Path) -> Self {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let name = name.escape_debug();
        let place = match &self.place[..] {
            "" => format!("{name}: "),
            place => format!("{name}, {place}"),
        };
        Self { place, ..self }
    }
}

impl Advise for MeshError {
    fn advice(&self) -> Option<Advice> {
        self.next.clone()
    }
}

impl From<io::Error> for MeshError {
    fn from(error: io::Error) -> Self {
        Self::new(format!("the mesh cannot be read: {error}"))
    }
}

impl From<NoMemory> for MeshError {
    fn from(error: NoMemory) -> Self {
        Self::new(error.to_string()).with_advice("judge a part of it")
    }
}
