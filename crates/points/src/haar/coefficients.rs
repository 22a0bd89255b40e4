use std::fmt;

use ndarray::{Array3, ArrayView3, Zip};
use serde::{Deserialize, Serialize};
use walpha_base::Cancelled;
use walpha_base::advice::{Advice, Advise, wrapped};
use walpha_base::memory::NoMemory;
use walpha_base::parallel::prelude::*;

use super::{nonstandard, standard};
use crate::largest::{Budget, Cut, Dropped};
use walpha_base::shown::number;
use walpha_volume::VolumeError;

/// The kind of basis functions of (x, y, z).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Decomposition {
    /// All axes take one step per level, and the octant of means continues: the functions are on cubes of 2ˡ samples a side.
    #[default]
    NonStandard,
    /// Each axis is transformed fully: the functions are on boxes whose sides are any powers of two.
    Standard,
}

impl fmt::Display for Decomposition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NonStandard => "nonstandard",
            Self::Standard => "standard",
        })
    }
}

/// The orthonormal Haar coefficients of a volume, in the place of its samples.
///
/// Along an axis, the coefficient of the whole row's mean is at 0, and the detail between the
/// samples from i to i + 2ˡ and those from there to i + 2·2ˡ is at i + 2ˡ: the number of
/// trailing zeros of an index is its level. In the non-standard decomposition the level of a voxel
/// is the least of its three indices'. A row of four samples becomes `[mean, fine detail of 0 and
/// 1, coarse detail, fine detail of 2 and 3]`:
///
/// ```
/// use ndarray::arr3;
/// use walpha_points::haar::{Decomposition, forward};
///
/// let coefficients = forward(arr3(&[[[9.0, 7.0, 3.0, 5.0]]]).view(), Decomposition::NonStandard);
/// // Averages [8, 4] → [6] and half-differences [1, −1], [2], each times the norm of its function.
/// let expected = [6.0 * 2.0, 1.0 * 2f64.sqrt(), 2.0 * 2.0, -1.0 * 2f64.sqrt()];
/// for (c, e) in coefficients.values().iter().zip(expected) {
///     assert!((c - e).abs() < 1e-15);
/// }
/// ```
///
/// An odd row keeps its last sample by the unbalanced Haar step: the detail between supports of a
/// and b samples is (√b·s − √a·t)/√(a + b). Sums of squares equal those of the samples up to
/// rounding.
///
/// Coefficients are doubles, whole numbers over square roots of whole numbers where the samples are
/// whole numbers (or these times a power of two) and n·max is below 2⁵³/n for n samples, as for all
/// gray levels of 8 bits up to 256³: then what is 0 is exactly 0, and equal coefficients of one
/// level, or of levels whose functions are of the same shape, are equal.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    pub(super) values: Array3<f64>,
    decomposition: Decomposition,
}

/// Transforms samples `[z, y, x]`. O(n), parallel, independent of the number of threads.
pub fn forward(samples: ArrayView3<'_, f32>, decomposition: Decomposition) -> Coefficients {
    let mut values = Array3::zeros(samples.dim());
    Zip::from(&mut values).and(samples).par_for_each(|value, &sample| *value = f64::from(sample));
    match decomposition {
        Decomposition::NonStandard => nonstandard::forward(&mut values),
        Decomposition::Standard => standard::forward(&mut values),
    }
    Coefficients { values, decomposition }
}

impl Coefficients {
    /// The coefficients at their places in `[z, y, x]`.
    pub fn values(&self) -> ArrayView3<'_, f64> {
        self.values.view()
    }

    /// The decomposition of the coefficients.
    pub fn decomposition(&self) -> Decomposition {
        self.decomposition
    }

    /// Computes the samples `[z, y, x]` that have these coefficients, rounded once. O(n), parallel; the result does not depend on
    /// the number of threads.
    pub fn inverse(self) -> Array3<f32> {
        let mut values = self.values;
        match self.decomposition {
            Decomposition::NonStandard => nonstandard::inverse(&mut values),
            Decomposition::Standard => standard::inverse(&mut values),
        }
        let mut samples = Array3::zeros(values.dim());
        Zip::from(&mut samples).and(&values).par_for_each(|sample, &value| *sample = value as f32);
        samples
    }
}

/// The number of coefficients that a thread cuts at a time.
const CHUNK: usize = 1 << 16;

/// The relative error of each square is below 2⁻⁴⁹, and so is that of their sum, which is exact. ε² is rounded, too.
const SLACK: f64 = 1.0 + 1.0 / (1u64 << 34) as f64;

/// How much of a volume may be lost, in one of three ways.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Tolerance {
    /// The root mean square of f − f̂ over the samples, in their units (gray levels): ε² = rms²·n.
    Rms(f64),
    /// The norm ‖f − f̂‖ itself, ε.
    Epsilon(f64),
    /// The number of coefficients that stay; all stay if there are fewer.
    Coefficients(u64),
}

/// The default is an RMS of one gray level.
impl Default for Tolerance {
    fn default() -> Self {
        Self::Rms(1.0)
    }
}

/// The result of a truncation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truncation {
    /// The tolerance requested.
    pub asked: Tolerance,
    /// The number of coefficients that stay.
    pub kept: u64,
    /// The number of coefficients before the truncation, which is that of samples.
    pub total: u64,
    /// The norm ‖f − f̂‖ reached: the square root of the sum of the squares of the dropped coefficients.
    pub epsilon: f64,
    /// The root mean square of f − f̂ reached, epsilon/√n.
    pub rms: f64,
}

/// An error of the truncation of a volume.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HaarError {
    /// The tolerance is negative or not a number.
    #[error("{} is not a valid tolerance for {what}", number(*given))]
    Tolerance {
        /// The number given.
        given: f64,
        /// The kind of tolerance.
        what: &'static str,
    },
    /// The truncated samples do not form a volume, as they exceed the range of `f32`.
    #[error("after truncation: {0}")]
    Volume(#[from] VolumeError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// There is not enough memory for the coefficients.
    #[error(transparent)]
    Memory(#[from] NoMemory),
}

impl Advise for HaarError {
    wrapped!(Volume, Cancelled, Memory);

    fn advice(&self) -> Option<Advice> {
        match self {
            Self::Tolerance { .. } => Some("give a number from 0 up".into()),
            _ => self.wrapped()?.advice(),
        }
    }
}

impl Tolerance {
    #[doc(hidden)]
    pub fn check(self) -> Result<(), HaarError> {
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

    #[doc(hidden)]
    pub fn budget(self, total: u64) -> Budget {
        match self {
            Self::Rms(rms) => Budget::Energy(rms * rms * total as f64 * SLACK),
            Self::Epsilon(epsilon) => Budget::Energy(epsilon * epsilon * SLACK),
            Self::Coefficients(kept) => Budget::Count(total.saturating_sub(kept)),
        }
    }
}

impl Coefficients {
    /// Drops (sets to 0) the smallest coefficients. In order of decreasing magnitude, with ties in order of their index, the
    /// fewest stay for which the squares of the dropped ones sum to at most ε². Sums are compared up to 2⁻³⁴ of ε², so that
    /// rounding does not decide about sums of just ε².
    ///
    /// O(n), independent of the number of threads. Zeros are always dropped if an error is requested, so `Rms(0.0)` keeps the
    /// coefficients that are not 0.
    ///
    /// # Errors
    /// [`HaarError::Tolerance`] if the tolerance is negative or NaN.
    #[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
    pub fn truncate(&mut self, asked: Tolerance) -> Result<Truncation, HaarError> {
        asked.check()?;
        let values = self.values.as_slice_mut().expect("standard layout");
        let total = values.len() as u64;
        let (cut, dropped) = Cut::new(values, asked.budget(total));
        values.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, values)| {
            for (value, i) in values.iter_mut().zip((chunk * CHUNK) as u64..) {
                // There are no branches, as it is unpredictable which coefficients stay.
                *value = if cut.keeps(*value, i) { *value } else { 0.0 };
            }
        });
        Ok(Truncation::new(asked, total, dropped))
    }
}

impl Truncation {
    /// The result of dropping `dropped` of `total` coefficients.
    #[doc(hidden)]
    pub fn new(asked: Tolerance, total: u64, dropped: Dropped) -> Self {
        Self {
            asked,
            kept: total - dropped.count,
            total,
            epsilon: dropped.energy.sqrt(),
            rms: (dropped.energy / total as f64).sqrt(),
        }
    }
}
