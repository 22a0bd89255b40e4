//! Numbers that single precision does not hold: a reader reports that they are rounded, or become infinite.

use std::path::Path;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

use walpha_base::shown::shown;

use crate::Sample;

/// Records whether whole numbers of a file were rounded.
#[derive(Debug)]
pub(crate) struct Rounding {
    found: AtomicBool,
    said: Once,
}

impl Default for Rounding {
    fn default() -> Self {
        Self { found: AtomicBool::new(false), said: Once::new() }
    }
}

impl Rounding {
    /// Converts a number to a sample.
    pub(crate) fn sample(&self, number: impl Sample) -> f32 {
        self.note(number.is_rounded());
        number.to_f32()
    }

    /// Records whether a number is rounded.
    pub(crate) fn note(&self, is_rounded: bool) {
        if is_rounded {
            self.found.store(true, Ordering::Relaxed);
        }
    }

    /// Reports rounding, once for each file.
    pub(crate) fn say(&self, path: &Path) {
        if self.found.load(Ordering::Relaxed) {
            self.said.call_once(|| tracing::warn!("{}: {ROUNDED}", shown(path)));
        }
    }
}

/// The message about rounding.
pub(crate) const ROUNDED: &str = "whole numbers beyond 16777216 (2²⁴) are rounded to samples of single precision: \
                                  different ones, as of labels, may become the same. Numbers beyond 3.4e38 become infinite";
