//! The orthonormal Haar transform of a volume, its truncation, and the inverse transform.
//!
//! Steps 1 to 5 of the paper, equations 3.1 to 3.3; the truncation rule is that of Stollnitz,
//! `DeRose` and Salesin, "Wavelets for computer graphics: a primer" (IEEE CG&A 15(3), 1995,
//! doi:10.1109/38.376616): coefficients in order of decreasing magnitude, as few as the error
//! allows.
//!
//! ```
//! use ndarray::arr3;
//! use walpha_points::haar::{Decomposition, Tolerance, forward};
//!
//! let row = arr3(&[[[9.0, 7.0, 3.0, 5.0]]]);
//! let mut coefficients = forward(row.view(), Decomposition::NonStandard);
//! // Σ(f − f̂)² may be up to 4·1²: the detail −1 of [3, 5] goes, and so does the 1 of [9, 7].
//! let truncation = coefficients.truncate(Tolerance::Rms(1.0))?;
//! assert_eq!((truncation.kept, truncation.total), (2, 4));
//! assert!(coefficients.inverse().iter().zip([8.0, 8.0, 4.0, 4.0]).all(|(a, b)| (a - b).abs() < 1e-6));
//! # Ok::<(), walpha_points::haar::HaarError>(())
//! ```

mod coefficients;
mod nonstandard;
mod standard;
mod support;
mod unnormalised;

pub use coefficients::{Coefficients, Decomposition, forward};
pub use coefficients::{HaarError, Tolerance, Truncation};
pub use unnormalised::Unnormalised;

pub(crate) mod internal {
    pub use super::nonstandard::Bricks;
    pub use super::standard::Slabs;
}

use serde::{Deserialize, Serialize};
use walpha_base::Monitor;
use walpha_base::memory;
use walpha_base::setters;

use walpha_volume::Volume;

/// The options for the transform and truncation of a volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct HaarOptions {
    /// The three-dimensional decomposition.
    pub decomposition: Decomposition,
    /// How much of the volume may be lost.
    pub tolerance: Tolerance,
}

impl HaarOptions {
    setters! { decomposition: Decomposition, tolerance: Tolerance }
}

/// Computes the truncated volume f̂ of a volume f: transform, truncation, inverse transform.
///
/// If only zeros are dropped, f̂ equals f bit for bit. O(n); the result does not depend on the number of threads. The
/// coefficients, in double precision, are in memory together with f, and then with f̂.
///
/// # Errors
/// The tolerance is not valid (see [`Coefficients::truncate`]), samples are so large that f̂ exceeds the range of `f32`, there is
/// not enough memory, or a [`Monitor`] that watches was cancelled.
pub fn smooth(volume: &Volume, options: &HaarOptions) -> Result<(Volume, Truncation), HaarError> {
    let monitor = &*Monitor::current();
    options.tolerance.check()?;
    let dims = volume.dims();
    let bytes = dims.samples().saturating_mul(size_of::<f64>() + size_of::<f32>());
    memory::afford(bytes, || format!("transforming {dims} samples"))?;
    // Both transforms take equally long, and truncation takes little time.
    let mut coefficients = forward(volume.samples(), options.decomposition);
    monitor.report(4, 9)?;
    let truncation = coefficients.truncate(options.tolerance)?;
    monitor.report(5, 9)?;
    if truncation.epsilon == 0.0 {
        drop(coefficients);
        return Ok((volume.clone(), truncation));
    }
    let smoothed = Volume::new(coefficients.inverse(), *volume.frame())?;
    let smoothed = if volume.has_gray_levels() { smoothed.with_gray_levels() } else { smoothed };
    Ok((smoothed, truncation))
}
