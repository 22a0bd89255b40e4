use serde::{Deserialize, Deserializer, Serialize};
use walpha_base::vector::{cross, dot};

use super::{Conversion, Coordinates, VolumeError};

/// The number of samples along each axis of a volume, checked once: no axis is empty, and the volume has at most
/// [`Dims::MAX_SAMPLES`] samples, so that a voxel index fits `u32` and a byte count `u64`. A volume that is read [part by
/// part](Dims::unbounded) may have more.
///
/// The order is (x, y, z), as for points; the underlying array is `[z, y, x]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Dims {
    x: usize,
    y: usize,
    z: usize,
}

/// Sizes before they are checked.
#[derive(Deserialize)]
struct Unchecked {
    x: u64,
    y: u64,
    z: u64,
}

impl TryFrom<Unchecked> for Dims {
    type Error = VolumeError;

    fn try_from(Unchecked { x, y, z }: Unchecked) -> Result<Self, VolumeError> {
        Self::new(x, y, z)
    }
}

/// Deserializes the sizes of a volume that is read part by part. For `#[serde(deserialize_with)]`.
///
/// # Errors
/// Errors of the deserializer.
pub fn any_size<'de, D: Deserializer<'de>>(reader: D) -> Result<Dims, D::Error> {
    let Unchecked { x, y, z } = Unchecked::deserialize(reader)?;
    Dims::unbounded(x, y, z).map_err(serde::de::Error::custom)
}

impl Dims {
    /// The maximum is 2³² − 1: simplices name their vertices by `u32` indices, and a volume of 1625³ samples is the most that a
    /// machine able to triangulate its points would hold.
    pub const MAX_SAMPLES: u64 = u32::MAX as u64;

    /// Checks sizes along x, y and z that a file header or a user gives.
    ///
    /// # Errors
    /// [`VolumeError::EmptyAxis`] if one is zero; [`VolumeError::TooManySamples`] if the product exceeds [`Dims::MAX_SAMPLES`].
    /// Nothing is allocated.
    pub fn new(x: u64, y: u64, z: u64) -> Result<Self, VolumeError> {
        if x == 0 || y == 0 || z == 0 {
            return Err(VolumeError::EmptyAxis { x, y, z });
        }
        let samples = x.checked_mul(y).and_then(|xy| xy.checked_mul(z));
        match samples {
            Some(n) if n <= Self::MAX_SAMPLES => {
                Ok(Self { x: x as usize, y: y as usize, z: z as usize })
            }
            _ => Err(VolumeError::TooManySamples { x, y, z }),
        }
    }

    /// Like [`new`](Self::new), without the limit on what can be read at once: for volumes that are read part by part.
    ///
    /// # Errors
    /// [`VolumeError::EmptyAxis`]; [`VolumeError::TooManySamples`] if the size of the samples exceeds 2⁶³ bytes, or their number
    /// `usize`.
    pub fn unbounded(x: u64, y: u64, z: u64) -> Result<Self, VolumeError> {
        /// The largest size of a sample in bytes.
        const WIDEST: u64 = 8;
        if x == 0 || y == 0 || z == 0 {
            return Err(VolumeError::EmptyAxis { x, y, z });
        }
        let bytes = x.checked_mul(y).and_then(|xy| xy.checked_mul(z)?.checked_mul(WIDEST));
        let fits =
            |bytes: u64| i64::try_from(bytes).is_ok() && usize::try_from(bytes / WIDEST).is_ok();
        match bytes {
            Some(bytes) if fits(bytes) => Ok(Self { x: x as usize, y: y as usize, z: z as usize }),
            _ => Err(VolumeError::TooManySamples { x, y, z }),
        }
    }

    /// Checks these sizes against [`Dims::MAX_SAMPLES`], and returns them.
    ///
    /// # Errors
    /// [`VolumeError::TooManySamples`].
    pub fn bounded(self) -> Result<Self, VolumeError> {
        Self::new(self.x as u64, self.y as u64, self.z as u64)
    }

    /// The number of samples along x, the fastest axis in memory.
    pub fn x(self) -> usize {
        self.x
    }

    /// The number of samples along y.
    pub fn y(self) -> usize {
        self.y
    }

    /// The number of samples along z, the slowest axis in memory.
    pub fn z(self) -> usize {
        self.z
    }

    /// The number of samples in all.
    pub fn samples(self) -> usize {
        self.x * self.y * self.z
    }

    /// The size of all samples in bytes, if one has `each` bytes.
    pub fn bytes(self, each: usize) -> u64 {
        self.samples() as u64 * each as u64
    }

    /// The shape of the array, `[z, y, x]`.
    pub fn shape(self) -> [usize; 3] {
        [self.z, self.y, self.x]
    }

    /// The sizes as (x, y, z).
    pub fn xyz(self) -> [usize; 3] {
        [self.x, self.y, self.z]
    }
}

impl std::fmt::Display for Dims {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}×{}×{}", self.x, self.y, self.z)
    }
}

/// The place of a grid in the world: sample (i, j, k) along (x, y, z) is at `origin + direction · (spacing ∘ (i, j, k))`, in
/// coordinates whose meaning is stated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// The world position of the first sample, (x, y, z).
    pub origin: [f64; 3],
    /// The distances between neighbouring samples along the grid's x, y and z axes.
    pub spacing: [f64; 3],
    /// Unit vectors of the grid's axes: `direction[r][c]` is world component r of grid axis c.
    pub direction: [[f64; 3]; 3],
    /// The meaning of world positions; voxels if a file states nothing about its grid.
    pub coordinates: Coordinates,
}

impl Frame {
    /// The grid with origin 0, spacing 1 and axes along the world's: voxel units.
    pub const VOXEL: Self = Self {
        origin: [0.0; 3],
        spacing: [1.0; 3],
        direction: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        coordinates: Coordinates::VOXEL,
    };

    /// The frame whose grid axes step by these vectors from one sample to the next: `axes[c]` is the step of grid axis c. The
    /// space and the unit are unknown. `None` if an axis is zero or not finite.
    pub fn from_axes(origin: [f64; 3], axes: [[f64; 3]; 3]) -> Option<Self> {
        let coordinates = Coordinates::default();
        let mut frame = Self { origin, coordinates, ..Self::VOXEL };
        for (c, axis) in axes.iter().enumerate() {
            // The axis is scaled, so that one along a world axis has its length to the last bit.
            let largest = axis.iter().fold(0f64, |so_far, v| so_far.max(v.abs()));
            let squares: f64 = axis.iter().map(|v| (v / largest).powi(2)).sum();
            frame.spacing[c] = largest * squares.sqrt();
            for (row, component) in frame.direction.iter_mut().zip(axis) {
                row[c] = component / frame.spacing[c];
            }
        }
        // For a zero axis, 0 has been divided by 0.
        let numbers = origin.iter().chain(&frame.spacing).chain(frame.direction.as_flattened());
        numbers.copied().all(f64::is_finite).then_some(frame)
    }

    /// Declares this frame to be in the given coordinates. No number changes.
    #[must_use]
    pub fn with_coordinates(self, coordinates: Coordinates) -> Self {
        Self { coordinates, ..self }
    }

    /// Converts this frame to other coordinates, as far as both are known: axes are turned and lengths converted. Unknown
    /// properties do not change. Signs are exact, lengths are rounded once.
    #[must_use]
    pub fn to(self, coordinates: Coordinates) -> Self {
        let conversion: Conversion = self.coordinates.to(coordinates);
        let columns = [0, 1, 2].map(|c| conversion.direction(self.direction.map(|row| row[c])));
        Self {
            origin: conversion.position(self.origin),
            spacing: self.spacing.map(|length| conversion.length(length)),
            direction: [0, 1, 2].map(|r| columns.map(|column| column[r])),
            coordinates: conversion.to,
        }
    }

    /// The grid of every `step`-th sample from the sample `first` on, both as (x, y, z). Fractions are places between samples.
    #[must_use]
    pub fn part(self, first: [f64; 3], step: [f64; 3]) -> Self {
        let spacing = [0, 1, 2].map(|k| self.spacing[k] * step[k]);
        Self { origin: self.to_world(first), spacing, ..self }
    }

    /// The volume of the cell between eight samples.
    pub fn cell(&self) -> f64 {
        let [a, b, c] = self.axes();
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        (a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)).abs()
    }

    /// The steps of the grid's axes, as [`Frame::from_axes`] takes them.
    pub fn axes(&self) -> [[f64; 3]; 3] {
        [0, 1, 2].map(|c| [0, 1, 2].map(|r| self.direction[r][c] * self.spacing[c]))
    }

    /// The world position of a (fractional) sample index, both as (x, y, z).
    pub fn to_world(&self, index: [f64; 3]) -> [f64; 3] {
        let step = [0, 1, 2].map(|c| self.spacing[c] * index[c]);
        [0, 1, 2].map(|r| {
            let row = &self.direction[r];
            self.origin[r] + row[0] * step[0] + row[1] * step[1] + row[2] * step[2]
        })
    }

    /// The (fractional) index of a world position, both as (x, y, z): the inverse of [`to_world`](Self::to_world), up to
    /// rounding. Not finite if the axes lie in a plane.
    pub fn to_index(&self, position: [f64; 3]) -> [f64; 3] {
        let from = [0, 1, 2].map(|k| position[k] - self.origin[k]);
        inverse(self.axes()).map(|row| dot(row, from))
    }

    /// Whether the axes are left-handed: what is positively oriented in the world is negatively oriented in indices.
    #[doc(hidden)]
    pub fn is_mirrored(&self) -> bool {
        let [a, b, c] = self.axes();
        dot(a, cross(b, c)) < 0.0
    }
}

/// The inverse of the matrix with these columns. Not finite if there is none.
pub fn inverse([a, b, c]: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let rows = [cross(b, c), cross(c, a), cross(a, b)];
    let determinant = dot(a, rows[0]);
    rows.map(|row| row.map(|v| v / determinant))
}
