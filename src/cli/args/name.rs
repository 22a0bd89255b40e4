//! What INPUT is called.

use std::ffi::OsString;
use std::fmt::{self, Display};
use std::ops::Deref;
use std::path::{Path, PathBuf};

use crate::export::Target;

/// A sample or a file: as the system has its name, which need not be text, and as people and reports are shown it.
#[derive(Clone, Debug)]
pub(crate) struct InputName {
    path: PathBuf,
    text: String,
}

impl InputName {
    /// What is opened.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Whether it is standard input.
    pub(crate) fn is_stdin(&self) -> bool {
        self.path == Path::new(Target::STDOUT)
    }
}

impl From<OsString> for InputName {
    fn from(name: OsString) -> Self {
        Self { text: name.to_string_lossy().into_owned(), path: name.into() }
    }
}

/// The text.
impl Deref for InputName {
    type Target = str;

    fn deref(&self) -> &str {
        &self.text
    }
}

impl Display for InputName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
