//! A failure of a request.

use walpha_base::advice::{Advise, told};
use walpha_model::export::EmptyShape;

/// A failure: its reason, and what to do next.
pub(crate) struct Failure {
    pub why: String,
    pub next: Option<String>,
}

impl Failure {
    pub(crate) fn new(why: impl Into<String>) -> Self {
        Self { why: why.into(), next: None }
    }

    pub(crate) fn of_no_shape() -> Self {
        Self::new("there is no shape yet")
    }

    /// The page moves α by its slider.
    pub(crate) fn of_empty(error: EmptyShape) -> Self {
        match error.suggested {
            Some(radius) => {
                let next = Some(format!("move α up, to √α = {radius} say"));
                Self { why: error.to_string(), next }
            }
            None => error.into(),
        }
    }
}

/// An error of the library, with its causes and its advice. The page's fields have the names of settings.
impl<E: Advise> From<E> for Failure {
    fn from(error: E) -> Self {
        let (why, next) = told(&error, &|setting| format!("“{}”", setting.name()));
        Self { why, next }
    }
}
