//! The solid inside an isosurface of a volume, by its samples and without α.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use walpha_base::advice::Advise;
use walpha_base::parallel::prelude::*;
use walpha_base::shown::rounded;

use walpha_points::Units;
use walpha_shape::{AlphaShape, Extent, SampleLattice, ShapeError, isosurface_shape};
use walpha_volume::{Frame, Volume};

/// A surface at which a solid ends: an isosurface of a volume, or the outer part of one.
///
/// Serialised, and written on the command line, as a number or `auto`, with `:closed` after it for a closed solid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
#[non_exhaustive]
pub struct SurfaceChoice {
    /// The value of the file; `None` takes the one that best divides the samples into two classes, by their histogram ([`otsu`]).
    pub value: Option<f64>,
    /// All of what is at least the value, or one closed solid.
    pub extent: Extent,
}

/// Text that does not name a surface.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is not a value: it is a number, as in 250, or auto, and :closed may follow")]
pub struct NotAValue(String);

impl Advise for NotAValue {}

/// What follows a value where the solid is closed.
const CLOSED: &str = ":closed";

impl FromStr for SurfaceChoice {
    type Err = NotAValue;

    fn from_str(text: &str) -> Result<Self, NotAValue> {
        let (value, extent) = match text.trim().strip_suffix(CLOSED) {
            Some(value) => (value, Extent::Closed),
            None => (text.trim(), Extent::Whole),
        };
        let value = match value.parse() {
            _ if value == "auto" => None,
            Ok(value) if f64::is_finite(value) => Some(value),
            _ => return Err(NotAValue(text.into())),
        };
        Ok(Self { value, extent })
    }
}

impl TryFrom<String> for SurfaceChoice {
    type Error = NotAValue;

    fn try_from(text: String) -> Result<Self, NotAValue> {
        text.parse()
    }
}

impl From<SurfaceChoice> for String {
    fn from(SurfaceChoice { value, extent }: SurfaceChoice) -> Self {
        let value = value.map_or("auto".into(), |value| value.to_string());
        value + if extent == Extent::Closed { CLOSED } else { "" }
    }
}

/// The value at whose isosurface a solid ends, and where it comes from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Isovalue {
    /// The value, one of the file.
    pub value: f64,
    /// Whether it was found by [`otsu`] rather than given.
    pub found: bool,
    /// Whether the solid is the largest part, with cavities filled.
    pub closed: bool,
}

impl Isovalue {
    /// The value for a volume.
    pub(crate) fn of(choice: SurfaceChoice, volume: &Volume) -> Self {
        let (found, closed) = (choice.value.is_none(), choice.extent == Extent::Closed);
        Self { value: choice.value.unwrap_or_else(|| otsu(volume)), found, closed }
    }
}

impl fmt::Display for Isovalue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&rounded(self.value))?;
        if self.found {
            f.write_str(", which divides the histogram of the samples best (Otsu)")?;
        }
        if self.closed {
            f.write_str(", of the largest part, with cavities filled")?;
        }
        Ok(())
    }
}

/// Classes of the histogram.
const CLASSES: usize = 256;

/// The value that divides the samples into two classes so that the variance between these is largest (N. Otsu, *A threshold selection method from gray-level
/// histograms*, 1979, doi:10.1109/TSMC.1979.4310076): air and tissue, where these are the largest ones. It is the end of one of 256 equal parts
/// of the range of values, of several equally good ones the least. Missing samples do not count. O(n).
pub fn otsu(volume: &Volume) -> f64 {
    let (low, high) = volume.value_range();
    let (low, width) = (f64::from(low), (f64::from(high) - f64::from(low)) / CLASSES as f64);
    let samples = volume.as_slice();
    let of_chunk = |counts: Vec<u64>, (i, sample): (usize, &f32)| {
        let mut counts = counts;
        if !volume.is_missing(i) {
            let class = ((f64::from(*sample) - low) / width) as usize;
            counts[class.min(CLASSES - 1)] += 1;
        }
        counts
    };
    let none = || vec![0; CLASSES];
    let counts = samples.par_iter().enumerate().with_min_len(1 << 16).fold(none, of_chunk);
    let counts = counts.reduce(none, |a, b| a.iter().zip(&b).map(|(a, b)| a + b).collect());
    // Number and sum of some classes, in whole numbers.
    let moment = |classes: &[u64], first: usize| -> (f64, f64) {
        let all: u64 = classes.iter().sum();
        let sum: u64 = (first as u64..).zip(classes).map(|(class, count)| class * count).sum();
        (all as f64, sum as f64)
    };
    let between = |end: usize| {
        let ((n, sum), (m, other)) = (moment(&counts[..end], 0), moment(&counts[end..], end));
        if n == 0.0 || m == 0.0 { 0.0 } else { n * m * (sum / n - other / m).powi(2) }
    };
    let best = (1..CLASSES).fold((0, f64::NEG_INFINITY), |best, end| {
        let variance = between(end);
        if variance > best.1 { (end, variance) } else { best }
    });
    low + width * best.0 as f64
}

/// The solid of what is at least `value` in a volume, all of it or closed ([`isosurface_shape`]). The grid lies where `frame` says, whatever the volume's own frame is, unless the
/// units are voxels. Missing samples are outside.
///
/// # Errors
/// The errors of [`isosurface_shape`].
pub fn solid(
    volume: &Volume,
    frame: &Frame,
    units: Units,
    value: f64,
    extent: Extent,
) -> Result<AlphaShape, ShapeError> {
    let laid = match units {
        Units::Voxel => &Frame::VOXEL,
        Units::World => frame,
    };
    let lattice =
        SampleLattice { dims: volume.dims().xyz(), origin: laid.origin, axes: laid.axes() };
    let samples = volume.as_slice();
    let sample = |i: usize| if volume.is_missing(i) { f64::NAN } else { f64::from(samples[i]) };
    let shape = isosurface_shape(&lattice, sample, value, extent)?;
    Ok(shape.with_coordinates(units.coordinates_of(frame)))
}
