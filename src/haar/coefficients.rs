use std::fmt;

use ndarray::{Array3, ArrayView3, Zip};
use serde::{Deserialize, Serialize};

use super::{nonstandard, standard};

/// Which functions of (x, y, z) the basis is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Decomposition {
    /// All axes step once per level, then the octant of means continues: cubes of 2ˡ samples a side.
    #[default]
    NonStandard,
    /// Each axis is transformed fully: boxes of any powers of two.
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

/// Orthonormal Haar coefficients of a volume, in the place of its samples.
///
/// Along an axis, the coefficient of the whole row's mean is at 0, and the detail between the
/// samples from i to i + 2ˡ and those from there to i + 2·2ˡ is at i + 2ˡ: the number of
/// trailing zeros of an index is its level. In the non-standard decomposition the level of a voxel
/// is the least of its three indices'. A row of four samples becomes `[mean, fine detail of 0 and
/// 1, coarse detail, fine detail of 2 and 3]`:
///
/// ```
/// use ndarray::arr3;
/// use walpha::haar::{Decomposition, forward};
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

/// Transforms samples `[z, y, x]`. O(n), parallel, the same on any number of threads.
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
    /// The coefficients, at their places in `[z, y, x]`.
    pub fn values(&self) -> ArrayView3<'_, f64> {
        self.values.view()
    }

    /// The decomposition they belong to.
    pub fn decomposition(&self) -> Decomposition {
        self.decomposition
    }

    /// The samples `[z, y, x]` that have these coefficients, rounded once. O(n), parallel, the same
    /// on any number of threads.
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
