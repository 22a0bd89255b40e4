//! What follows from a shape and is computed when it is first asked for.

use std::sync::{Arc, OnceLock};

/// A value that is computed once and shared by the clones of its shape. It follows from the rest of the shape, so all are
/// equal.
#[derive(Clone, Debug)]
pub(crate) struct Derived<T>(OnceLock<Arc<T>>);

impl<T> Derived<T> {
    /// The value, computed at the first call.
    pub(crate) fn get(&self, compute: impl FnOnce() -> T) -> &T {
        self.0.get_or_init(|| Arc::new(compute()))
    }
}

impl<T> Default for Derived<T> {
    fn default() -> Self {
        Self(OnceLock::new())
    }
}

impl<T> PartialEq for Derived<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
