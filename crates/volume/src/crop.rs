//! Cropping and downsampling.

use std::num::NonZeroUsize;
use std::ops::Range;

use ndarray::{Array3, s};
use serde::{Deserialize, Serialize};
use walpha_base::parallel::prelude::*;

use walpha_base::Monitor;

use super::source::AT_ONCE;
use super::{Dims, Dtype, Frame, Labels, Nan, Source, Volume, VolumeError};

/// A range of samples along each axis (x, y, z), from a first index to an exclusive end. A missing end is that of the volume.
#[expect(
    clippy::unsafe_derive_deserialize,
    reason = "the unsafe code is that of a macro of ndarray"
)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Region {
    /// The first index along each axis.
    pub first: [usize; 3],
    /// One past the last along each axis.
    pub end: [Option<usize>; 3],
}

impl Region {
    /// A part of no volume: what stands for a region that has no whole indices.
    pub const NOWHERE: Self = Self { first: [usize::MAX; 3], end: [None; 3] };

    /// Cuts this part out of a volume. Its samples stay where they are in the world, and missing ones get the least of its values.
    ///
    /// # Errors
    /// [`VolumeError::Region`] if the part contains no sample or reaches beyond the volume, [`VolumeError::NoFinite`] if all of its samples
    /// are missing.
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
        volume.cropped(samples, frame, missing)
    }
}

/// Makes a volume coarser. The mean of each block of `n`×`n`×`n` samples is placed at their centre; for [labels](Labels) it is
/// the most frequent value, or the least of equally frequent ones. Incomplete blocks at the end of an axis are dropped, with a
/// warning; an axis with fewer than `n` samples becomes one sample. Missing samples do not count. Means are of type `f32`.
#[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
pub fn downsample(volume: Volume, n: NonZeroUsize) -> Volume {
    let blocks = Blocks::of(volume.dims(), n);
    let samples = volume.as_slice();
    let pick = Pick::of(Labels::of_volume(&volume).is_some());
    let means = blocks.picked(samples, pick, |sample| volume.is_missing(sample));
    let least = samples.iter().copied().fold(f32::INFINITY, f32::min);
    let (samples, missing) = blocks.filled(means, least, volume.has_missing());
    let frame = blocks.frame(volume.frame());
    let dtype = blocks.dtype(pick, volume.dtype());
    let coarse = volume.like(samples, frame).expect("no axis is longer").with_missing(missing);
    let coarse = coarse.with_dtype(dtype);
    if volume.has_gray_levels() { coarse.with_gray_levels() } else { coarse }
}

/// Like [`downsample`], for a volume that is read in parts, so that memory does not grow with the size of the source. `nan` is
/// the rule for samples that are not finite.
///
/// # Errors
/// The file cannot be read or is damaged, [`VolumeError::NotFinite`], [`VolumeError::NoFinite`], and [`VolumeError::Cancelled`].
pub(crate) fn downsample_source(
    source: &Source,
    n: NonZeroUsize,
    nan: Option<Nan>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    downsample_slabs(source, n, nan, AT_ONCE, monitor)
}

fn downsample_slabs(
    source: &Source,
    n: NonZeroUsize,
    nan: Option<Nan>,
    at_once: usize,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let blocks = Blocks::of(source.dims(), n);
    let pick = Pick::of(Labels::of(source)?.is_some());
    let [sx, sy, sz] = source.dims().xyz();
    // Whole blocks of planes, as many as fit into one read.
    let step = blocks.step[2];
    let planes = (at_once / (sx * sy) / step * step).max(step);
    let mut means = Vec::with_capacity(blocks.count.iter().product());
    let (mut least, mut is_any_missing) = (f32::INFINITY, false);
    for z in (0..sz).step_by(planes) {
        let mut samples = source.read([0, 0, z], [sx, sy, planes.min(sz - z)])?;
        let missing = samples.par_iter().any(|value| !value.is_finite());
        let mut is_missing = Vec::new();
        match nan {
            Some(Nan::Mask) if missing => {
                is_missing = samples.par_iter().map(|value| !value.is_finite()).collect();
                is_any_missing = true;
            }
            Some(Nan::Value(value)) if missing => {
                samples.par_iter_mut().filter(|v| !v.is_finite()).for_each(|v| *v = value);
            }
            _ => {}
        }
        if is_missing.is_empty()
            && let Some(index) = samples.par_iter().position_first(|value| !value.is_finite())
        {
            let at = [index % sx, index / sx % sy, z + index / (sx * sy)];
            return Err(VolumeError::NotFinite { value: samples[index], at });
        }
        let is_missing = |sample: usize| is_missing.get(sample).is_some_and(|&missing| missing);
        let there = samples.iter().enumerate().filter(|&(sample, _)| !is_missing(sample));
        least = there.fold(least, |least, (_, &value)| least.min(value));
        means.extend(blocks.picked(&samples, pick, is_missing));
        monitor.report((z + planes).min(sz) as u64, sz as u64)?;
    }
    // The least of no samples.
    if least.is_infinite() {
        return Err(VolumeError::NoFinite);
    }
    let (samples, missing) = blocks.filled(means, least, is_any_missing);
    let volume = Volume::new(samples, blocks.frame(source.frame()))?.with_missing(missing);
    let volume = volume.with_dtype(blocks.dtype(pick, source.dtype()));
    let volume = if source.states_labels() { volume.with_labels() } else { volume };
    Ok(if source.has_gray_levels() { volume.with_gray_levels() } else { volume })
}

/// How a block of samples becomes one sample.
#[derive(Clone, Copy, PartialEq)]
enum Pick {
    Mean,
    /// The most frequent value, or the least of equally frequent ones: labels do not mix.
    Most,
}

impl Pick {
    fn of(labels: bool) -> Self {
        if labels { Self::Most } else { Self::Mean }
    }
}

/// The most frequent value, or the least of equally frequent ones.
fn most_frequent(mut values: Vec<f32>) -> Option<f32> {
    values.sort_unstable_by(f32::total_cmp);
    // `max_by_key` takes the last of equal counts, which is the least value as the order is reversed.
    let equal = values.chunk_by(|a, b| a == b).rev().max_by_key(|equal| equal.len());
    equal.map(|equal| equal[0])
}

/// The blocks of samples, each of which becomes one sample.
struct Blocks {
    /// The number of samples of the volume along x and y.
    row: [usize; 2],
    /// The number of samples of a block along x, y and z.
    step: [usize; 3],
    /// The number of blocks along x, y and z.
    count: [usize; 3],
}

impl Blocks {
    fn of(dims: Dims, n: NonZeroUsize) -> Self {
        let sizes = dims.xyz();
        let step = sizes.map(|size| n.get().min(size));
        let left = [0, 1, 2].map(|k| sizes[k] % step[k]);
        if left != [0; 3] {
            let [x, y, z] = left;
            tracing::warn!(
                "of {dims} samples the last {x}, {y} and {z} along x, y and z fill no block of {n}, and are left out"
            );
        }
        Self { row: [sizes[0], sizes[1]], step, count: [0, 1, 2].map(|k| sizes[k] / step[k]) }
    }

    /// The type of the coarse samples: means have fractions.
    fn dtype(&self, pick: Pick, dtype: Dtype) -> Dtype {
        if pick == Pick::Mean && self.step != [1; 3] { Dtype::F32 } else { dtype }
    }

    /// The sample that each block becomes, x fastest, for planes that begin with a block; `None` for a block whose samples are
    /// all missing.
    fn picked(
        &self,
        samples: &[f32],
        pick: Pick,
        is_missing: impl Fn(usize) -> bool + Sync,
    ) -> Vec<Option<f32>> {
        let Self { row: [sx, sy], step, count: [nx, ny, _] } = *self;
        let picked = |voxel: usize| {
            let block = [voxel % nx, voxel / nx % ny, voxel / (nx * ny)];
            let [x, y, z] = [0, 1, 2].map(|k| block[k] * step[k]..(block[k] + 1) * step[k]);
            let rows = z.flat_map(|z| y.clone().map(move |y| (z * sy + y) * sx));
            let all = rows.flat_map(|row| x.clone().map(move |x| row + x));
            let there = all.filter(|&i| !is_missing(i));
            if pick == Pick::Most {
                return most_frequent(there.map(|i| samples[i]).collect());
            }
            let (count, sum) =
                there.fold((0u32, 0.0), |(n, sum), i| (n + 1, sum + f64::from(samples[i])));
            if count == 0 { None } else { Some((sum / f64::from(count)) as f32) }
        };
        let layers = samples.len() / (sx * sy) / step[2];
        (0..nx * ny * layers).into_par_iter().map(picked).collect()
    }

    /// The coarse samples, in which missing ones get the least value of all; and which are missing, if any sample of the volume
    /// is.
    fn filled(
        &self,
        means: Vec<Option<f32>>,
        least: f32,
        is_any_missing: bool,
    ) -> (Array3<f32>, Option<Vec<bool>>) {
        let [nx, ny, nz] = self.count;
        let missing = is_any_missing.then(|| means.iter().map(Option::is_none).collect());
        let values = means.into_iter().map(|mean| mean.unwrap_or(least)).collect();
        (Array3::from_shape_vec((nz, ny, nx), values).expect("one for each block"), missing)
    }

    fn frame(&self, frame: &Frame) -> Frame {
        frame.part(self.step.map(|n| (n - 1) as f64 / 2.0), self.step.map(|n| n as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        // 0 is beyond the part.
        assert_eq!((part.as_slice()[0], part.value_range().0), (4.0, 4.0));
        let hole = Region { first: [2, 0, 0], end: [Some(4), Some(2), Some(2)] };
        assert!(matches!(hole.of(&volume), Err(VolumeError::NoFinite)));
        let whole = Region { first: [0, 2, 0], end: [None; 3] }.of(&volume).unwrap();
        assert!(!whole.has_missing());
    }

    /// Labels do not mix: of 27 samples, the most frequent value is taken, or the least of equally frequent ones.
    #[test]
    fn labels_do_not_mix() {
        let label = |x: usize| [0.0, 0.0, 7.0, 7.0, 7.0, 0.0][x % 6];
        let samples = Array3::from_shape_fn((6, 6, 12), |(_, _, x)| label(x));
        let volume = Volume::new(samples, Frame::VOXEL).unwrap().with_labels();
        let coarse = |n| downsample(volume.clone(), NonZeroUsize::new(n).unwrap());
        assert_eq!(coarse(3).as_slice()[..4], [0.0, 7.0, 0.0, 7.0]);
        assert_eq!(coarse(2).as_slice()[..6], [0.0, 7.0, 0.0, 0.0, 7.0, 0.0]);
        assert!(coarse(2).states_labels());
        let source = Source::of_volume(volume.clone());
        let in_parts =
            downsample_slabs(&source, NonZeroUsize::new(2).unwrap(), None, 1, &Monitor::noop());
        assert_eq!(in_parts.unwrap().as_slice(), coarse(2).as_slice());
    }

    /// The result does not depend on reading in parts, whichever samples are missing and where planes are left over.
    #[test]
    fn read_in_parts_it_is_the_same() {
        let mut samples = Array3::from_shape_fn((7, 5, 4), |(z, y, x)| (z * y * y + x) as f32);
        samples[[6, 1, 1]] = -50.0;
        let whole = Volume::of_file(samples.clone(), Frame::VOXEL).unwrap();
        samples[[6, 0, 3]] = f32::NEG_INFINITY;
        let late = Volume::of_file(samples.clone(), Frame::VOXEL).unwrap();
        samples.slice_mut(s![0..2, .., ..]).fill(f32::NAN);
        let torn = Volume::of_file(samples.clone(), Frame::VOXEL).unwrap();
        let none = Volume::of_file(samples.mapv(|_| f32::NAN), Frame::VOXEL).unwrap();
        for volume in [whole, late, torn, none] {
            for nan in [None, Some(Nan::Mask), Some(Nan::Value(-3.0)), Some(Nan::Value(f32::NAN))] {
                for n in [1, 2, 3, 9].map(|n| NonZeroUsize::new(n).unwrap()) {
                    let at_once =
                        volume.clone().resolve_nan(nan).map(|volume| downsample(volume, n));
                    let source = Source::of_volume(volume.clone());
                    let in_parts = downsample_slabs(&source, n, nan, 1, &Monitor::noop());
                    match (at_once, in_parts) {
                        (Ok(at_once), Ok(in_parts)) => assert_eq!(at_once, in_parts, "{nan:?} {n}"),
                        (Err(one), Err(other)) => assert_eq!(one.to_string(), other.to_string()),
                        (one, other) => panic!("{nan:?} {n}: {one:?}, {other:?}"),
                    }
                }
            }
        }
    }
}
