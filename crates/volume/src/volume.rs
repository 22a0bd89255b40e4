use ndarray::{Array3, ArrayView3};
use serde::{Deserialize, Serialize};
use walpha_base::memory;
use walpha_base::parallel::prelude::*;

use super::rounding::ROUNDED;
use super::{Dims, Dtype, Frame, Gray, GrayRange, Sample, VolumeError};

/// A grid of finite samples, stored `[z, y, x]` (x fastest) in standard layout.
///
/// # Example
/// ```
/// use ndarray::Array3;
/// use walpha_volume::{Frame, Volume};
///
/// // Two slices of 3 rows of 4 samples: 4 along x, 3 along y, 2 along z.
/// let volume = Volume::new(Array3::zeros((2, 3, 4)), Frame::VOXEL)?;
/// assert_eq!(volume.dims().xyz(), [4, 3, 2]);
/// # Ok::<(), walpha_volume::VolumeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    samples: Array3<f32>,
    dims: Dims,
    frame: Frame,
    /// Whether the values are gray levels already, as those of unsigned 8-bit files are.
    gray_levels: bool,
    /// Whether the file states that the values are labels.
    labels: bool,
    /// The type of samples in the file; `f32` if there is no file.
    dtype: Dtype,
    /// The samples without a number in the file, if there are any.
    missing: Option<Vec<bool>>,
}

/// How to treat samples that are NaN or infinite, or that a file states to be padding (DICOM).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Nan {
    /// This value replaces them, and padding as well.
    Value(f32),
    /// They are masked: the least of the other values replaces them, and they are ignored in the selection of points and the
    /// measurement of errors.
    Mask,
}

impl Volume {
    /// Creates a volume from samples of any meaning, which are checked. See [`Volume::with_gray_levels`] for 8-bit data.
    ///
    /// # Errors
    /// An axis has length zero, there are more than [`Dims::MAX_SAMPLES`] samples, or one is NaN or infinite
    /// ([`VolumeError::NotFinite`] names the first).
    pub fn new(samples: Array3<f32>, frame: Frame) -> Result<Self, VolumeError> {
        Self::of_file(samples, frame)?.resolve_nan(None)
    }

    /// Creates a volume from samples of any type of numbers, `[z, y, x]`, in any layout. They are copied and become `f32` as
    /// [`Dtype`] says; unsigned bytes are gray levels.
    ///
    /// ```
    /// use ndarray::Array3;
    /// use walpha_volume::{Dtype, Frame, Volume};
    ///
    /// let scan = Array3::from_elem((2, 3, 4), -1000_i16);
    /// let volume = Volume::of_samples(scan.view(), Frame::VOXEL)?;
    /// assert_eq!((volume.dtype(), volume.value_range()), (Dtype::I16, (-1000.0, -1000.0)));
    /// # Ok::<(), walpha_volume::VolumeError>(())
    /// ```
    ///
    /// # Errors
    /// See [`new`](Self::new); or there is not enough memory.
    pub fn of_samples<T: Sample>(
        samples: ArrayView3<'_, T>,
        frame: Frame,
    ) -> Result<Self, VolumeError> {
        memory::afford(samples.len().saturating_mul(size_of::<f32>()), || "a volume".into())?;
        if samples.iter().any(|sample| sample.is_rounded()) {
            tracing::warn!("{ROUNDED}");
        }
        let samples = samples.as_standard_layout();
        Ok(Self::new(samples.map(|&sample| sample.to_f32()), frame)?.with_dtype(T::DTYPE))
    }

    /// Like [`new`](Self::new), for readers: samples may be NaN or infinite until [`Volume::resolve_nan`].
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn of_file(samples: Array3<f32>, frame: Frame) -> Result<Self, VolumeError> {
        let (z, y, x) = samples.dim();
        let dims = Dims::new(x as u64, y as u64, z as u64)?;
        let samples = if samples.is_standard_layout() {
            samples
        } else {
            samples.as_standard_layout().into_owned()
        };
        let (gray_levels, labels, dtype, missing) = (false, false, Dtype::F32, None);
        Ok(Self { samples, dims, frame, gray_levels, labels, dtype, missing })
    }

    /// Applies the rule for samples that are not finite, and refuses any that remain.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn resolve_nan(mut self, nan: Option<Nan>) -> Result<Self, VolumeError> {
        let value = match nan {
            Some(Nan::Value(value)) => {
                if let Some(missing) = self.missing.take() {
                    let samples = self.samples.iter_mut().zip(missing);
                    samples.filter(|(_, missing)| *missing).for_each(|(sample, _)| *sample = value);
                }
                value
            }
            Some(Nan::Mask) if self.as_slice().par_iter().any(|v| !v.is_finite()) => {
                let padded = self.missing.take();
                let is_padded = |i: usize| padded.as_ref().is_some_and(|padded| padded[i]);
                let samples = self.as_slice().par_iter().enumerate();
                let missing: Vec<bool> =
                    samples.map(|(i, v)| !v.is_finite() || is_padded(i)).collect();
                if missing.iter().all(|&missing| missing) {
                    return Err(VolumeError::NoFinite);
                }
                self.missing = Some(missing);
                self.value_range().0
            }
            _ => f32::NAN,
        };
        if nan.is_some() {
            self.samples.par_mapv_inplace(|v| if v.is_finite() { v } else { value });
        }
        self.refuse(|v| !v.is_finite())?;
        Ok(self)
    }

    /// Refuses samples for which `wrong` holds, with the place of the first.
    fn refuse(&self, wrong: impl Fn(f32) -> bool + Sync) -> Result<(), VolumeError> {
        let Some(index) = first(self.as_slice(), wrong) else { return Ok(()) };
        let [x, y, _] = self.dims.xyz();
        let at = [index % x, index / x % y, index / (x * y)];
        Err(VolumeError::NotFinite { value: self.as_slice()[index], at })
    }

    /// Sets the type of samples in the file. Unsigned 8-bit samples are gray levels.
    #[must_use]
    pub fn with_dtype(self, dtype: Dtype) -> Self {
        Self { dtype, gray_levels: dtype == Dtype::U8, ..self }
    }

    /// The type of samples in the file; `f32` if there is no file.
    pub fn dtype(&self) -> Dtype {
        self.dtype
    }

    /// Whether a sample is missing, by its index in memory order. Missing samples are NaN, infinite or padding in the file, and
    /// are replaced by the least value here.
    pub fn is_missing(&self, sample: usize) -> bool {
        self.missing.as_ref().is_some_and(|missing| missing[sample])
    }

    /// The number of samples that are not missing.
    pub fn samples_there(&self) -> usize {
        let missing =
            self.missing.as_deref().map_or(0, |missing| missing.par_iter().filter(|&&m| m).count());
        self.dims.samples() - missing
    }

    /// Whether samples are missing.
    pub fn has_missing(&self) -> bool {
        self.missing.is_some()
    }

    /// A mask of the missing samples, if there are any.
    #[expect(
        clippy::missing_panics_doc,
        reason = "a mask has as many entries as there are samples"
    )]
    pub fn missing(&self) -> Option<ArrayView3<'_, bool>> {
        let view = |missing| ArrayView3::from_shape(self.dims.shape(), missing);
        self.missing.as_deref().map(|missing| view(missing).expect("one for each sample"))
    }

    /// Marks these samples as missing; the least of the others replaces them. `None` if all are missing.
    pub(crate) fn with_padding(mut self, padded: Vec<bool>) -> Option<Self> {
        if padded.par_iter().all(|&padded| padded) {
            return None;
        }
        let samples = self.samples.as_slice_mut().expect("standard layout");
        let there = samples
            .par_iter()
            .zip(&padded)
            .filter(|(value, padded)| !**padded && value.is_finite());
        let least = there.map(|(&value, _)| value).reduce(|| f32::INFINITY, f32::min);
        let all = samples.par_iter_mut().zip(&padded).filter(|(_, padded)| **padded);
        all.for_each(|(value, _)| *value = least);
        Some(self.with_missing(Some(padded)))
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

    /// Creates a volume of other samples of the same kind.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn like(&self, samples: Array3<f32>, frame: Frame) -> Result<Self, VolumeError> {
        let Self { gray_levels, labels, dtype, .. } = *self;
        Ok(Self { gray_levels, labels, dtype, ..Self::new(samples, frame)? })
    }

    /// A part of this volume: its samples, which need not be finite before [`Volume::resolve_nan`], and which of them are missing.
    pub(crate) fn cropped(
        &self,
        samples: Array3<f32>,
        frame: Frame,
        missing: Option<Vec<bool>>,
    ) -> Result<Self, VolumeError> {
        let Self { gray_levels, labels, dtype, .. } = *self;
        let part = Self { gray_levels, labels, dtype, ..Self::of_file(samples, frame)? };
        match missing.filter(|missing| missing.contains(&true)) {
            Some(missing) => part.with_padding(missing).ok_or(VolumeError::NoFinite),
            None => Ok(part),
        }
    }

    /// Sets which samples are missing.
    #[must_use]
    pub fn with_missing(self, missing: Option<Vec<bool>>) -> Self {
        Self { missing, ..self }
    }

    /// Marks the samples as gray levels 0..255, as those of unsigned 8-bit files are.
    #[must_use]
    pub fn with_gray_levels(mut self) -> Self {
        self.gray_levels = true;
        self
    }

    /// Whether the samples are gray levels 0..255 already, so that [`Gray::Automatic`] keeps them.
    pub fn has_gray_levels(&self) -> bool {
        self.gray_levels
    }

    /// The number of samples along each axis.
    pub fn dims(&self) -> Dims {
        self.dims
    }

    /// The place of the grid in the world.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Moves the samples to another grid, or to other coordinates.
    #[must_use]
    pub fn with_frame(self, frame: Frame) -> Self {
        Self { frame, ..self }
    }

    /// The samples as an array `[z, y, x]`.
    pub fn samples(&self) -> ArrayView3<'_, f32> {
        self.samples.view()
    }

    /// The samples in memory order: voxel (x, y, z) at `x + X·(y + Y·z)`.
    #[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
    pub fn as_slice(&self) -> &[f32] {
        self.samples.as_slice().expect("standard layout is an invariant of Volume")
    }

    /// Turns the volume into its samples, `[z, y, x]`.
    pub fn into_samples(self) -> Array3<f32> {
        self.samples
    }

    /// The smallest and the largest sample. One pass.
    pub fn value_range(&self) -> (f32, f32) {
        let ends = |a: (f32, f32), b: (f32, f32)| (a.0.min(b.0), a.1.max(b.1));
        self.as_slice()
            .par_iter()
            // Other values exist until `resolve_nan`.
            .filter(|v| v.is_finite())
            .map(|&v| (v, v))
            .reduce(|| (f32::INFINITY, f32::NEG_INFINITY), ends)
    }

    /// Converts the samples to gray levels 0..255, in place, and returns the range that they came from.
    ///
    /// # Errors
    /// [`VolumeError::GrayRange`] if the given range is empty, reversed or not finite, or so narrow that the gray level of a
    /// sample exceeds the range of `f32`.
    pub fn into_gray(mut self, gray: Gray) -> Result<(Self, GrayRange), VolumeError> {
        let range = match gray {
            Gray::Automatic if self.gray_levels => GrayRange::IDENTITY,
            Gray::Automatic => {
                let (low, high) = self.value_range();
                GrayRange { low: low.into(), high: high.into() }
            }
            Gray::Range(range) => {
                let (low, high) = self.value_range();
                let fits = |sample: f32| (range.gray(sample.into()) as f32).is_finite();
                let finite = range.low.is_finite() && range.high.is_finite();
                if !(range.low < range.high && finite && fits(low) && fits(high)) {
                    return Err(VolumeError::GrayRange { low: range.low, high: range.high });
                }
                range
            }
        };
        if !range.is_identity() {
            self.samples.par_mapv_inplace(|v| range.gray(v.into()) as f32);
        }
        Ok((self.with_gray_levels(), range))
    }
}

impl Volume {
    /// Converts gray levels to the values that they represent, in place: the inverse of [`Volume::into_gray`].
    #[must_use]
    pub fn into_values(mut self, range: &GrayRange) -> Self {
        if !range.is_identity() {
            self.samples.par_mapv_inplace(|gray| range.value(gray.into()) as f32);
            self.gray_levels = false;
        }
        self
    }
}

/// The first index of a wrong value. Whole chunks are tested at once, and only the first chunk with such a value is searched.
fn first(values: &[f32], wrong: impl Fn(f32) -> bool + Sync) -> Option<usize> {
    const CHUNK: usize = 1 << 14;
    let has_one = |chunk: &[f32]| chunk.iter().fold(false, |found, &v| found | wrong(v));
    let chunk = values.par_chunks(CHUNK).position_first(has_one)?;
    let inside = values[chunk * CHUNK..].iter().position(|&v| wrong(v))?;
    Some(chunk * CHUNK + inside)
}
