//! The solid of labels: a segmentation as a shape that consists of its voxels, without α.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use walpha_base::Cancelled;
use walpha_base::advice::{Advice, Advise, wrapped};
use walpha_base::memory::{NoMemory, try_reserve};
use walpha_base::monitor::wraps;
use walpha_base::shown::number;

use walpha_points::Units;
use walpha_shape::{AlphaShape, ShapeError, Voxels, voxel_shape};
use walpha_volume::{Frame, Labels, LengthUnit, Volume};

/// The labels of a segmentation whose solid is made.
///
/// It is serialised, and written on the command line, as `all` or as numbers with commas between them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub enum LabelChoice {
    /// All labels that are not 0.
    All,
    /// These labels.
    These(Vec<i32>),
}

/// The error for a list of labels that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{0:?} is not a label: labels are whole numbers with commas between them, as in 3,5, or all"
)]
pub struct UnknownLabels(String);

impl Advise for UnknownLabels {}

impl FromStr for LabelChoice {
    type Err = UnknownLabels;

    fn from_str(text: &str) -> Result<Self, UnknownLabels> {
        if text.trim() == "all" {
            return Ok(Self::All);
        }
        let label = |item: &str| item.trim().parse().map_err(|_| UnknownLabels(item.into()));
        text.split(',').map(label).collect::<Result<_, _>>().map(Self::These)
    }
}

impl TryFrom<String> for LabelChoice {
    type Error = UnknownLabels;

    fn try_from(text: String) -> Result<Self, UnknownLabels> {
        text.parse()
    }
}

impl From<LabelChoice> for String {
    fn from(choice: LabelChoice) -> Self {
        match choice {
            LabelChoice::All => "all".into(),
            LabelChoice::These(labels) => {
                labels.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
            }
        }
    }
}

/// A label, and the part of a volume that it fills.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LabelSize {
    /// The label.
    pub label: i32,
    /// The number of its voxels.
    pub voxels: u64,
    /// The volume of its voxels.
    pub volume: f64,
}

/// Labels with the parts of a volume that they fill.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LabelSizes {
    /// Each label other than 0, ascending.
    pub labels: Vec<LabelSize>,
    /// The number of voxels of all labels.
    pub voxels: u64,
    /// The volume of a voxel.
    pub voxel_volume: f64,
    /// The volume of all labels: the number of voxels times the volume of one.
    pub volume: f64,
    /// The unit of length; volumes are in its cube.
    pub unit: LengthUnit,
}

impl LabelSizes {
    /// The sizes of labels with these numbers of voxels, on a grid, in these units.
    pub fn new(counts: impl IntoIterator<Item = (i32, u64)>, frame: &Frame, units: Units) -> Self {
        let (voxel_volume, unit) = (units.cell(frame), units.coordinates_of(frame).unit);
        let size = |(label, voxels): (i32, u64)| LabelSize {
            label,
            voxels,
            volume: voxels as f64 * voxel_volume,
        };
        let labels: Vec<LabelSize> = counts.into_iter().map(size).collect();
        let voxels = labels.iter().map(|size| size.voxels).sum();
        Self { labels, voxels, voxel_volume, volume: voxels as f64 * voxel_volume, unit }
    }
}

/// Displays the number of labels and what they fill in one line.
impl fmt::Display for LabelSizes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { labels, voxels, voxel_volume, volume, unit } = self;
        let unit = unit.symbol();
        write!(f, "{}: {} voxels of ", list(labels.iter().map(|size| size.label)), voxels)?;
        write!(f, "{} {unit}³, together {} {unit}³", number(*voxel_volume), number(*volume))
    }
}

/// The largest number of labels named in one line.
const MOST_NAMED: usize = 12;

/// Lists labels; only the first ones, if there are many.
pub fn list(labels: impl ExactSizeIterator<Item = i32>) -> String {
    let more = labels.len().saturating_sub(MOST_NAMED);
    let named: Vec<String> = labels.take(MOST_NAMED).map(|label| label.to_string()).collect();
    match more {
        0 => named.join(", "),
        more => format!("{} and {more} more", named.join(", ")),
    }
}

/// An error of making the solid of labels.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LabelsError {
    /// The values are not whole numbers.
    #[error("the values are not labels: some are not whole numbers")]
    NotWhole,
    /// Some values are too large.
    #[error(
        "the labels cannot be told apart: some reach 16777216 (2²⁴), from where on several whole numbers are rounded to \
         one sample of single precision"
    )]
    TooLarge,
    /// No voxel has the label.
    #[error("no voxel has the label {label}; {}", there_are(there))]
    Absent {
        /// The label.
        label: i32,
        /// The labels that exist, except 0.
        there: Vec<i32>,
    },
    /// All voxels are background.
    #[error("all voxels have the label 0, the background")]
    Background,
    /// An error in making the solid.
    #[error(transparent)]
    Shape(ShapeError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

wraps! { LabelsError: Shape(ShapeError) }

impl From<NoMemory> for LabelsError {
    fn from(error: NoMemory) -> Self {
        Self::Shape(error.into())
    }
}

fn there_are(labels: &[i32]) -> String {
    match labels {
        [] => "there is none but 0".into(),
        labels => format!("there are {}", list(labels.iter().copied())),
    }
}

impl Advise for LabelsError {
    wrapped!(Shape, Cancelled);

    fn advice(&self) -> Option<Advice> {
        let advice = match self {
            Self::NotWhole => "select by gray levels, without naming labels",
            Self::TooLarge => "number them anew, below 16777216",
            Self::Absent { .. } => "name labels that are there, or all",
            Self::Background => "name a volume with a segmentation",
            Self::Shape(_) | Self::Cancelled(_) => return self.wrapped()?.advice(),
        };
        Some(advice.into())
    }
}

/// The labels of a volume that are chosen, each with its number of voxels.
///
/// # Errors
/// [`LabelsError::NotWhole`], [`LabelsError::TooLarge`], [`LabelsError::Absent`], [`LabelsError::Background`].
pub fn chosen(volume: &Volume, choice: &LabelChoice) -> Result<Vec<(i32, u64)>, LabelsError> {
    let found = Labels::of_any(volume).ok_or_else(|| {
        let are_whole = volume.as_slice().iter().all(|value| value.fract() == 0.0);
        if are_whole { LabelsError::TooLarge } else { LabelsError::NotWhole }
    })?;
    let there: Vec<i32> = found.foreground().map(|(label, _)| label).collect();
    let LabelChoice::These(labels) = choice else {
        if there.is_empty() {
            return Err(LabelsError::Background);
        }
        return Ok(found.foreground().collect());
    };
    let is_there = |label: i32| found.counts.iter().any(|&(other, _)| other == label);
    if let Some(&label) = labels.iter().find(|&&label| !is_there(label)) {
        return Err(LabelsError::Absent { label, there });
    }
    Ok(found.counts.into_iter().filter(|(label, _)| labels.contains(label)).collect())
}

/// The solid of the voxels that have one of these labels: see [`voxel_shape`]. The grid is placed by `frame`, whatever the
/// volume's own frame is, unless the units are voxels. The value of a corner is the most frequent label of its voxels in the
/// solid, or the least of equally frequent ones.
///
/// # Errors
/// [`LabelsError::Shape`] and [`LabelsError::Cancelled`]; no voxel has such a label.
pub fn solid(
    volume: &Volume,
    frame: &Frame,
    units: Units,
    labels: &[i32],
) -> Result<AlphaShape, LabelsError> {
    let mut labels = labels.to_vec();
    labels.sort_unstable();
    let samples = volume.as_slice();
    let label = |voxel: usize| {
        let label = samples[voxel] as i32;
        (labels.binary_search(&label).is_ok() && !volume.is_missing(voxel)).then_some(label)
    };
    let laid = match units {
        Units::Voxel => &Frame::VOXEL,
        Units::World => frame,
    };
    let sizes = volume.dims().xyz();
    let runs = runs(samples.len(), |voxel| label(voxel).is_some())?;
    let (dims, origin, axes) = (sizes.map(|n| n as u32), laid.origin, laid.axes());
    let voxels = Voxels { dims, origin, axes, runs };
    let value = |corner: [u32; 3]| {
        let around = (0..8).filter_map(|i| {
            let at = [0, 1, 2].map(|k| (corner[k] as usize).wrapping_sub(i >> k & 1));
            let [x, y, z] = at;
            let in_grid = (0..3).all(|k| at[k] < sizes[k]);
            if in_grid { label(x + sizes[0] * (y + sizes[1] * z)) } else { None }
        });
        let mut around: Vec<i32> = around.collect();
        around.sort_unstable();
        // `max_by_key` takes the last of equal counts, so the least label comes last.
        let most = around.chunk_by(|a, b| a == b).rev().max_by_key(|equal| equal.len());
        most.map_or(0.0, |equal| f64::from(equal[0]))
    };
    let shape = voxel_shape(voxels, value)?;
    Ok(shape.with_coordinates(units.coordinates_of(frame)))
}

/// The voxels for which `is_inside` holds, as runs.
fn runs(voxels: usize, is_inside: impl Fn(usize) -> bool) -> Result<Vec<[u64; 2]>, NoMemory> {
    let mut runs: Vec<[u64; 2]> = Vec::new();
    let mut was_inside = false;
    for voxel in 0..voxels {
        let inside = is_inside(voxel);
        match runs.last_mut() {
            Some([_, count]) if inside && was_inside => *count += 1,
            _ if inside => {
                try_reserve(&mut runs, 1, || "the voxels of labels".into())?;
                runs.push([voxel as u64, 1]);
            }
            _ => {}
        }
        was_inside = inside;
    }
    Ok(runs)
}
