//! Volumes that are read part by part, and the range of their samples.

use std::path::Path;

use crate::hounsfield::{Counts, Hounsfield};
use crate::labels::{Labels, Tally};
use crate::{Dims, Dtype, Frame, Nan, Reason, Region, Volume, VolumeError};

/// The advice for volumes that cannot be read in parts.
pub(crate) const CONVERT: &str =
    "convert it to uncompressed NRRD, MetaImage, NIfTI or NPY, or to Zarr";

/// A volume of which any box can be read without the rest.
///
/// ```
/// use walpha_volume::{ReadOptions, Source};
///
/// let source = Source::open("sample:phantom@100", &ReadOptions::default())?;
/// let part = source.read([40, 40, 40], [20, 10, 5])?;
/// assert_eq!(part.len(), 20 * 10 * 5);
/// # Ok::<(), walpha_volume::VolumeError>(())
/// ```
pub struct Source {
    dims: Dims,
    frame: Frame,
    dtype: Dtype,
    grain: [usize; 3],
    parts: Box<dyn BoxReader>,
    /// Whether the samples are gray levels already.
    gray_levels: bool,
    /// Whether the file states that its values are labels.
    labels: bool,
    /// The position of the volume's first sample in the underlying source.
    first: [usize; 3],
}

/// Reads samples, box by box.
pub(crate) trait BoxReader: Send + Sync {
    /// Reads the samples from `first` on, `size` along x, y and z, x fastest. They may include NaN.
    fn read(&self, first: [usize; 3], size: [usize; 3]) -> Result<Vec<f32>, VolumeError>;
}

impl std::fmt::Debug for Source {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { dims, frame, dtype, .. } = self;
        f.debug_struct("Source")
            .field("dims", dims)
            .field("frame", frame)
            .field("dtype", dtype)
            .finish_non_exhaustive()
    }
}

impl Source {
    pub(crate) fn new(
        dims: Dims,
        frame: Frame,
        dtype: Dtype,
        grain: [usize; 3],
        parts: Box<dyn BoxReader>,
    ) -> Self {
        let gray_levels = dtype == Dtype::U8;
        Self { dims, frame, dtype, grain, parts, gray_levels, labels: false, first: [0; 3] }
    }

    /// Sets whether the samples are gray levels, whatever their type.
    #[must_use]
    pub fn with_gray_levels(self, gray_levels: bool) -> Self {
        Self { gray_levels, ..self }
    }

    /// Marks the values as [labels](crate::Labels), as a file may state.
    #[must_use]
    pub fn with_labels(self) -> Self {
        Self { labels: true, ..self }
    }

    /// Whether the file states that its values are labels.
    pub fn states_labels(&self) -> bool {
        self.labels
    }

    /// A part of the volume. Its samples stay where they are in the world.
    pub(crate) fn part(self, region: &Region) -> Result<Self, VolumeError> {
        let sizes = self.dims.xyz();
        let end = [0, 1, 2].map(|k| region.end[k].unwrap_or(sizes[k]));
        if (0..3).any(|k| region.first[k] >= end[k] || end[k] > sizes[k]) {
            return Err(VolumeError::Region { first: region.first, end, dims: sizes });
        }
        let [x, y, z] = [0, 1, 2].map(|k| (end[k] - region.first[k]) as u64);
        let frame = self.frame.part(region.first.map(|i| i as f64), [1.0; 3]);
        Ok(Self { dims: Dims::unbounded(x, y, z)?, frame, first: region.first, ..self })
    }

    /// Creates a source from a volume in memory. Missing samples are read as NaN; the type is then `f32`.
    pub fn of_volume(volume: Volume) -> Self {
        let (dims, frame) = (volume.dims(), *volume.frame());
        let dtype = if volume.has_missing() { Dtype::F32 } else { volume.dtype() };
        let (gray_levels, labels) = (volume.has_gray_levels(), volume.states_labels());
        let source = Self::new(dims, frame, dtype, [1; 3], Box::new(volume));
        Self { labels, ..source }.with_gray_levels(gray_levels)
    }

    /// The number of samples along x, y and z.
    pub fn dims(&self) -> Dims {
        self.dims
    }

    /// The first sample (x, y, z) in the file, of which this may be a part.
    pub fn first(&self) -> [usize; 3] {
        self.first
    }

    /// The place of the grid in the world.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The type of samples in the file.
    pub fn dtype(&self) -> Dtype {
        self.dtype
    }

    /// Whether the samples are gray levels 0..255 already, as unsigned bytes are.
    pub fn has_gray_levels(&self) -> bool {
        self.gray_levels
    }

    /// The size along x, y and z of a box that is read as quickly as a single sample. Boxes composed of such boxes are read most
    /// efficiently.
    pub fn grain(&self) -> [usize; 3] {
        self.grain
    }

    /// Reads the samples of the box from `first` on, `size` along x, y and z, x fastest. NaN are returned unchanged.
    ///
    /// # Errors
    /// The file cannot be read or is damaged.
    ///
    /// # Panics
    /// The box reaches beyond the volume.
    pub fn read(&self, first: [usize; 3], size: [usize; 3]) -> Result<Vec<f32>, VolumeError> {
        let sizes = self.dims.xyz();
        assert!((0..3).all(|k| first[k] + size[k] <= sizes[k]), "a box of the volume");
        self.parts.read([0, 1, 2].map(|k| self.first[k] + first[k]), size)
    }

    /// Reads all samples, one part at a time, and passes each part and its size along x, y and z to `look` as long as that
    /// returns `true`.
    pub(crate) fn for_each_part(
        &self,
        mut look: impl FnMut(&[f32], [usize; 3]) -> bool,
    ) -> Result<(), VolumeError> {
        let (dims, step) = (self.dims().xyz(), step(self));
        for z in (0..dims[2]).step_by(step[2]) {
            for y in (0..dims[1]).step_by(step[1]) {
                for x in (0..dims[0]).step_by(step[0]) {
                    let first = [x, y, z];
                    let size = [0, 1, 2].map(|k| step[k].min(dims[k] - first[k]));
                    if !look(&self.read(first, size)?, size) {
                        return Ok(());
                    }
                }
            }
        }
        Ok(())
    }
}

impl BoxReader for Volume {
    fn read(&self, first: [usize; 3], size: [usize; 3]) -> Result<Vec<f32>, VolumeError> {
        let [x, y, z] = [0, 1, 2].map(|k| first[k]..first[k] + size[k]);
        let part = ndarray::s![z, y, x];
        let mut samples: Vec<f32> = self.samples().slice(part).iter().copied().collect();
        if let Some(missing) = self.missing() {
            let missing = missing.slice_move(part);
            let all = samples.iter_mut().zip(missing).filter(|(_, missing)| **missing);
            all.for_each(|(sample, _)| *sample = f32::NAN);
        }
        Ok(samples)
    }
}

/// The error for a format that is not read in parts.
pub(super) fn whole_only(path: &Path, name: &str) -> VolumeError {
    let what = format!("is {name}, which is not read in parts");
    VolumeError::Format { path: path.into(), reason: Reason::unsupported(what, CONVERT) }
}

/// The largest number of samples read at a time, where the format allows it: 64 MiB.
pub(crate) const AT_ONCE: usize = 1 << 24;

/// The range of a volume's samples, the number of missing ones, and what they look like.
#[derive(Clone, Debug, PartialEq)]
pub struct SampleStats {
    /// The smallest and the largest finite value; `None` if no value is finite.
    pub range: Option<(f32, f32)>,
    /// The number of samples that are NaN, infinite or padding.
    pub missing: u64,
    /// Whether the values look like Hounsfield units.
    pub hounsfield: Option<Hounsfield>,
    /// The labels, if the values are labels.
    pub labels: Option<Labels>,
}

impl SampleStats {
    /// Examines a volume that is read for this purpose, one part at a time, so that memory does not grow with the volume. `nan`
    /// may replace samples that are not finite. One pass.
    ///
    /// # Errors
    /// The file cannot be read or is damaged.
    pub fn of(source: &Source, nan: Option<Nan>) -> Result<Self, VolumeError> {
        let (mut low, mut high, mut missing) = (f32::INFINITY, f32::NEG_INFINITY, 0);
        let (mut counts, mut tally) = (Counts::default(), Tally::of_source(source));
        source.for_each_part(|values, size| {
            counts.add(values);
            tally.add(values, size, |_| false);
            for &value in values {
                let value = match nan {
                    Some(Nan::Value(instead)) if !value.is_finite() => instead,
                    _ => value,
                };
                if value.is_finite() {
                    (low, high) = (low.min(value), high.max(value));
                } else {
                    missing += 1;
                }
            }
            true
        })?;
        let hounsfield = counts.judge().filter(|_| !source.has_gray_levels());
        let labels = tally.of_source_judged(source);
        Ok(Self { range: (low <= high).then_some((low, high)), missing, hounsfield, labels })
    }

    /// Examines a volume in memory. Its [missing](Volume::is_missing) samples are padding, or not finite in its file.
    pub fn of_volume(volume: &Volume) -> Self {
        let missing = volume.dims().samples() - volume.samples_there();
        Self {
            range: Some(volume.value_range()),
            missing: missing as u64,
            hounsfield: Hounsfield::of_volume(volume),
            labels: Labels::of_volume(volume),
        }
    }
}

/// The numbers of samples along each axis that are read at once: whole grains, as many as the limit allows.
fn step(source: &Source) -> [usize; 3] {
    let dims = source.dims().xyz();
    let mut step = [0, 1, 2].map(|k| source.grain()[k].clamp(1, dims[k]));
    for k in 0..3 {
        let grain = step[k];
        let others: usize = step.iter().product::<usize>() / grain;
        let most = AT_ONCE / others.max(1) / grain * grain;
        step[k] = most.clamp(grain, dims[k]);
    }
    step
}
