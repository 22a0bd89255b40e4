use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::Resampled;
use crate::volume::Volume;

/// Samples summed at a time. Fixed, so that sums are the same on any number of threads.
const CHUNK: usize = 1 << 16;

/// How far F is from a volume, on the samples that the shape covers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Deviation {
    /// Samples of the volume that are not missing.
    pub samples: usize,
    /// Samples on the shape.
    pub covered: usize,
    /// Root mean square difference over these, in gray levels; `None` where there are none.
    pub rmse: Option<f64>,
    /// The largest difference, in gray levels.
    pub max: Option<f64>,
}

impl Deviation {
    /// The peak that [`Deviation::psnr`] refers to.
    pub const PEAK: f64 = 255.0;

    /// Compares a volume with F on its grid. O(n), sums in f64 in a fixed order.
    ///
    /// # Panics
    /// When the two are not of one shape.
    pub fn of(original: &Volume, resampled: &Resampled) -> Self {
        assert_eq!(original.dims(), resampled.volume().dims(), "one grid");
        Self::at(original, resampled.volume().as_slice(), |sample| resampled.is_inside(sample))
    }

    /// Compares a volume with numbers at its samples, where there are some.
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

    /// The same where a gray level is `step` of another unit.
    #[must_use]
    pub fn scaled(&self, step: f64) -> Self {
        let scaled = |error: Option<f64>| error.map(|error| error * step);
        Self { rmse: scaled(self.rmse), max: scaled(self.max), ..*self }
    }

    /// The share of samples on the shape; coverage, of a ladder, is one of volume.
    pub fn covered_share(&self) -> f64 {
        self.covered as f64 / self.samples as f64
    }

    /// The peak signal-to-noise ratio in decibels, 20·log₁₀(255/RMSE); ∞ where nothing differs.
    pub fn psnr(&self) -> Option<f64> {
        self.rmse.map(|rmse| 20.0 * (Self::PEAK / rmse).log10())
    }
}
