//! Errors of the library as exceptions of Python.

use std::io::ErrorKind;

use pyo3::PyErr;
use pyo3::exceptions::{
    PyFileNotFoundError, PyIsADirectoryError, PyMemoryError, PyOSError, PyPermissionError,
    PyRuntimeError, PyValueError,
};
use walpha::check::schema::SchemaError;
use walpha::check::{AlphaError, CertifyError, CompareError};
use walpha::export::{TargetError, UnknownFormat};
use walpha::haar::HaarError;
use walpha::interpolate::InterpolateError;
use walpha::memory::NoMemory;
use walpha::pipeline::PipelineError;
use walpha::points::{PointsError, UnknownWeighting};
use walpha::shape::ShapeError;
use walpha::triangulation::TriangulationError;
use walpha::volume::VolumeError;

/// An error that Python can be told.
pub trait Told {
    /// The exception: `ValueError` for what was given, `OSError` for files, `MemoryError`.
    fn told(self) -> PyErr;
}

/// What was given is wrong.
pub fn wrong(text: impl Into<String>) -> PyErr {
    PyValueError::new_err(text.into())
}

/// Messages name options as the command has them: `--engine native` is `engine='native'` here, `--ratio 2` is
/// `ratio=2`.
fn message(error: &impl ToString) -> String {
    const NAMES: [&str; 4] = ["native", "cgal", "power", "radius"];
    let text = error.to_string();
    let mut pieces = text.split("--");
    let mut told = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let end = piece.find(|c: char| !c.is_ascii_lowercase() && c != '-').unwrap_or(piece.len());
        let (option, rest) = piece.split_at(end);
        told += &option.replace('-', "_");
        told.push('=');
        let value = rest.strip_prefix(' ').unwrap_or_default();
        match NAMES.iter().find(|name| value.starts_with(**name)) {
            Some(name) => told += &format!("'{name}'{}", &value[name.len()..]),
            None if value.starts_with(|c: char| c.is_ascii_digit() || c == '-') => told += value,
            None => told += rest,
        }
    }
    told
}

/// Errors that say nothing but what is wrong with what was given.
macro_rules! wrong_value {
    ($($error:ty),*) => {$(
        impl Told for $error {
            fn told(self) -> PyErr {
                wrong(message(&self))
            }
        }
    )*};
}

wrong_value!(AlphaError, CompareError, SchemaError, UnknownFormat, UnknownWeighting);

impl Told for NoMemory {
    fn told(self) -> PyErr {
        PyMemoryError::new_err(message(&self))
    }
}

impl Told for TriangulationError {
    fn told(self) -> PyErr {
        let text = message(&self);
        match self {
            Self::Memory { .. } => PyMemoryError::new_err(text),
            Self::Thrown { .. } => PyRuntimeError::new_err(text),
            _ => wrong(text),
        }
    }
}

impl Told for ShapeError {
    fn told(self) -> PyErr {
        match self {
            Self::Triangulation(error) => error.told(),
            Self::Memory(error) => error.told(),
            other => wrong(message(&other)),
        }
    }
}

impl Told for VolumeError {
    fn told(self) -> PyErr {
        let text = message(&self);
        match self {
            Self::Io { source, .. } => of_system(source.kind(), text),
            // The file of a sample that is not installed.
            Self::Sample(_) => PyOSError::new_err(text),
            Self::Memory(error) => error.told(),
            _ => wrong(text),
        }
    }
}

impl Told for TargetError {
    fn told(self) -> PyErr {
        PyOSError::new_err(self.to_string())
    }
}

impl Told for HaarError {
    fn told(self) -> PyErr {
        match self {
            Self::Memory(error) => error.told(),
            other => wrong(message(&other)),
        }
    }
}

impl Told for PointsError {
    fn told(self) -> PyErr {
        match self {
            Self::Memory(error) => error.told(),
            Self::File(error) => error.told(),
            Self::Neighbours(TriangulationError::Memory { .. }) => {
                PyMemoryError::new_err(message(&self))
            }
            other => wrong(message(&other)),
        }
    }
}

impl Told for InterpolateError {
    fn told(self) -> PyErr {
        match self {
            Self::Memory(error) => error.told(),
            Self::Shape(error) => error.told(),
            Self::Points(error) => error.told(),
            Self::Haar(error) => error.told(),
            other => wrong(message(&other)),
        }
    }
}

impl Told for PipelineError {
    fn told(self) -> PyErr {
        match self {
            Self::Haar(error) => error.told(),
            Self::Points(error) => error.told(),
            Self::Interpolate(error) => error.told(),
            Self::Shape(error) => error.told(),
            other => wrong(message(&other)),
        }
    }
}

impl Told for CertifyError {
    fn told(self) -> PyErr {
        let text = message(&self);
        match self {
            Self::Memory { .. } => PyMemoryError::new_err(text),
            _ => wrong(text),
        }
    }
}

fn of_system(kind: ErrorKind, text: String) -> PyErr {
    match kind {
        ErrorKind::NotFound => PyFileNotFoundError::new_err(text),
        ErrorKind::PermissionDenied => PyPermissionError::new_err(text),
        ErrorKind::IsADirectory => PyIsADirectoryError::new_err(text),
        _ => PyOSError::new_err(text),
    }
}
