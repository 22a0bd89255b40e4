use ndarray::Array3;
use serde::{Deserialize, Serialize};
use walpha_base::memory::try_with_capacity;
use walpha_base::parallel::prelude::*;

use super::grid::OUTSIDE;
use super::least_squares::PiecewiseLinear;
use super::raster::owners;
use super::{Grid, Interpolant, InterpolateError};
use walpha_volume::Volume;

/// The values of F at the samples of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Resampled {
    volume: Volume,
    /// The simplex of each sample.
    pub(super) owners: Vec<u32>,
}

impl Interpolant<'_> {
    /// Samples F on a grid. Each sample belongs to one simplex, determined as [`Interpolant`] describes. O(simplices + samples),
    /// parallel over both, independent of the number of threads; 8 bytes a sample.
    ///
    /// # Errors
    /// Values exceed the range of `f32`, or there is not enough memory for the samples.
    #[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
    pub fn resample(&self, grid: &Grid) -> Result<Resampled, InterpolateError> {
        let (there, grid) = self.by_index(grid);
        let owners = owners(&there, &grid)?;
        let [nx, ny, _] = grid.dims().xyz();
        let dims = grid.dims();
        let mut samples =
            try_with_capacity(dims.samples(), || format!("a volume of {dims} samples"))?;
        samples.resize(dims.samples(), 0f32);
        samples.par_chunks_mut(nx).zip(owners.par_chunks(nx)).enumerate().for_each(
            |(row, (samples, owners))| {
                for (i, (sample, &part)) in samples.iter_mut().zip(owners).enumerate() {
                    let place = || grid.position([i, row % ny, row / ny]);
                    if part != OUTSIDE
                        && let Some(coordinates) = there.coordinates(part, place())
                    {
                        *sample = there.value(part, &coordinates) as f32;
                    }
                }
            },
        );
        let samples = Array3::from_shape_vec(dims.shape(), samples).expect("as many as dims say");
        let volume = Volume::new(samples, *grid.frame())?.with_gray_levels();
        Ok(Resampled { volume, owners })
    }
}

impl Resampled {
    /// The values; 0 outside the shape.
    pub fn volume(&self) -> &Volume {
        &self.volume
    }

    /// Gives the samples outside the shape this value instead of 0.
    #[must_use]
    #[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
    pub fn with_outside(self, value: f32) -> Self {
        let Self { volume, owners } = self;
        let frame = *volume.frame();
        let mut samples = volume.into_samples();
        let all = samples.as_slice_mut().expect("volumes are in standard order");
        let outside = all.par_iter_mut().zip(&owners).filter(|(_, owner)| **owner == OUTSIDE);
        outside.for_each(|(sample, _)| *sample = value);
        let volume = Volume::new(samples, frame).expect("the value is finite");
        Self { volume, owners }
    }

    /// Turns this into the volume of its values.
    pub fn into_volume(self) -> Volume {
        self.volume
    }

    /// Whether a sample, by its index in memory order, is on the shape.
    pub fn is_inside(&self, sample: usize) -> bool {
        self.owners[sample] != OUTSIDE
    }

    /// The number of samples on the shape.
    pub fn covered(&self) -> usize {
        self.owners.par_iter().filter(|&&part| part != OUTSIDE).count()
    }

    /// A volume that is 1 on the shape and 0 outside.
    ///
    /// # Errors
    /// There is not enough memory.
    #[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
    pub fn mask(&self) -> Result<Volume, InterpolateError> {
        let dims = self.volume.dims();
        let mut inside = try_with_capacity(dims.samples(), || format!("a mask of {dims} samples"))?;
        let value = |&part: &u32| f32::from(u8::from(part != OUTSIDE));
        inside.par_extend(self.owners.par_iter().map(value));
        let samples = Array3::from_shape_vec(dims.shape(), inside).expect("one for each sample");
        Ok(Volume::new(samples, *self.volume.frame())?)
    }
}

/// The number of samples summed at a time. It is fixed, so that sums do not depend on the number of threads.
const CHUNK: usize = 1 << 16;

/// The deviation of F from a volume, on the samples that the shape covers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Deviation {
    /// The number of samples of the volume that are not missing.
    pub samples: usize,
    /// The number of samples on the shape.
    pub covered: usize,
    /// The root mean square difference on these samples, in gray levels; `None` if there are none.
    pub rmse: Option<f64>,
    /// The largest difference, in gray levels.
    pub max: Option<f64>,
}

impl Deviation {
    /// The peak that [`Deviation::psnr`] refers to.
    pub const PEAK: f64 = 255.0;

    /// Compares a volume with F on its grid. O(n); sums are doubles, in a fixed order.
    ///
    /// # Panics
    /// The sizes of the two differ.
    pub fn of(original: &Volume, resampled: &Resampled) -> Self {
        assert_eq!(original.dims(), resampled.volume().dims(), "one grid");
        Self::at(original, resampled.volume().as_slice(), |sample| resampled.is_inside(sample))
    }

    /// Compares a volume with numbers at its samples, where `is_inside` holds.
    pub(super) fn at(
        original: &Volume,
        ours: &[f32],
        is_inside: impl Fn(usize) -> bool + Sync,
    ) -> Self {
        let pairs = original.as_slice().par_chunks(CHUNK);
        let pairs = pairs.zip(ours.par_chunks(CHUNK)).enumerate();
        let part = |(chunk, (theirs, ours)): (usize, (&[f32], &[f32]))| {
            let (mut count, mut sum, mut max) = (0, 0.0, 0f64);
            for (i, (f, g)) in theirs.iter().zip(ours).enumerate() {
                let sample = chunk * CHUNK + i;
                if is_inside(sample) && !original.is_missing(sample) {
                    let difference = (f64::from(*f) - f64::from(*g)).abs();
                    count += 1;
                    sum += difference * difference;
                    max = max.max(difference);
                }
            }
            (count, sum, max)
        };
        let parts: Vec<(usize, f64, f64)> = pairs.map(part).collect();
        let covered: usize = parts.iter().map(|part| part.0).sum();
        let sum: f64 = parts.iter().map(|part| part.1).sum();
        let max = parts.iter().map(|part| part.2).fold(0.0, f64::max);
        Self {
            samples: original.samples_there(),
            covered,
            rmse: (covered > 0).then(|| (sum / covered as f64).sqrt()),
            max: (covered > 0).then_some(max),
        }
    }

    /// Converts the deviation to another unit, with `step` units to a gray level.
    #[must_use]
    pub fn scaled(&self, step: f64) -> Self {
        let scaled = |error: Option<f64>| error.map(|error| error * step);
        Self { rmse: scaled(self.rmse), max: scaled(self.max), ..*self }
    }

    /// The share of samples on the shape. In a ladder, coverage is a share of volume instead.
    pub fn covered_share(&self) -> f64 {
        self.covered as f64 / self.samples as f64
    }

    /// The peak signal-to-noise ratio in decibels, 20·log₁₀(255/RMSE); ∞ if nothing differs.
    pub fn psnr(&self) -> Option<f64> {
        self.rmse.map(|rmse| 20.0 * (Self::PEAK / rmse).log10())
    }
}

impl Interpolant<'_> {
    /// The deviation of F from a volume around each point: the root mean square difference at the samples of the point's
    /// simplices, each weighted by the point's barycentric coordinate there. It is in the units of the values, and 0 for a point
    /// that no sample contributes to. `grid` is that of the volume, in the units of the points, and `resampled` is this
    /// interpolant on it. O(samples).
    ///
    /// # Panics
    /// The sizes of grid, volume and samples differ.
    pub fn local_deviations(
        &self,
        original: &Volume,
        grid: &Grid,
        resampled: &Resampled,
    ) -> Vec<f64> {
        let dims = [original.dims(), resampled.volume().dims()];
        assert_eq!(dims, [grid.dims(); 2], "one grid");
        let (there, grid) = self.by_index(grid);
        let [nx, ny, _] = grid.dims().xyz();
        let mut sums = vec![[0.0; 2]; self.values().len()];
        for (sample, &part) in resampled.owners.iter().enumerate() {
            if part == OUTSIDE || original.is_missing(sample) {
                continue;
            }
            let place = grid.position([sample % nx, sample / nx % ny, sample / (nx * ny)]);
            let Some(shares) = there.coordinates(part, place) else { continue };
            let difference = there.value(part, &shares) - f64::from(original.as_slice()[sample]);
            let (vertices, count) = there.vertices(part);
            for (vertex, share) in vertices[..count].iter().zip(shares) {
                let [squares, weights] = &mut sums[*vertex as usize];
                *squares += share * difference * difference;
                *weights += share;
            }
        }
        let root = |[squares, weights]: [f64; 2]| {
            if weights > 0.0 { (squares / weights).sqrt() } else { 0.0 }
        };
        sums.into_iter().map(root).collect()
    }
}
