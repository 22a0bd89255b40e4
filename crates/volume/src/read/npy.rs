use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use ndarray::{Array3, ShapeBuilder};
use walpha_base::Monitor;
use walpha_base::npy::{Header, NpyError};
use walpha_base::shown::shown;

use super::OpenFile;
use super::frames::FrameChoice;
use super::payload::payload_error_of;
use super::payload::{Element, Length, Payload};
use super::uncompressed::Uncompressed;
use crate::error::io_error;
use crate::{Dims, Dtype, Endian, Frame, Reason, Volume, VolumeError};

/// An array in an NPY file (format versions 1 to 3, numpy.lib.format).
pub struct NpyFile<R> {
    /// The lengths of the axes.
    pub shape: Vec<u64>,
    /// Whether the first axis is the fastest in the file.
    pub fortran: bool,
    /// The type of the elements.
    pub dtype: Dtype,
    endian: Endian,
    /// Whether the elements are booleans, which are read as 0 and 1 and not as gray levels.
    boolean: bool,
    payload: Payload<R>,
}

/// Reads an array of three axes `[z, y, x]`, in C or Fortran order, or the one numbered `frame` in an array of four, in C order.
/// If the last of four axes has one element, it is a channel and is dropped.
pub(crate) fn read(
    file: &OpenFile,
    frame: Option<u64>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let file = NpyFile::open(file)?.without_channel();
    warn_of_channels(path, &file.shape);
    if let (&[count, z, y, x], false) = (file.shape.as_slice(), file.fortran) {
        let each =
            [z, y, x, file.dtype.size() as u64].iter().fold(1, |n: u64, m| n.saturating_mul(*m));
        let frames = FrameChoice::choose(path, &[count], frame)?;
        let Payload { reader, length } = file.payload;
        let (reader, length) = frames.select(path, reader, length, each)?;
        let payload = Payload { reader, length };
        let NpyFile { fortran, dtype, endian, boolean, .. } = file;
        return volume(
            path,
            NpyFile { shape: vec![z, y, x], fortran, dtype, endian, boolean, payload },
            monitor,
        );
    }
    FrameChoice::choose(path, &[], frame)?;
    volume(path, file, monitor)
}

/// Locates the samples of a volume in C order, to be read part by part.
pub(crate) fn box_reader(file: &OpenFile, frame: Option<u64>) -> Result<Uncompressed, VolumeError> {
    let (path, length) = (file.path(), file.length());
    let fail = |reason: Reason| VolumeError::Format { path: path.into(), reason };
    let array = NpyFile::open(file)?.without_channel();
    warn_of_channels(path, &array.shape);
    let (beyond, axes) = array.shape.split_at(array.shape.len().saturating_sub(3));
    let (&[z, y, x], false) = (axes, array.fortran || beyond.len() > 1) else {
        return Err(fail(Reason::unsupported(
            format!("holds an array of shape {:?} that is not read part by part", array.shape),
            "save numpy.ascontiguousarray(a), of the axes [z, y, x]",
        )));
    };
    let dims = Dims::unbounded(x, y, z)?;
    let frames = FrameChoice::choose(path, beyond, frame)?;
    let each = dims.bytes(array.dtype.size());
    let all = each.saturating_mul(frames.count);
    let Length::Exactly(found) = array.payload.length else { unreachable!("of a file") };
    if found != all {
        let claim = format!("an array of shape {:?} and type {}", array.shape, array.dtype);
        return Err(fail(Reason::Length { claim, needed: all, found, bound: "" }));
    }
    let offset = length - found + frames.index * each;
    // Booleans are bytes, but not gray levels.
    let dtype = if array.boolean { Dtype::I8 } else { array.dtype };
    Uncompressed::new(file, dims, Frame::VOXEL, dtype, array.endian, offset)
}

/// Warns where a last axis that is taken for x may be one of colours.
pub(super) fn warn_of_channels(path: &Path, shape: &[u64]) {
    if let &[.., rows, columns, last @ 2..=4] = shape
        && rows.min(columns) > 4
    {
        tracing::warn!(
            "{}: its last axis, of {last}, is taken for x; if these are channels, save one of them, as in a[..., 0]",
            shown(path)
        );
    }
}

/// Converts an array to a volume.
pub(super) fn volume<R: Read>(
    path: &Path,
    file: NpyFile<R>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let &[z, y, x] = file.shape.as_slice() else {
        return Err(VolumeError::Format {
            path: path.into(),
            reason: Reason::unsupported(
                format!(
                    "holds an array of shape {:?}{}: a volume has three axes, [z, y, x]",
                    file.shape,
                    if file.fortran { " in Fortran order" } else { "" }
                ),
                "save a.reshape(z, y, x) of one volume",
            ),
        });
    };
    let dims = Dims::new(x, y, z)?;
    let dtype = file.dtype;
    let gray_levels = dtype == Dtype::U8 && !file.boolean;
    let shape = dims.shape().set_f(file.fortran);
    let samples = Array3::from_shape_vec(shape, monitor.watch(|| file.values(path))?)
        .expect("count was checked");
    let volume = Volume::of_file(samples, Frame::VOXEL)?;
    // Booleans are bytes, but not gray levels.
    Ok(volume.with_dtype(if gray_levels || dtype != Dtype::U8 { dtype } else { Dtype::I8 }))
}

impl<'a> NpyFile<BufReader<&'a File>> {
    /// Reads and checks the header.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn open(file: &'a OpenFile) -> Result<Self, VolumeError> {
        Self::of(file.path(), file.reader()?, file.length())
    }
}

impl<R: Read> NpyFile<R> {
    /// Drops a last axis of one element behind three others, which is a channel and not a row along x.
    fn without_channel(mut self) -> Self {
        if let [_, _, _, 1] = self.shape[..] {
            self.shape.pop();
        }
        self
    }

    /// Reads and checks the header of an array in a file of `length` bytes.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn of(path: &Path, mut reader: R, length: u64) -> Result<Self, VolumeError> {
        let fail = |reason: Reason| VolumeError::Format { path: path.into(), reason };
        let header = Header::read(&mut reader).map_err(|error| match error {
            NpyError::Io(error) => io_error(path)(error),
            NpyError::Truncated => {
                fail(Reason::truncated("ends inside its NPY header: it is truncated"))
            }
            error @ NpyError::Version(_) => {
                fail(Reason::unsupported(error.to_string(), "convert it first"))
            }
            error @ NpyError::Length(_) => fail(Reason::damaged(error.to_string())),
            error @ NpyError::Dictionary(_) => fail(Reason::header(error.to_string())),
            error => fail(Reason::other(error.to_string())),
        })?;
        let Header { descr, fortran, shape, .. } = header;
        let (dtype, endian, boolean) = element(&descr).ok_or_else(|| {
            let what = format!(
                "holds elements of type {descr}: only bool, integers of 8 to 64 bits, f4 and f8 are read"
            );
            fail(Reason::unsupported(what, instead(&descr)))
        })?;
        let length = Length::Exactly(length).minus(header.length);
        let payload = Payload { reader, length };
        Ok(Self { shape, fortran, dtype, endian, boolean, payload })
    }

    /// All elements in the order of the file, which must contain exactly as many as it claims.
    ///
    /// # Errors
    /// [`VolumeError`] says what cannot be read, and why.
    pub fn values<T: Element>(self, path: &Path) -> Result<Vec<T>, VolumeError> {
        let monitor = &*Monitor::current();
        let count = self.shape.iter().fold(1u64, |product, &n| product.saturating_mul(n));
        let claim = format!("an array of shape {:?} and type {}", self.shape, self.dtype);
        self.payload
            .samples(path, self.dtype, self.endian, count, monitor)
            .map_err(|error| payload_error_of(path, &claim, error))
    }
}

/// What to save instead of an array of an unsupported type.
fn instead(descr: &str) -> &'static str {
    let kind = descr.trim_start_matches(['<', '>', '|', '=']).chars().next();
    match kind {
        Some('[') => "save one of its fields, as in a['value']",
        Some('c') => "save its real part or magnitude, a.real or abs(a)",
        Some('O' | 'U' | 'S' | 'V' | 'M' | 'm') => "save numbers, as in a.astype('f8')",
        _ => "save a.astype('f4')",
    }
}

/// The type, the byte order, and whether it is boolean, for a `NumPy` type string such as `<f4`.
pub fn element(descr: &str) -> Option<(Dtype, Endian, bool)> {
    let (order, kind) = descr.split_at_checked(1)?;
    let dtype = match kind {
        "b1" | "u1" => Dtype::U8,
        "i1" => Dtype::I8,
        "u2" => Dtype::U16,
        "i2" => Dtype::I16,
        "u4" => Dtype::U32,
        "i4" => Dtype::I32,
        "u8" => Dtype::U64,
        "i8" => Dtype::I64,
        "f4" => Dtype::F32,
        "f8" => Dtype::F64,
        _ => return None,
    };
    let endian = match order {
        "<" => Endian::Little,
        ">" => Endian::Big,
        "|" if dtype.size() == 1 => Endian::Little,
        _ => return None,
    };
    Some((dtype, endian, kind == "b1"))
}
