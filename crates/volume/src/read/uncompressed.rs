use std::fs::File;
use std::io;
use std::path::Path;
use std::path::PathBuf;

use super::OpenFile;
use super::layout::{Encoding, Layout};
use super::payload::Element;
use crate::Reason;
use crate::error::format_error;
use crate::error::io_error;
use crate::rounding::Rounding;
use crate::source::CONVERT;
use crate::source::{BoxReader, Source};
use crate::{Dims, Dtype, Endian, Frame, VolumeError};

/// The uncompressed samples of a volume in a file, x fastest. Any box of them can be read separately.
pub(crate) struct Uncompressed {
    path: PathBuf,
    file: SharedFile,
    dims: Dims,
    frame: Frame,
    dtype: Dtype,
    endian: Endian,
    /// The byte offset of the first sample.
    offset: u64,
    /// The slope and the intercept.
    scaling: Option<(f64, f64)>,
    /// Whether the file states that the values are labels.
    labels: bool,
    rounding: Rounding,
}

impl Uncompressed {
    pub(crate) fn new(
        file: &OpenFile,
        dims: Dims,
        frame: Frame,
        dtype: Dtype,
        endian: Endian,
        offset: u64,
    ) -> Result<Self, VolumeError> {
        let path = file.path().to_owned();
        let file = SharedFile::new(file.handle()?);
        Ok(Self {
            path,
            file,
            dims,
            frame,
            dtype,
            endian,
            offset,
            scaling: None,
            labels: false,
            rounding: Rounding::default(),
        })
    }

    /// Sets the scaling of samples, which is done in doubles. Scaled bytes are not gray levels.
    pub(crate) fn scaled(self, (slope, inter): (f64, f64)) -> Self {
        Self { scaling: ((slope, inter) != (1.0, 0.0)).then_some((slope, inter)), ..self }
    }

    /// Sets whether the file states that the values are labels.
    pub(crate) fn with_labels(self, labels: bool) -> Self {
        Self { labels, ..self }
    }

    /// The samples behind a header of `after` bytes and `skip` further bytes; if `skip` is `None`, the samples are at the end of
    /// the file.
    pub(super) fn after_header(
        file: &OpenFile,
        layout: Layout,
        after: u64,
        skip: Option<u64>,
    ) -> Result<Self, VolumeError> {
        Self::within(file.path(), file, layout, after, skip)
    }

    /// The samples in a file of their own.
    pub(super) fn in_data_file(
        header: &Path,
        layout: Layout,
        files: &[PathBuf],
        skip: Option<u64>,
    ) -> Result<Self, VolumeError> {
        match files {
            [file] => Self::within(header, &OpenFile::open(file)?, layout, 0, skip),
            _ => Err(format_error(
                header,
                Reason::unsupported(
                    format!(
                        "has its samples in {} files, which are not read in parts",
                        files.len()
                    ),
                    CONVERT,
                ),
            )),
        }
    }

    fn within(
        header: &Path,
        file: &OpenFile,
        layout: Layout,
        after: u64,
        skip: Option<u64>,
    ) -> Result<Self, VolumeError> {
        if layout.encoding != Encoding::Raw {
            let what = "is compressed, or text: it cannot be read in parts";
            return Err(format_error(header, Reason::unsupported(what, CONVERT)));
        }
        let (needed, behind) = (layout.bytes(), file.length().saturating_sub(after));
        let skip = skip.unwrap_or(behind.saturating_sub(needed));
        let found = behind.saturating_sub(skip);
        let Layout { dims, dtype, endian, frame, frames, .. } = layout;
        if found != needed {
            let claim = format!("a volume of {dims} samples of type {dtype}");
            let reason = Reason::Length { claim, needed, found, bound: "" };
            return Err(format_error(header, reason));
        }
        let offset = after + skip + frames.index * layout.each();
        Self::new(file, dims, frame, dtype, endian, offset)
    }

    /// The volume that consists of these samples.
    pub(crate) fn source(self) -> Source {
        let dtype = if self.scaling.is_some() { Dtype::F32 } else { self.dtype };
        // Rows are contiguous, so whole rows are read in one piece.
        let grain = [self.dims.x(), 1, 1];
        let labels = self.labels;
        let source = Source::new(self.dims, self.frame, dtype, grain, Box::new(self));
        if labels { source.with_labels() } else { source }
    }
}

impl BoxReader for Uncompressed {
    fn read(&self, first: [usize; 3], size: [usize; 3]) -> Result<Vec<f32>, VolumeError> {
        let Self { path, file, dims, dtype, offset, .. } = self;
        let [nx, ny, _] = dims.xyz();
        // Whole rows are contiguous with the next ones.
        let whole = size[0] == nx;
        let (runs, run) = if whole { (1, size[0] * size[1]) } else { (size[1], size[0]) };
        let mut bytes = vec![0; run * dtype.size()];
        let mut samples = vec![0.0; size.iter().product()];
        let mut to = samples.chunks_mut(run);
        for z in first[2]..first[2] + size[2] {
            for y in first[1]..first[1] + runs {
                let at = ((z * ny + y) * nx + first[0]) as u64 * dtype.size() as u64;
                file.read_at(offset + at, &mut bytes).map_err(io_error(path))?;
                self.decode(&bytes, to.next().expect("as many runs as there are"));
            }
        }
        Ok(samples)
    }
}

impl Uncompressed {
    fn decode(&self, bytes: &[u8], samples: &mut [f32]) {
        let Self { dtype, endian, scaling, .. } = *self;
        let Some((slope, inter)) = scaling else {
            self.rounding.note(f32::decode(bytes, dtype, endian, samples));
            return self.rounding.say(&self.path);
        };
        // Computes in doubles if `f32` does not hold the numbers of the file.
        let mut exact = vec![0.0; samples.len()];
        f64::decode(bytes, dtype, endian, &mut exact);
        for (sample, value) in samples.iter_mut().zip(exact) {
            *sample = (value * slope + inter) as f32;
        }
    }
}

/// An open file that several threads read at different positions.
struct SharedFile {
    #[cfg(unix)]
    file: File,
    /// Only one thread at a time may move the position and read.
    #[cfg(not(unix))]
    file: std::sync::Mutex<File>,
}

impl SharedFile {
    fn new(file: File) -> Self {
        #[cfg(not(unix))]
        let file = file.into();
        Self { file }
    }

    #[cfg(unix)]
    fn read_at(&self, offset: u64, bytes: &mut [u8]) -> io::Result<()> {
        std::os::unix::fs::FileExt::read_exact_at(&self.file, bytes, offset)
    }

    #[cfg(not(unix))]
    fn read_at(&self, offset: u64, bytes: &mut [u8]) -> io::Result<()> {
        use std::io::{Read, Seek, SeekFrom};
        let mut file = self.file.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        file.seek(SeekFrom::Start(offset))?;
        file.read_exact(bytes)
    }
}
