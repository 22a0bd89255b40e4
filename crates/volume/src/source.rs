//! Volumes that are read part by part.

use std::path::Path;

use walpha_base::advice::Setting;

use super::read::CONVERT;
use super::sample::PhantomBoxes;
use super::{Dims, Dtype, Frame, ReadOptions, Reason, Volume, VolumeError, open};

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
    /// Whether samples are gray levels as they are.
    gray_levels: bool,
    /// Where the volume begins in what is read.
    first: [usize; 3],
}

/// Where samples come from, box by box.
pub(crate) trait BoxReader: Send + Sync {
    /// The samples from `first` on, `size` along x, y and z, x fastest; NaN may be among them.
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
        Self { dims, frame, dtype, grain, parts, gray_levels, first: [0; 3] }
    }

    /// Says whether samples are gray levels, whatever their type.
    #[must_use]
    pub fn with_gray_levels(self, gray_levels: bool) -> Self {
        Self { gray_levels, ..self }
    }

    /// Opens what a user names, a sample or a file: uncompressed NRRD, `MetaImage`, `NIfTI`, NPY and raw samples,
    /// and Zarr (feature `zarr`). Of the options, `nan` is left to whoever reads.
    ///
    /// # Errors
    /// As [`read()`](super::read()), and [`VolumeError::Format`] for what cannot be read in parts.
    pub fn open(input: impl AsRef<Path>, options: &ReadOptions) -> Result<Self, VolumeError> {
        let path = input.as_ref();
        let name = path.to_str().unwrap_or_default();
        if options.downsample.is_some() {
            let what = "cannot be made coarser while it is read in parts";
            let reason = Reason::needless(Setting::Downsample, what);
            return Err(VolumeError::Format { path: path.into(), reason });
        }
        let source = match name.strip_prefix("sample:phantom@").map(str::parse) {
            Some(Ok(size)) => PhantomBoxes::source(size)?,
            _ if name.starts_with("sample:") => {
                Self::of_volume(open(path, &ReadOptions::default())?)
            }
            _ => super::formats::source(path, options)?,
        };
        let Some(region) = options.region else { return Ok(source) };
        let sizes = source.dims.xyz();
        let end = [0, 1, 2].map(|k| region.end[k].unwrap_or(sizes[k]));
        if (0..3).any(|k| region.first[k] >= end[k] || end[k] > sizes[k]) {
            return Err(VolumeError::Region { first: region.first, end, dims: source.dims });
        }
        let [x, y, z] = [0, 1, 2].map(|k| (end[k] - region.first[k]) as u64);
        let frame = source.frame.part(region.first.map(|i| i as f64), [1.0; 3]);
        Ok(Self { dims: Dims::unbounded(x, y, z)?, frame, first: region.first, ..source })
    }

    /// A volume in memory.
    pub fn of_volume(volume: Volume) -> Self {
        let (dims, frame, dtype) = (volume.dims(), *volume.frame(), volume.dtype());
        let gray_levels = volume.has_gray_levels();
        Self::new(dims, frame, dtype, [1; 3], Box::new(volume)).with_gray_levels(gray_levels)
    }

    /// Samples along x, y and z.
    pub fn dims(&self) -> Dims {
        self.dims
    }

    /// Where the grid lies in the world.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// How the file stores a sample.
    pub fn dtype(&self) -> Dtype {
        self.dtype
    }

    /// Whether the samples are gray levels 0..255 as they are, as unsigned bytes are.
    pub fn has_gray_levels(&self) -> bool {
        self.gray_levels
    }

    /// The box of samples, along x, y and z, that is read as quickly as a single one: boxes made of such are
    /// read best.
    pub fn grain(&self) -> [usize; 3] {
        self.grain
    }

    /// The samples of the box from `first` on, `size` along x, y and z, x fastest. NaN are given as they are.
    ///
    /// # Errors
    /// The file cannot be read or is damaged.
    ///
    /// # Panics
    /// When the box reaches beyond the volume.
    pub fn read(&self, first: [usize; 3], size: [usize; 3]) -> Result<Vec<f32>, VolumeError> {
        let sizes = self.dims.xyz();
        assert!((0..3).all(|k| first[k] + size[k] <= sizes[k]), "a box of the volume");
        self.parts.read([0, 1, 2].map(|k| self.first[k] + first[k]), size)
    }
}

impl BoxReader for Volume {
    fn read(&self, first: [usize; 3], size: [usize; 3]) -> Result<Vec<f32>, VolumeError> {
        let [x, y, z] = [0, 1, 2].map(|k| first[k]..first[k] + size[k]);
        Ok(self.samples().slice(ndarray::s![z, y, x]).iter().copied().collect())
    }
}

/// Writes a volume as Zarr (feature `zarr`), part by part: OME-Zarr 0.5 with one level, in chunks of 64³
/// samples, or an array alone where nothing is known of the grid. Bytes and 16-bit integers keep their type,
/// others become `f32`; spacing, origin and unit are kept, directions are not.
///
/// # Errors
/// `folder` is there already or cannot be made; the volume cannot be read. Nothing is left behind then.
#[cfg(feature = "zarr")]
pub fn convert(source: &Source, folder: &Path) -> Result<(), VolumeError> {
    convert_monitored(source, folder, &walpha_base::Monitor::noop())
}

/// The same, which says how far it is and can be cancelled.
///
/// # Errors
/// Those of [`convert`], and [`VolumeError::Cancelled`].
#[cfg(feature = "zarr")]
pub fn convert_monitored(
    source: &Source,
    folder: &Path,
    monitor: &walpha_base::Monitor,
) -> Result<(), VolumeError> {
    super::write::zarr(source, folder, monitor)
}

/// The error for a format that is not read in parts.
pub(super) fn whole_only(path: &Path, name: &str) -> VolumeError {
    let what = format!("is {name}, which is not read in parts");
    VolumeError::Format { path: path.into(), reason: Reason::unsupported(what, CONVERT) }
}
