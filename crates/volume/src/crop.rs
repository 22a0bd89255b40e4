//! Cropping and downsampling.

use std::num::NonZeroUsize;
use std::ops::Range;

use ndarray::{Array3, s};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{Volume, VolumeError};

/// Samples from one index up to, and without, another along each axis (x, y, z); a missing
/// end is that of the volume.
#[expect(
    clippy::unsafe_derive_deserialize,
    reason = "the unsafe code is that of a macro of ndarray"
)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Region {
    /// The first of each axis.
    pub first: [usize; 3],
    /// One past the last along each axis.
    pub end: [Option<usize>; 3],
}

impl Region {
    /// The part of a volume, in its place.
    ///
    /// # Errors
    /// [`VolumeError::Region`] where it holds no sample or reaches beyond the volume.
    pub fn of(&self, volume: &Volume) -> Result<Volume, VolumeError> {
        let sizes = volume.dims().xyz();
        let end = [0, 1, 2].map(|k| self.end[k].unwrap_or(sizes[k]));
        if (0..3).any(|k| self.first[k] >= end[k] || end[k] > sizes[k]) {
            return Err(VolumeError::Region { first: self.first, end, dims: volume.dims().xyz() });
        }
        let [x, y, z]: [Range<usize>; 3] = [0, 1, 2].map(|k| self.first[k]..end[k]);
        let part = s![z, y, x];
        let frame = volume.frame().part(self.first.map(|i| i as f64), [1.0; 3]);
        let samples = volume.samples().slice(part).to_owned();
        let missing = volume.missing().map(|missing| missing.slice(part).iter().copied().collect());
        Ok(volume.like(samples, frame)?.with_missing(missing))
    }
}

/// A coarser volume: the mean of each `n`×`n`×`n` samples is placed at their centre. What is left at the
/// end of an axis is dropped; an axis of fewer samples becomes one. Missing samples are left out of the
/// mean.
#[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
pub fn downsample(volume: Volume, n: NonZeroUsize) -> Volume {
    let step = volume.dims().xyz().map(|size| n.get().min(size));
    let [nx, ny, nz] = [0, 1, 2].map(|k| volume.dims().xyz()[k] / step[k]);
    let [sx, sy, _] = volume.dims().xyz();
    let samples = volume.as_slice();
    let mean = |voxel: usize| {
        let block = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)];
        let [x, y, z] = [0, 1, 2].map(|k| block[k] * step[k]..(block[k] + 1) * step[k]);
        let rows = z.flat_map(|z| y.clone().map(move |y| (z * sy + y) * sx));
        let all = rows.flat_map(|row| x.clone().map(move |x| row + x));
        let there = all.filter(|&i| !volume.is_missing(i));
        let (count, sum) =
            there.fold((0u32, 0.0), |(n, sum), i| (n + 1, sum + f64::from(samples[i])));
        if count == 0 { None } else { Some((sum / f64::from(count)) as f32) }
    };
    let means: Vec<Option<f32>> = (0..nx * ny * nz).into_par_iter().map(mean).collect();
    let least = samples.iter().copied().fold(f32::INFINITY, f32::min);
    let middle = step.map(|n| (n - 1) as f64 / 2.0);
    let frame = volume.frame().part(middle, step.map(|n| n as f64));
    let missing = volume.has_missing().then(|| means.iter().map(Option::is_none).collect());
    let values = means.into_iter().map(|mean| mean.unwrap_or(least)).collect();
    let coarse = Array3::from_shape_vec((nz, ny, nx), values).expect("one for each block");
    volume.like(coarse, frame).expect("no axis is longer").with_missing(missing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Frame, Nan};

    fn numbered() -> Volume {
        let samples = Array3::from_shape_fn((3, 4, 5), |(z, y, x)| (100 * z + 10 * y + x) as f32);
        let frame = Frame { origin: [7.0, 8.0, 9.0], spacing: [0.5, 2.0, 3.0], ..Frame::VOXEL };
        Volume::new(samples, frame).unwrap()
    }

    #[test]
    fn a_part_stays_in_its_place() {
        let region = Region { first: [1, 2, 0], end: [Some(4), None, Some(2)] };
        let part = region.of(&numbered()).unwrap();
        assert_eq!(part.dims().xyz(), [3, 2, 2]);
        assert_eq!(part.as_slice()[..4], [21.0, 22.0, 23.0, 31.0]);
        assert_eq!(
            (part.frame().origin, part.frame().spacing),
            ([7.5, 12.0, 9.0], [0.5, 2.0, 3.0])
        );
        for (first, end) in [([5, 0, 0], [None; 3]), ([0; 3], [Some(6), None, None])] {
            let error = Region { first, end }.of(&numbered()).unwrap_err().to_string();
            assert!(error.contains("5×4×3"), "{error}");
        }
    }

    #[test]
    fn means_stand_in_the_middle() {
        let coarse = downsample(numbered(), NonZeroUsize::new(2).unwrap());
        assert_eq!(coarse.dims().xyz(), [2, 2, 1]);
        assert_eq!(coarse.as_slice(), [55.5, 57.5, 75.5, 77.5]);
        assert_eq!(coarse.frame().origin, [7.25, 9.0, 10.5]);
        assert_eq!(coarse.frame().spacing, [1.0, 4.0, 6.0]);
        let all = downsample(numbered(), NonZeroUsize::new(9).unwrap());
        assert_eq!((all.as_slice(), all.frame().origin), (&[117.0][..], [8.0, 11.0, 12.0]));
    }

    #[test]
    fn missing_samples_have_no_part() {
        let mut samples = numbered().into_samples();
        samples[[0, 0, 0]] = f32::NAN;
        samples.slice_mut(s![0..2, 0..2, 2..4]).fill(f32::NAN);
        let volume = Volume::of_file(samples, Frame::VOXEL).unwrap();
        let volume = volume.resolve_nan(Some(Nan::Mask)).unwrap();
        assert!(volume.is_missing(0) && !volume.is_missing(1) && volume.as_slice()[0] == 1.0);
        let coarse = downsample(volume.clone(), NonZeroUsize::new(2).unwrap());
        assert_eq!(coarse.as_slice()[0], (8.0 * 55.5 - 0.0) / 7.0);
        assert!(coarse.is_missing(1) && !coarse.is_missing(0));
        let part = Region { first: [2, 0, 0], end: [None; 3] }.of(&volume).unwrap();
        assert!(part.is_missing(0) && !part.is_missing(2));
    }
}
