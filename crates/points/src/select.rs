use ndarray::Array3;
use serde::{Deserialize, Serialize};
use walpha_base::advice::Setting;
use walpha_base::memory;
use walpha_base::parallel::prelude::*;
use walpha_base::setters;

use super::{Points, PointsError};
use crate::largest::{Budget, Cut};
use walpha_volume::{Coordinates, Dims, Frame, Volume};

/// The number of voxels in one parallel task.
const CHUNK: usize = 1 << 16;

/// The choice of the voxels that become points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Selection {
    /// How many voxels are selected, or which.
    pub rule: SelectionRule,
    /// Voxels of the truncated volume below this gray level are left out.
    pub gray_min: Option<f64>,
}

impl Selection {
    setters! { rule: SelectionRule, gray_min: Option<f64> }
}

/// The rule of a [`Selection`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SelectionRule {
    /// This many voxels of largest L, ties in order of the voxel index. It is an error if fewer voxels take part and have an L
    /// above 0, unless all voxels that take part are requested.
    Count(u64),
    /// This share of all voxels of the volume, above 0 and up to 1, rounded to the nearest count (half up, and at least 1), then
    /// like `Count`.
    Ratio(f64),
    /// Like `Ratio`, but selects all voxels that take part and have an L above 0 if they are fewer.
    AtMost(f64),
    /// All voxels with L of at least this, in gray levels. Ties count: as doubles, 5/6 is at least 5/6.
    Threshold(f64),
}

impl SelectionRule {
    /// 6.09 %: the paper keeps 15956 of 262144 samples.
    #[doc(hidden)]
    pub const PAPER: f64 = 0.0609;
}

/// The default is the paper's share.
impl Default for SelectionRule {
    fn default() -> Self {
        Self::AtMost(Self::PAPER)
    }
}

/// The units of the coordinates of points. They have no default except that of a `Recipe` of `walpha-model`, which depends on
/// what the file states.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Units {
    /// Indices of samples, as in the paper.
    Voxel,
    /// World coordinates, by the spacing, origin and direction of the file's grid.
    World,
}

impl Units {
    /// The axes and unit of the coordinates of a volume's points.
    pub fn coordinates(self, volume: &Volume) -> Coordinates {
        self.coordinates_of(volume.frame())
    }

    /// The axes and unit of the coordinates of a grid's points.
    pub fn coordinates_of(self, frame: &Frame) -> Coordinates {
        match self {
            Self::Voxel => Coordinates::VOXEL,
            Self::World => frame.coordinates,
        }
    }

    /// The volume, in these units, of the box between the outermost samples.
    pub fn box_volume(self, volume: &Volume) -> f64 {
        let steps: f64 = volume.dims().xyz().map(|n| (n - 1) as f64).iter().product();
        steps * self.cell(volume.frame())
    }

    /// The volume of a voxel in these units.
    pub fn cell(self, frame: &Frame) -> f64 {
        match self {
            Self::Voxel => 1.0,
            Self::World => frame.cell(),
        }
    }

    /// The position of a voxel, given by its index x + X·(y + Y·z), in these units.
    pub fn position(self, volume: &Volume, voxel: u32) -> [f64; 3] {
        self.place(volume.frame(), volume.dims(), voxel.into())
    }

    /// Like [`position`](Self::position), for a grid of `dims` samples.
    pub fn place(self, frame: &Frame, dims: Dims, voxel: u64) -> [f64; 3] {
        let [nx, ny, _] = dims.xyz();
        let voxel = voxel as usize;
        let index = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)].map(|i| i as f64);
        match self {
            Self::Voxel => index,
            Self::World => frame.to_world(index),
        }
    }
}

/// Selects voxels, in order of their index x + X·(y + Y·z).
///
/// `volume` gives the grid and the values of the points, and its missing samples are left out. `smoothed` is the truncated
/// volume, to which `gray_min` applies, and `differences` are its [`difference`](super::difference)s. O(n), parallel, independent
/// of the number of threads.
///
/// # Errors
/// The values of the truncated volume are not gray levels ([`Volume::into_gray`] makes them), a number in the rule is out of
/// range, more voxels are requested than differ from a neighbour, no voxel is left, or there is not enough memory.
///
/// # Panics
/// The three shapes differ.
pub fn select(
    volume: &Volume,
    smoothed: &Volume,
    differences: &Array3<f64>,
    selection: &Selection,
    units: Units,
) -> Result<Points, PointsError> {
    assert_eq!(volume.dims(), smoothed.dims(), "one grid");
    assert_eq!(volume.dims().shape(), *differences.shape(), "one grid");
    // Thresholds, errors and weights are in gray levels: Hounsfield units would be mistaken for them.
    if !smoothed.has_gray_levels() {
        let (low, high) = smoothed.value_range();
        return Err(PointsError::NotGray { low, high });
    }
    let n = volume.dims().samples();
    let standard = differences.as_standard_layout();
    let flat = standard.as_slice().expect("standard layout");
    check_least(selection.gray_min)?;
    let mask = selection.gray_min.map(|_| Setting::GrayMin);
    let voxels = if mask.is_none() && !volume.has_missing() {
        chosen(flat, n as u64, &selection.rule, mask)?
    } else {
        let least = selection.gray_min.unwrap_or(f64::NEG_INFINITY);
        let takes_part = |i: usize, gray: f32| f64::from(gray) >= least && !volume.is_missing(i);
        let masked = |(i, (&l, &gray)): (usize, (&f64, &f32))| {
            if takes_part(i, gray) { l } else { f64::NAN }
        };
        let bytes = size_of_val(flat);
        memory::afford(bytes, || format!("the choice among {} samples", volume.dims()))?;
        let pairs = flat.par_iter().zip(smoothed.as_slice()).enumerate();
        let masked: Vec<f64> = pairs.map(masked).collect();
        let available = masked.par_iter().filter(|l| !l.is_nan()).count() as u64;
        if available == 0 {
            let highest = f64::from(smoothed.value_range().1);
            return Err(match selection.gray_min {
                Some(least) => PointsError::Masked { least, highest },
                None => PointsError::Empty { voxels: n as u64 },
            });
        }
        chosen(&masked, available, &selection.rule, mask)?
    };
    Ok(points_at(volume, differences, &voxels, units))
}

/// The points at some voxels, given by index x + X·(y + Y·z), in the order given, with their values in
/// `volume` and their differences in `differences`.
///
/// # Panics
/// The two shapes differ, or a voxel is out of range.
pub fn points_at(
    volume: &Volume,
    differences: &Array3<f64>,
    voxels: &[u32],
    units: Units,
) -> Points {
    assert_eq!(volume.dims().shape(), *differences.shape(), "one grid");
    let differences = differences.as_standard_layout();
    let values = volume.as_slice();
    let flat = differences.as_slice().expect("standard layout");
    Points {
        positions: voxels.par_iter().map(|&voxel| units.position(volume, voxel)).collect(),
        values: Some(voxels.par_iter().map(|&i| f64::from(values[i as usize])).collect()),
        differences: Some(voxels.par_iter().map(|&i| flat[i as usize]).collect()),
        ..Points::default()
    }
}

/// The indices that the rule selects, ascending. Voxels that are masked or missing are NaN; the other `available` ones are not.
fn chosen(
    differences: &[f64],
    available: u64,
    rule: &SelectionRule,
    mask: Option<Setting>,
) -> Result<Vec<u32>, PointsError> {
    match rule.asked(differences.len() as u64)? {
        Asked::Largest(most) => {
            let differing = differences.par_iter().filter(|&&l| l > 0.0).count() as u64;
            let left = most.not_chosen(available, differing)?;
            let (cut, _) = Cut::new(differences, Budget::Count(left));
            Ok(collect(differences, |l, i| cut.keeps(l, i as u64)))
        }
        Asked::AtLeast(least) => {
            let chosen = collect(differences, |l, _| l >= least);
            if chosen.is_empty() {
                let largest = Some(differences.iter().copied().fold(0.0, f64::max));
                return Err(PointsError::Threshold { least, largest, mask });
            }
            Ok(chosen)
        }
    }
}

/// A rule applied to a volume.
pub enum Asked {
    /// This many voxels, those of largest L.
    Largest(Most),
    /// All voxels with an L of at least this.
    AtLeast(f64),
}

/// A number of voxels.
#[derive(Clone, Copy)]
pub struct Most {
    count: u64,
    /// Whether all that differ are selected if they are fewer.
    or_fewer: bool,
    /// The number of voxels that the count is a share of, if a share was given.
    of: Option<u64>,
}

impl Most {
    /// The number of available voxels that are not selected, if `differing` of them differ from a neighbour. Voxels that do not
    /// differ are never selected before one another, as only their indices would distinguish them.
    pub fn not_chosen(self, available: u64, differing: u64) -> Result<u64, PointsError> {
        let Self { count: asked, or_fewer, of } = self;
        // All voxels are selected, so there is no choice.
        if asked == available && !or_fewer {
            return Ok(0);
        }
        if differing == 0 {
            return Err(PointsError::Flat { available, tolerance: Setting::Rms });
        }
        if or_fewer && asked > differing {
            tracing::warn!(
                "{differing} of {available} samples that take part differ from a neighbour, fewer than the {asked} \
                 that are selected by default: these become points"
            );
            return Ok(available - differing);
        }
        if asked == 0 || asked > differing {
            // The share is rounded down, so that it can be met.
            let share = |voxels: u64| (1e4 * differing as f64 / voxels as f64).floor() / 1e4;
            let ratio = of.map(share).filter(|&ratio| ratio > 0.0);
            return Err(PointsError::Count { asked, available: differing, ratio });
        }
        Ok(available - asked)
    }
}

impl SelectionRule {
    /// The rule for a volume of `voxels` voxels.
    #[doc(hidden)]
    pub fn asked(&self, voxels: u64) -> Result<Asked, PointsError> {
        let wrong = |what, given, need| Err(PointsError::Number { what, given, need });
        match *self {
            Self::Count(count) => Ok(Asked::Largest(Most { count, or_fewer: false, of: None })),
            Self::Ratio(ratio) | Self::AtMost(ratio) if ratio > 0.0 && ratio <= 1.0 => {
                let count = ((ratio * voxels as f64).round() as u64).clamp(1, voxels);
                let or_fewer = matches!(self, Self::AtMost(_));
                Ok(Asked::Largest(Most { count, or_fewer, of: Some(voxels) }))
            }
            Self::Ratio(ratio) | Self::AtMost(ratio) => {
                wrong("a ratio of", ratio, "a share above 0 and up to 1, as in 0.0609 for 6.09 %")
            }
            Self::Threshold(least) if least.is_nan() => {
                wrong("a threshold of", least, "a number of gray levels")
            }
            Self::Threshold(least) => Ok(Asked::AtLeast(least)),
        }
    }
}

/// The name of the least gray level in an error.
pub const LEAST_GRAY: &str = "a least gray level of";

/// Refuses NaN as the least gray level.
///
/// # Errors
/// [`PointsError::Number`].
pub fn check_least(gray_min: Option<f64>) -> Result<(), PointsError> {
    match gray_min {
        Some(given) if given.is_nan() => {
            Err(PointsError::Number { what: LEAST_GRAY, given, need: "a number" })
        }
        _ => Ok(()),
    }
}

/// The indices of the wanted values, ascending.
fn collect(values: &[f64], wanted: impl Fn(f64, usize) -> bool + Sync) -> Vec<u32> {
    let of_chunk = |(chunk, values): (usize, &[f64])| {
        let indices = (chunk * CHUNK..).zip(values);
        indices.filter(|&(i, &l)| wanted(l, i)).map(|(i, _)| i as u32).collect::<Vec<_>>()
    };
    let chunks: Vec<Vec<u32>> = values.par_chunks(CHUNK).enumerate().map(of_chunk).collect();
    chunks.concat()
}
