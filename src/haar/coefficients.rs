use std::fmt;
use std::str::FromStr;

use ndarray::{Array3, ArrayView3};
use serde::{Deserialize, Serialize};

use super::{nonstandard, standard};

/// Which functions of (x, y, z) the basis is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Decomposition {
    /// All axes step once per level, then the octant of means goes on: cubes of 2ˡ samples a side.
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

impl FromStr for Decomposition {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "nonstandard" => Ok(Self::NonStandard),
            "standard" => Ok(Self::Standard),
            _ => Err(format!("{text:?} is no decomposition: give nonstandard or standard")),
        }
    }
}

/// Orthonormal Haar coefficients of a volume, in the place of its samples.
///
/// Along an axis, the coefficient of the whole row's mean stands at 0, and the detail between the
/// samples from i to i + 2ˡ and those from there to i + 2·2ˡ stands at i + 2ˡ: the number of
/// trailing zeros of an index is its level. In the non-standard decomposition the level of a voxel
/// is the least of its three indices'. A row of four samples becomes `[mean, fine detail of 0 and
/// 1, coarse detail, fine detail of 2 and 3]`:
///
/// ```
/// use ndarray::arr3;
/// use walpha::haar::{Decomposition, forward};
///
/// let coefficients = forward(arr3(&[[[9.0, 7.0, 3.0, 5.0]]]), Decomposition::NonStandard);
/// // Averages [8, 4] → [6] and half-differences [1, −1], [2], each times the norm of its function.
/// let expected = [6.0 * 2.0, 1.0 * 2f32.sqrt(), 2.0 * 2.0, -1.0 * 2f32.sqrt()];
/// for (c, e) in coefficients.values().iter().zip(expected) {
///     assert!((c - e).abs() < 1e-6);
/// }
/// ```
///
/// An odd row keeps its last sample by the unbalanced Haar step: the detail between supports of a
/// and b samples is (√b·s − √a·t)/√(a + b), and a constant volume of any size has details of
/// exactly 0. Sums of squares equal those of the samples up to the rounding of `f32`.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    pub(super) values: Array3<f32>,
    decomposition: Decomposition,
}

/// Transforms samples `[z, y, x]`, in place if they are in standard layout.
///
/// O(n), parallel, the same on any number of threads. Sample magnitudes whose
/// sum or norm passes the range of `f32` overflow; gray levels are far from that.
pub fn forward(samples: Array3<f32>, decomposition: Decomposition) -> Coefficients {
    let mut values = if samples.is_standard_layout() {
        samples
    } else {
        samples.as_standard_layout().into_owned()
    };
    match decomposition {
        Decomposition::NonStandard => nonstandard::forward(&mut values),
        Decomposition::Standard => standard::forward(&mut values),
    }
    Coefficients { values, decomposition }
}

impl Coefficients {
    /// The coefficients, at their places in `[z, y, x]`.
    pub fn values(&self) -> ArrayView3<'_, f32> {
        self.values.view()
    }

    /// The decomposition they belong to.
    pub fn decomposition(&self) -> Decomposition {
        self.decomposition
    }

    /// The samples `[z, y, x]` that have these coefficients, in place. O(n), parallel, the same on
    /// any number of threads.
    pub fn inverse(self) -> Array3<f32> {
        let mut values = self.values;
        match self.decomposition {
            Decomposition::NonStandard => nonstandard::inverse(&mut values),
            Decomposition::Standard => standard::inverse(&mut values),
        }
        values
    }
}
