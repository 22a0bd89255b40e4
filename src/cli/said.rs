//! Errors of the command itself, and the advice of all errors in the words of its options.

use std::error::Error;

use walpha_base::advice::{Advice, Setting};
use walpha_base::memory::NoMemory;
use walpha_regular::{SitesError, TriangulationError};

use crate::check::schema::SchemaError;
use crate::check::{CertifyError, CertifyFiltrationError, CompareError, CompareFiltrationsError};
use crate::export::TargetError;
use crate::haar::HaarError;
use crate::interpolate::InterpolateError;
use crate::outofcore::BlocksError;
use crate::pipeline::PipelineError;
use crate::points::{UnknownColumns, UnknownWeighting};
#[cfg(feature = "paper")]
use crate::reproduce::ReproduceError;
use crate::shape::{AlphaError, PlanError, ShapeError, TorusError};
use crate::volume::{UnknownFormat, UnknownName};
use crate::{CgalError, PointsError, VolumeError};

use super::output::Unprinted;

/// Why a command cannot do something, and what to do next.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{why}")]
pub(crate) struct Said {
    pub why: String,
    pub next: Option<String>,
    /// Whether the command line makes no sense, whatever is in the files: exit code 2.
    pub usage: bool,
}

impl Said {
    /// An error of the library that the command line is to blame for.
    pub(super) fn usage_of(error: &(impl Error + 'static)) -> Self {
        Self { why: error.to_string(), next: advice(error), usage: true }
    }
}

/// A [`Said`] of a text, and perhaps of what to do next behind a `=>`.
macro_rules! said {
    ($why:literal $(, $of_why:expr)* $(=> $next:literal $(, $of_next:expr)*)?) => {
        $crate::cli::said::Said {
            why: format!($why $(, $of_why)*),
            next: [$(format!($next $(, $of_next)*))?].into_iter().next(),
            usage: false,
        }
    };
}

/// Ends with a [`Said`].
macro_rules! refused {
    ($($text:tt)*) => {
        return Err($crate::cli::said::said!($($text)*).into())
    };
}

/// The same for what makes no sense on a command line.
macro_rules! misused {
    ($($text:tt)*) => {
        return Err($crate::cli::said::Said {
            usage: true,
            ..$crate::cli::said::said!($($text)*)
        }
        .into())
    };
}
pub(crate) use {misused, refused, said};

/// Lists the library's errors that know what to do.
macro_rules! advising {
    ($($(#[$condition:meta])? $error:ty),* $(,)?) => {
        /// What an error of the library knows about what to do.
        fn of_library(error: &(dyn Error + 'static)) -> Option<Advice> {
            $($(#[$condition])? {
                if let Some(error) = error.downcast_ref::<$error>() {
                    return error.advice().into();
                }
            })*
            None
        }

        $($(#[$condition])? impl From<$error> for Said {
            fn from(error: $error) -> Self {
                Self { usage: false, ..Self::usage_of(&error) }
            }
        })*
    };
}
advising![
    BlocksError,
    CgalError,
    HaarError,
    InterpolateError,
    NoMemory,
    PipelineError,
    PlanError,
    PointsError,
    #[cfg(feature = "paper")]
    ReproduceError,
    ShapeError,
    SitesError,
    TargetError,
    TorusError,
    TriangulationError,
    UnknownColumns,
    UnknownFormat,
    UnknownName,
    UnknownWeighting,
    Unprinted,
    VolumeError,
];

impl From<AlphaError> for Said {
    fn from(error: AlphaError) -> Self {
        Self { why: error.to_string(), next: Some(error.advice().into()), usage: false }
    }
}

/// What an error of the checker knows about what to do.
fn of_checker(error: &(dyn Error + 'static)) -> Option<&'static str> {
    if let Some(error) = error.downcast_ref::<AlphaError>() {
        return Some(error.advice());
    }
    if let Some(error) = error.downcast_ref::<SchemaError>() {
        return error.advice();
    }
    if let Some(error) = error.downcast_ref::<CertifyError>() {
        return error.advice();
    }
    if let Some(error) = error.downcast_ref::<CertifyFiltrationError>() {
        return error.advice();
    }
    if let Some(error) = error.downcast_ref::<CompareFiltrationsError>() {
        return error.advice();
    }
    error.downcast_ref::<CompareError>()?.advice()
}

/// What an error knows about what to do, in the words of the command.
pub(super) fn advice(error: &(dyn Error + 'static)) -> Option<String> {
    match error.downcast_ref::<Said>() {
        Some(said) => said.next.clone(),
        None => of_checker(error)
            .map(Into::into)
            .or_else(|| of_library(error).map(|advice| advice.with_names(option))),
    }
}

/// What the command calls a setting.
pub(super) fn option(setting: Setting) -> String {
    match setting {
        Setting::Format => "--input-format".into(),
        Setting::Region => "--roi".into(),
        other => format!("--{}", other.name().replace('_', "-")),
    }
}
