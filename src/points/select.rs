use ndarray::Array3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::PointsError;
use crate::haar::{Budget, Cut};
use crate::volume::Volume;

/// Voxels looked at as one piece of work.
const CHUNK: usize = 1 << 16;

/// Which voxels become points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Selection {
    /// By what rule.
    pub rule: SelectionRule,
    /// Voxels of the truncated volume below this gray level take no part.
    pub gray_min: Option<f64>,
}

/// The rule of a [`Selection`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SelectionRule {
    /// This many voxels of the largest L, ties in order of the voxel index.
    Count(u64),
    /// This share of all voxels of the volume, above 0 and up to 1, rounded to the nearest count
    /// (half up, and at least 1), then as `Count`; the voxels that `gray_min` leaves are too few
    /// if they are fewer than that.
    Ratio(f64),
    /// All voxels with L of at least this, in gray levels.
    Threshold(f64),
}

/// 6.09 %: the paper keeps 15956 of 262144 points.
impl Default for SelectionRule {
    fn default() -> Self {
        Self::Ratio(0.0609)
    }
}

/// What the coordinates of points are measured in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Units {
    /// Indices of samples, as in the paper.
    #[default]
    Voxel,
    /// The file's units, by the spacing, origin and direction of its grid.
    World,
}

/// Points with what is known of them, one entry each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points {
    /// Coordinates (x, y, z).
    pub positions: Vec<[f64; 3]>,
    /// Values F: the original gray levels, or a column of the input.
    pub values: Option<Vec<f64>>,
    /// Differences L; none for scattered input.
    pub differences: Option<Vec<f64>>,
    /// Weights that came with the input.
    pub weights: Option<Vec<f64>>,
}

impl Points {
    /// The number of points.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }
}

/// Selects voxels, in order of their index x + X·(y + Y·z).
///
/// `volume` gives the values of the points and the grid, `smoothed` is the truncated volume, which
/// `gray_min` judges, and `differences` are its [`difference`](super::difference)s. O(n),
/// parallel, the same on any number of threads.
///
/// # Errors
/// A rule whose number makes no sense, more voxels asked for than there are, or no voxel left.
///
/// # Panics
/// When the three are not of one shape.
pub fn select(
    volume: &Volume,
    smoothed: &Volume,
    differences: &Array3<f32>,
    selection: &Selection,
    units: Units,
) -> Result<Points, PointsError> {
    assert_eq!(volume.dims(), smoothed.dims(), "one grid");
    assert_eq!(volume.dims().shape(), *differences.shape(), "one grid");
    let n = volume.dims().samples();
    let differences = differences.as_standard_layout();
    let flat = differences.as_slice().expect("standard layout");
    let voxels = match selection.gray_min {
        None => chosen(n, |i| Some(flat[i].to_bits()), &selection.rule)?,
        Some(least) if least.is_nan() => {
            return Err(PointsError::Number { what: "--gray-min", given: least, need: "a number" });
        }
        Some(least) => {
            let gray = smoothed.as_slice();
            let key = |i: usize| (f64::from(gray[i]) >= least).then(|| flat[i].to_bits());
            chosen(n, key, &selection.rule)?
        }
    };
    let [nx, ny, _] = volume.dims().xyz();
    let position = |&voxel: &u32| {
        let voxel = voxel as usize;
        let index = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)].map(|i| i as f64);
        match units {
            Units::Voxel => index,
            Units::World => volume.frame().to_world(index),
        }
    };
    let samples = volume.as_slice();
    let of = |column: &[f32]| voxels.par_iter().map(|&i| f64::from(column[i as usize])).collect();
    Ok(Points {
        positions: voxels.par_iter().map(position).collect(),
        values: Some(of(samples)),
        differences: Some(of(flat)),
        weights: None,
    })
}

/// The indices the rule chooses among those that have a key, ascending.
fn chosen(
    n: usize,
    key: impl Fn(usize) -> Option<u32> + Sync,
    rule: &SelectionRule,
) -> Result<Vec<u32>, PointsError> {
    let voxels = match *rule {
        SelectionRule::Threshold(least) if least.is_nan() => {
            return Err(PointsError::Number {
                what: "--threshold",
                given: least,
                need: "a number of gray levels",
            });
        }
        SelectionRule::Threshold(least) => {
            collect(n, |i| key(i).is_some_and(|bits| f64::from(f32::from_bits(bits)) >= least))
        }
        SelectionRule::Ratio(ratio) if !(ratio > 0.0 && ratio <= 1.0) => {
            let need = "a share above 0 and up to 1, as in 0.0609 for 6.09 %";
            return Err(PointsError::Number { what: "--ratio", given: ratio, need });
        }
        SelectionRule::Ratio(ratio) => {
            let count = ((ratio * n as f64).round() as u64).clamp(1, n as u64);
            largest(n, key, count)?
        }
        SelectionRule::Count(count) => largest(n, key, count)?,
    };
    if voxels.is_empty() { Err(PointsError::Empty { voxels: n as u64 }) } else { Ok(voxels) }
}

fn largest(
    n: usize,
    key: impl Fn(usize) -> Option<u32> + Sync,
    count: u64,
) -> Result<Vec<u32>, PointsError> {
    let available = (0..n).into_par_iter().filter(|&i| key(i).is_some()).count() as u64;
    if count == 0 || count > available {
        return Err(PointsError::Count { asked: count, available });
    }
    let cut = Cut::new(n, &key, Budget::Count(available - count));
    Ok(collect(n, |i| key(i).is_some_and(|bits| cut.keeps(bits, i))))
}

/// The indices below n that are wanted, ascending.
fn collect(n: usize, wanted: impl Fn(usize) -> bool + Sync) -> Vec<u32> {
    let of_chunk = |chunk: usize| {
        let range = chunk * CHUNK..n.min((chunk + 1) * CHUNK);
        range.filter(|&i| wanted(i)).map(|i| i as u32).collect::<Vec<_>>()
    };
    let chunks: Vec<Vec<u32>> = (0..n.div_ceil(CHUNK)).into_par_iter().map(of_chunk).collect();
    chunks.concat()
}
