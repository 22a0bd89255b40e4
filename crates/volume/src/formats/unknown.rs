use std::path::Path;

use walpha_base::advice::{Advice, Advise, Category};

use crate::near::nearest;
use walpha_base::shown::shown;

/// The error for an extension that no writer has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{path}: {}; {thing} can be written as {known}", unknown(.extension))]
pub struct UnknownFormat {
    path: String,
    extension: String,
    thing: &'static str,
    known: String,
    near: Option<String>,
}

impl UnknownFormat {
    /// The value that belongs to the extension of a path, among pairs of an extension and a value.
    ///
    /// # Errors
    /// The name has no known extension.
    pub fn find<'a, F>(
        path: &Path,
        thing: &'static str,
        mut all: impl Iterator<Item = (&'a str, F)> + Clone,
    ) -> Result<F, Self> {
        let known = all.clone().map(|(extension, _)| extension);
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let ends = |extension: &str| {
            name.strip_suffix(extension).is_some_and(|stem| stem.len() > 1 && stem.ends_with('.'))
        };
        let found = all.find(|(extension, _)| ends(extension));
        found.map(|(_, format)| format).ok_or_else(|| Self::new(path, thing, known))
    }

    /// The error that `thing` cannot be written to `path`, but only under the `known` extensions (without their dots).
    pub fn new<'a>(
        path: &Path,
        thing: &'static str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        Self::among(path, thing, &Vec::from_iter(known))
    }

    fn among(path: &Path, thing: &'static str, known: &[&str]) -> Self {
        let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        let dotted: Vec<String> = known.iter().map(|known| format!(".{known}")).collect();
        Self {
            path: shown(path),
            near: nearest(&extension, known.iter().copied()).map(str::to_owned),
            extension,
            thing,
            known: dotted.join(", "),
        }
    }
}

fn unknown(extension: &str) -> String {
    if extension.is_empty() {
        "it has no extension".into()
    } else {
        format!("cannot write .{extension}")
    }
}

impl Advise for UnknownFormat {
    fn advice(&self) -> Option<Advice> {
        Some(match &self.near {
            Some(near) => format!("did you mean .{near}?").into(),
            None => "choose one of these".into(),
        })
    }

    fn category(&self) -> Category {
        Category::Usage
    }
}
