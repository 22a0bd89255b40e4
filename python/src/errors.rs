//! Errors of the library as exceptions of Python.

use std::io::ErrorKind;

use pyo3::PyErr;
use pyo3::exceptions::{
    PyFileNotFoundError, PyIsADirectoryError, PyMemoryError, PyOSError, PyPermissionError,
    PyRuntimeError, PyValueError,
};
use walpha::advice::{Advice, Advise, Category, Setting};
use walpha::export::EmptyShape;

/// The error for a wrong argument.
pub fn wrong(text: impl Into<String>) -> PyErr {
    PyValueError::new_err(text.into())
}

/// The exception for an error, by its category; its text says what is wrong, and what to do about it.
pub fn told(error: impl Advise) -> PyErr {
    let text = match error.advice() {
        Some(advice) => format!("{error}; {}", advice.with_names(name)),
        None => error.to_string(),
    };
    match error.category() {
        Category::Memory => PyMemoryError::new_err(text),
        Category::Program | Category::Different => PyRuntimeError::new_err(text),
        Category::System(ErrorKind::NotFound) => PyFileNotFoundError::new_err(text),
        Category::System(ErrorKind::PermissionDenied) => PyPermissionError::new_err(text),
        Category::System(ErrorKind::IsADirectory) => PyIsADirectoryError::new_err(text),
        Category::System(_) => PyOSError::new_err(text),
        _ => wrong(text),
    }
}

/// A file is not written, as it would hold nothing of the shape.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct Refused(pub EmptyShape);

impl Advise for Refused {
    fn advice(&self) -> Option<Advice> {
        let allowed = ", or allow_empty=True to write the file all the same";
        Some(self.0.advice()?.and(allowed.into()))
    }
}

/// A setting as an argument of Python.
pub fn name(setting: Setting) -> String {
    match setting {
        Setting::NoResample => "`resample=False`".into(),
        Setting::Region => "`roi`".into(),
        other => format!("`{}`", other.name()),
    }
}
