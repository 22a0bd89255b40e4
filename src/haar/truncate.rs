use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use walpha_base::Cancelled;
use walpha_base::advice::Advice;
use walpha_base::memory::NoMemory;

use super::Coefficients;
use crate::select::{Budget, Cut, Dropped};
use crate::volume::VolumeError;

/// Coefficients cut by a thread at a time.
const CHUNK: usize = 1 << 16;

/// Each square is off by less than 2⁻⁴⁹ of itself, and so is their sum, which is exact. ε² is rounded, too.
const SLACK: f64 = 1.0 + 1.0 / (1u64 << 34) as f64;

/// How much of a volume may be lost, one of three ways to say it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Tolerance {
    /// The root mean square of f − f̂ over the samples, in their units (gray levels): ε² = rms²·n.
    Rms(f64),
    /// The norm ‖f − f̂‖ itself, ε.
    Epsilon(f64),
    /// This many coefficients stay, or all if there are fewer.
    Coefficients(u64),
}

/// An RMS of one gray level.
impl Default for Tolerance {
    fn default() -> Self {
        Self::Rms(1.0)
    }
}

/// What truncation did.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truncation {
    /// What was asked for.
    pub asked: Tolerance,
    /// Coefficients that stay.
    pub kept: u64,
    /// Coefficients there were, as many as samples.
    pub total: u64,
    /// ‖f − f̂‖ reached: the square root of the sum of the squares of the dropped coefficients.
    pub epsilon: f64,
    /// The root mean square of f − f̂ reached, epsilon/√n.
    pub rms: f64,
}

/// Why a volume cannot be truncated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HaarError {
    /// A negative or undefined tolerance.
    #[error("a tolerance of {given} makes no sense for {what}")]
    Tolerance {
        /// The number given.
        given: f64,
        /// What it was meant for.
        what: &'static str,
    },
    /// The truncated samples make no volume: they passed the range of `f32`.
    #[error("after truncation: {0}")]
    Volume(#[from] VolumeError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Memory for the coefficients cannot be had.
    #[error(transparent)]
    Memory(#[from] NoMemory),
}

impl HaarError {
    /// What to do about it, where there is something.
    pub fn advice(&self) -> Option<Advice> {
        match self {
            Self::Tolerance { .. } => Some("give a number from 0 up".into()),
            Self::Volume(error) => error.advice(),
            Self::Cancelled(_) => None,
            Self::Memory(lack) => Some(lack.advice()),
        }
    }
}

impl Tolerance {
    pub(crate) fn check(self) -> Result<(), HaarError> {
        let (given, what) = match self {
            Self::Rms(given) => (given, "the RMS error in gray levels"),
            Self::Epsilon(given) => (given, "ε, the L² norm of the error,"),
            Self::Coefficients(_) => return Ok(()),
        };
        if given.is_nan() || given < 0.0 {
            return Err(HaarError::Tolerance { given, what });
        }
        Ok(())
    }

    pub(crate) fn budget(self, total: u64) -> Budget {
        match self {
            Self::Rms(rms) => Budget::Energy(rms * rms * total as f64 * SLACK),
            Self::Epsilon(epsilon) => Budget::Energy(epsilon * epsilon * SLACK),
            Self::Coefficients(kept) => Budget::Count(total.saturating_sub(kept)),
        }
    }
}

impl Coefficients {
    /// Drops (sets to 0) the smallest coefficients: in order of decreasing magnitude, ties in order
    /// of their index, the fewest stay for which the squares of the dropped ones sum to at most
    /// ε²; to 2⁻³⁴ of ε², so that rounding does not decide about sums of just ε².
    ///
    /// O(n), the same on any number of threads. Zeros are always dropped when an error
    /// is asked for, so `Rms(0.0)` keeps the coefficients that are not 0.
    ///
    /// # Errors
    /// [`HaarError::Tolerance`] when the tolerance is negative or NaN.
    #[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
    pub fn truncate(&mut self, asked: Tolerance) -> Result<Truncation, HaarError> {
        asked.check()?;
        let values = self.values.as_slice_mut().expect("standard layout");
        let total = values.len() as u64;
        let (cut, dropped) = Cut::new(values, asked.budget(total));
        values.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, values)| {
            for (value, i) in values.iter_mut().zip((chunk * CHUNK) as u64..) {
                // Without branches: which coefficients stay cannot be foretold.
                *value = if cut.keeps(*value, i) { *value } else { 0.0 };
            }
        });
        Ok(Truncation::new(asked, total, dropped))
    }
}

impl Truncation {
    /// Of so many coefficients these were dropped.
    pub(crate) fn new(asked: Tolerance, total: u64, dropped: Dropped) -> Self {
        Self {
            asked,
            kept: total - dropped.count,
            total,
            epsilon: dropped.energy.sqrt(),
            rms: (dropped.energy / total as f64).sqrt(),
        }
    }
}
