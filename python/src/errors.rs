//! Errors of the library as exceptions of Python.

use std::io::ErrorKind;

use pyo3::PyErr;
use pyo3::exceptions::{
    PyFileNotFoundError, PyIsADirectoryError, PyMemoryError, PyOSError, PyPermissionError,
    PyRuntimeError, PyValueError,
};
use walpha::advice::{Advice, Setting};
use walpha::check::schema::SchemaError;
use walpha::check::{AlphaError, CertifyError, CompareError};
use walpha::export::{EmptyShape, TargetError, UnknownFormat};
use walpha::haar::HaarError;
use walpha::interpolate::InterpolateError;
use walpha::labels::LabelsError;
use walpha::pipeline::PipelineError;
use walpha::points::{PointsError, UnknownColumns, UnknownWeighting};
use walpha::settings::SettingError;
use walpha::shape::{OutlineError, ShapeError, TorusError};
use walpha::triangulation::TriangulationError;
use walpha::volume::VolumeError;
use walpha::{CgalError, NoMemory};

/// An error that can be raised in Python.
pub trait Told {
    /// The exception: `ValueError` for what was given, `OSError` for files, `MemoryError`.
    fn told(self) -> PyErr;
}

/// What was given is wrong.
pub fn wrong(text: impl Into<String>) -> PyErr {
    PyValueError::new_err(text.into())
}

/// What is wrong, and what to do about it.
fn message(error: &impl ToString, advice: impl Into<Option<Advice>>) -> String {
    match advice.into() {
        Some(advice) => format!("{}; {}", error.to_string(), advice.with_names(name)),
        None => error.to_string(),
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

/// Errors that say nothing but what is wrong with what was given.
macro_rules! wrong_value {
    ($($error:ty, $advice:expr;)*) => {$(
        impl Told for $error {
            fn told(self) -> PyErr {
                let advice: fn(&Self) -> Option<Advice> = $advice;
                wrong(message(&self, advice(&self)))
            }
        }
    )*};
}

wrong_value! {
    SettingError, |error| error.advice();
    AlphaError, |error| Some(error.advice().into());
    CompareError, |error| error.advice().map(Into::into);
    OutlineError, |error| error.advice().into();
    SchemaError, |error| error.advice().map(Into::into);
    TorusError, |error| error.advice().into();
    UnknownColumns, |error| error.advice().into();
    UnknownFormat, |error| error.advice().into();
    UnknownWeighting, |error| error.advice().into();
}

impl Told for EmptyShape {
    fn told(self) -> PyErr {
        let advice = self.advice();
        wrong(format!("{self}; {advice}, or allow_empty=True to write the file all the same"))
    }
}

impl Told for NoMemory {
    fn told(self) -> PyErr {
        PyMemoryError::new_err(message(&self, self.advice()))
    }
}

impl Told for TriangulationError {
    fn told(self) -> PyErr {
        let text = message(&self, self.advice());
        match self {
            Self::Memory { .. } => PyMemoryError::new_err(text),
            _ => wrong(text),
        }
    }
}

impl Told for CgalError {
    fn told(self) -> PyErr {
        let text = message(&self, self.advice());
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
            Self::Cgal(error) => error.told(),
            Self::Memory(error) => error.told(),
            other => wrong(message(&other, other.advice())),
        }
    }
}

impl Told for VolumeError {
    fn told(self) -> PyErr {
        let text = message(&self, self.advice());
        match self {
            Self::Io { source, .. } => of_system(source.kind(), text),
            // The file of a sample that is not installed.
            Self::NoSkull { .. } => PyOSError::new_err(text),
            Self::Memory(error) => error.told(),
            Self::InFile { source, .. } if matches!(*source, Self::Memory(_)) => {
                PyMemoryError::new_err(text)
            }
            _ => wrong(text),
        }
    }
}

impl Told for TargetError {
    fn told(self) -> PyErr {
        PyOSError::new_err(message(&self, self.advice()))
    }
}

impl Told for HaarError {
    fn told(self) -> PyErr {
        match self {
            Self::Memory(error) => error.told(),
            other => wrong(message(&other, other.advice())),
        }
    }
}

impl Told for PointsError {
    fn told(self) -> PyErr {
        match self {
            Self::Memory(error) => error.told(),
            Self::File(error) => error.told(),
            Self::Neighbours(TriangulationError::Memory { .. }) => {
                PyMemoryError::new_err(message(&self, self.advice()))
            }
            other => wrong(message(&other, other.advice())),
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
            other => wrong(message(&other, other.advice())),
        }
    }
}

impl Told for PipelineError {
    fn told(self) -> PyErr {
        match self {
            Self::Haar(error) => error.told(),
            Self::Points(error) => error.told(),
            Self::Interpolate(error) => error.told(),
            Self::Labels(LabelsError::Shape(error)) | Self::Shape(error) => error.told(),
            other => wrong(message(&other, other.advice())),
        }
    }
}

impl Told for CertifyError {
    fn told(self) -> PyErr {
        let text = message(&self, self.advice().map(Advice::from));
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
