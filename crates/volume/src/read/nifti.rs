//! NIfTI-1 and NIfTI-2.

use std::io::Read;
use std::path::{Path, PathBuf};

use walpha_base::Monitor;
use walpha_base::shown::{rounded, shown};

use super::OpenFile;
use super::detached::naming;
use super::frames::FrameChoice;
use super::layout::{Encoding, Layout, diagonal, frame};
use super::payload::{Length, Payload, payload_error, unreadable};
use super::uncompressed::Uncompressed;
use crate::error::{format_error, io_error};
use crate::formats::{NIFTI_HEADERS, nifti_version};
use crate::source::whole_only;
use crate::{
    Coordinates, Dims, Dtype, Endian, Frame, LengthUnit, Reason, Space, Volume, VolumeError,
};

/// Reads NIfTI-1 and NIfTI-2 (nifti.nimh.nih.gov): `.nii`, `.nii.gz`, or a pair `.hdr` and `.img`.
///
/// `scl_slope` and `scl_inter` are applied. The frame is that of `sform`, else of `qform`, else of `pixdim` alone, which says
/// nothing about the space; the other two are RAS. Axes beyond the third count volumes, of which `frame` is read; colours and
/// complex numbers are refused.
pub(crate) fn read(
    file: &OpenFile,
    frame: Option<u64>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let (mut reader, length) = file.unpacked()?;
    let header = Header::read(path, &mut reader)?;
    let volume = volume(file, &header, frame, (reader, length), monitor)?;
    Ok(if header.states_labels() { volume.with_labels() } else { volume })
}

/// Reads the samples behind a header, or in the file beside it.
fn volume(
    file: &OpenFile,
    header: &Header,
    frame: Option<u64>,
    (mut reader, length): (impl Read, Length),
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let layout = header.layout(path, frame)?;
    let (slope, inter) = header.scaling(path);
    if header.is_pair(path)? {
        let image = image(path);
        let data = OpenFile::open(&image)?;
        let (mut reader, length) = data.unpacked()?;
        let offset = header.vox_offset().max(0.0) as u64;
        std::io::copy(&mut (&mut reader).take(offset), &mut std::io::sink())
            .map_err(io_error(&image))?;
        return samples(path, layout, slope, inter, reader, length.minus(offset), monitor)
            .map_err(naming(path, &[image]));
    }
    let offset = header.offset(path)?;
    let skip = offset - header.bytes.len() as u64;
    let skipped = std::io::copy(&mut (&mut reader).take(skip), &mut std::io::sink());
    if skipped.map_err(unreadable(path))? < skip {
        return Err(format_error(
            path,
            Reason::claims_more(format!("ends before its samples at byte {offset} (vox_offset)")),
        ));
    }
    samples(path, layout, slope, inter, reader, length.minus(offset), monitor)
}

/// Locates the samples of a volume, to be read part by part.
pub(crate) fn box_reader(file: &OpenFile, frame: Option<u64>) -> Result<Uncompressed, VolumeError> {
    let path = file.path();
    let header = Header::read(path, &mut file.reader()?)?;
    let layout = header.layout(path, frame)?;
    let scaling = header.scaling(path);
    let samples = if header.is_pair(path)? {
        if image(path).extension().is_some_and(|own| own.eq_ignore_ascii_case("gz")) {
            return Err(whole_only(path, "NIfTI"));
        }
        let offset = header.vox_offset().max(0.0) as u64;
        Uncompressed::in_data_file(path, layout, &[image(path)], Some(offset))?
    } else {
        Uncompressed::after_header(file, layout, header.offset(path)?, Some(0))?
    };
    Ok(samples.scaled(scaling).with_labels(header.states_labels()))
}

/// The file that holds the samples, if it is not the header's.
pub(crate) fn data_files(file: &OpenFile) -> Result<Vec<PathBuf>, VolumeError> {
    let path = file.path();
    let Some((version, endian)) = nifti_version(file.start()) else { return Ok(Vec::new()) };
    let header = Header { bytes: file.start().to_vec(), version, endian };
    Ok(if header.is_pair(path)? { vec![image(path)] } else { Vec::new() })
}

/// The partner of a header: `v.img` for `v.hdr` or `v.hdr.gz`, or `v.img.gz` if only that exists.
fn image(header: &Path) -> PathBuf {
    let is_packed = header.extension().is_some_and(|own| own.eq_ignore_ascii_case("gz"));
    let header = if is_packed { header.with_extension("") } else { header.to_owned() };
    let (plain, packed) = (header.with_extension("img"), header.with_extension("img.gz"));
    if !plain.exists() && packed.exists() { packed } else { plain }
}

/// Reads samples and scales them, in doubles if `f32` does not hold the numbers of the file.
fn samples(
    path: &Path,
    layout: Layout,
    slope: f64,
    inter: f64,
    reader: impl Read,
    length: Length,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let Layout { dims, dtype, endian, frames, .. } = layout;
    dims.bounded()?;
    let each = dims.bytes(dtype.size());
    let (reader, length) = frames.select(path, reader, length, each)?;
    let payload = Payload { reader, length };
    let fail = payload_error(path, &dims, dtype);
    let count = dims.samples() as u64;
    if (slope, inter) == (1.0, 0.0) {
        let samples = payload.samples(path, dtype, endian, count, monitor).map_err(fail)?;
        return layout.volume(samples);
    }
    let scaled: Vec<f32> = if dtype.size() < 4 || dtype == Dtype::F32 {
        let mut samples: Vec<f32> =
            payload.samples(path, dtype, endian, count, monitor).map_err(fail)?;
        samples.iter_mut().for_each(|v| *v = (f64::from(*v) * slope + inter) as f32);
        samples
    } else {
        let samples: Vec<f64> =
            payload.samples(path, dtype, endian, count, monitor).map_err(fail)?;
        samples.iter().map(|v| (v * slope + inter) as f32).collect()
    };
    // Bytes that were scaled are not gray levels.
    Ok(layout.volume(scaled)?.with_dtype(Dtype::F32))
}

/// The codes of `intent_code` for several values a voxel, along the fifth axis: matrices, vectors, quaternions, and colours.
const VECTORS: [i32; 7] = [1004, 1005, 1006, 1007, 1010, 2003, 2004];

/// The bytes of a header. Methods take the positions in version 1 and version 2.
struct Header {
    bytes: Vec<u8>,
    version: u8,
    endian: Endian,
}

impl Header {
    /// Reads a header and nothing behind it.
    fn read(path: &Path, reader: &mut dyn Read) -> Result<Self, VolumeError> {
        let mut bytes = Vec::new();
        let mut fill = |size: usize, bytes: &mut Vec<u8>| -> Result<(), VolumeError> {
            let left = (size - bytes.len()) as u64;
            reader.take(left).read_to_end(bytes).map_err(unreadable(path))?;
            if bytes.len() < size {
                return Err(format_error(
                    path,
                    Reason::truncated("ends inside its NIfTI header: it is truncated"),
                ));
            }
            Ok(())
        };
        fill(NIFTI_HEADERS[0], &mut bytes)?;
        let Some((version, endian)) = nifti_version(&bytes) else {
            let reason = Reason::other(
                "is not a NIfTI file: it begins with neither 348 nor 540, the length of its header",
            );
            return Err(format_error(path, reason));
        };
        if version == 2 {
            fill(NIFTI_HEADERS[1], &mut bytes)?;
        }
        Ok(Self { bytes, version, endian })
    }

    /// Bytes at a position, least significant first.
    fn at<const N: usize>(&self, one: usize, two: usize) -> [u8; N] {
        let place = if self.version == 1 { one } else { two };
        let mut bytes: [u8; N] = self.bytes[place..place + N].try_into().expect("inside");
        if self.endian == Endian::Big {
            bytes.reverse();
        }
        bytes
    }

    fn short(&self, one: usize, two: usize) -> i16 {
        i16::from_le_bytes(self.at(one, two))
    }

    /// A code, which has 16 bits in version 1 and 32 in version 2.
    fn code(&self, one: usize, two: usize) -> i32 {
        match self.version {
            1 => i32::from(self.short(one, two)),
            _ => i32::from_le_bytes(self.at(one, two)),
        }
    }

    /// A real number: `f32` in version 1, `f64` in version 2. `i` counts the numbers from the position.
    fn real(&self, one: usize, two: usize, i: usize) -> f64 {
        match self.version {
            1 => f32::from_le_bytes(self.at(one + 4 * i, 0)).into(),
            _ => f64::from_le_bytes(self.at(0, two + 8 * i)),
        }
    }

    fn dim(&self, axis: usize) -> i64 {
        match self.version {
            1 => self.short(40 + 2 * axis, 0).into(),
            _ => i64::from_le_bytes(self.at(0, 16 + 8 * axis)),
        }
    }

    /// Whether the samples are in a separate file.
    fn is_pair(&self, path: &Path) -> Result<bool, VolumeError> {
        let place = if self.version == 1 { 344 } else { 4 };
        match &self.bytes[place..place + 4] {
            b"n+1\0" | b"n+2\0" => Ok(false),
            b"ni1\0" | b"ni2\0" => Ok(true),
            [0, ..] if self.version == 1 => Err(format_error(
                path,
                Reason::unsupported(
                    "is an Analyze 7.5 header, which says nothing of orientation and is not read",
                    "convert it to NIfTI",
                ),
            )),
            magic => Err(format_error(
                path,
                Reason::other(format!(
                    "is not a NIfTI file: its magic is {:?}, and not n+1",
                    String::from_utf8_lossy(magic)
                )),
            )),
        }
    }

    fn vox_offset(&self) -> f64 {
        match self.version {
            1 => f64::from(f32::from_le_bytes(self.at(108, 0))),
            _ => i64::from_le_bytes(self.at(0, 168)) as f64,
        }
    }

    /// The position of the samples in a file of its own.
    fn offset(&self, path: &Path) -> Result<u64, VolumeError> {
        let offset = self.vox_offset();
        if offset >= self.bytes.len() as f64 && offset.fract() == 0.0 {
            return Ok(offset as u64);
        }
        // Some writers leave 0 for "behind the header and its 4 bytes of extension flags".
        if offset == 0.0 {
            return Ok(self.bytes.len() as u64 + 4);
        }
        Err(format_error(
            path,
            Reason::header(format!("has samples at byte {offset} (vox_offset), in its header")),
        ))
    }

    fn layout(&self, path: &Path, frame: Option<u64>) -> Result<Layout, VolumeError> {
        let fail = |reason: Reason| format_error(path, reason);
        let axes = self.dim(0);
        if !(1..=7).contains(&axes) {
            return Err(fail(Reason::header(format!(
                "has dim[0] = {axes}: 1 to 7 axes are possible"
            ))));
        }
        let size = |axis: usize| if axis as i64 <= axes { self.dim(axis) } else { 1 };
        let sizes = [1, 2, 3, 4, 5, 6, 7].map(size);
        if sizes.iter().any(|&size| size < 0) {
            return Err(fail(Reason::header(format!("has axes of {sizes:?} samples (dim)"))));
        }
        let sizes = sizes.map(|size| size as u64);
        if sizes[4] > 1 && VECTORS.contains(&self.code(68, 504)) {
            let what = format!("{} values a voxel", sizes[4]);
            return Err(fail(Reason::not_scalar(what, Some([sizes[0], sizes[1], sizes[2]]))));
        }
        let frames = FrameChoice::choose(path, &sizes[3..], frame)?;
        let [x, y, z, ..] = sizes;
        let dims = Dims::unbounded(x, y, z)?;
        let dtype = match self.short(70, 12) {
            2 => Dtype::U8,
            4 => Dtype::I16,
            8 => Dtype::I32,
            16 => Dtype::F32,
            64 => Dtype::F64,
            256 => Dtype::I8,
            512 => Dtype::U16,
            768 => Dtype::U32,
            1024 => Dtype::I64,
            1280 => Dtype::U64,
            code => {
                let name = match code {
                    1 => "single bits",
                    128 | 2304 => {
                        let dims = Some([x, y, z]);
                        return Err(fail(Reason::not_scalar("colours", dims)));
                    }
                    32 | 1792 | 2048 => "complex numbers",
                    1536 => "128-bit floats",
                    _ => "an unknown type",
                };
                return Err(fail(Reason::unsupported(
                    format!(
                        "holds {name} (datatype {code}): integers of 8 to 64 bits, float32 \
                             and float64 are read"
                    ),
                    "convert it",
                )));
            }
        };
        let frame = self.frame(path, dims)?;
        let (endian, encoding) = (self.endian, Encoding::Raw);
        Ok(Layout { dims, dtype, endian, frame, encoding, frames })
    }

    /// Whether the values are labels: `intent_code` is `NIFTI_INTENT_LABEL`.
    fn states_labels(&self) -> bool {
        self.code(68, 504) == 1002
    }

    /// The slope and intercept; a slope of 0, or that is not a number, disables both. An intercept that is not a number is 0, as
    /// for `NIfTI`'s own library, with a warning.
    fn scaling(&self, path: &Path) -> (f64, f64) {
        let (slope, inter) = (self.real(112, 176, 0), self.real(116, 184, 0));
        if slope == 0.0 || !slope.is_finite() {
            return (1.0, 0.0);
        }
        if !inter.is_finite() {
            tracing::warn!(
                "{}: its scl_inter is {inter}, and taken as 0; scl_slope is {slope}",
                shown(path)
            );
            return (slope, 0.0);
        }
        (slope, inter)
    }
}

/// Rounding makes the square of a quaternion exceed 1 by no more than this.
const LONGER: f64 = 1e-5;
/// `sform` and `qform` disagree if they place a sample further apart than this share of the smallest spacing.
const APART: f64 = 0.01;

impl Header {
    /// The place of the grid: according to `sform`, else to `qform`. A warning says by how much these differ.
    fn frame(&self, path: &Path, dims: Dims) -> Result<Frame, VolumeError> {
        let taken = if self.code(254, 348) > 0 {
            self.sform(path)?
        } else {
            let pixdim = |i: usize| self.real(76, 104, i);
            let is_placed = self.code(252, 344) > 0 || (1..=3).any(|i| pixdim(i) != 0.0);
            let is_unknown = |i: &usize| is_placed && pixdim(*i) == 0.0 && dims.xyz()[i - 1] > 1;
            for i in (1..=3).filter(is_unknown) {
                tracing::warn!("{}: its pixdim[{i}] is 0, and taken as 1", shown(path));
            }
            self.qform(path)?
        };
        let unit = taken.coordinates.unit;
        if self.length_unit() > 3 {
            tracing::warn!(
                "{}: its unit (xyzt_units {}) is not known, and passed over",
                shown(path),
                self.length_unit()
            );
        }
        if matches!(unit, LengthUnit::Metre | LengthUnit::Micrometre) {
            tracing::warn!(
                "{}: lengths are in {}, as the file states; programs that use ITK scale them to mm",
                shown(path),
                unit.symbol()
            );
        }
        if self.code(254, 348) > 0
            && self.code(252, 344) > 0
            && let Ok(other) = self.qform(path)
        {
            let apart = apart(&taken, &other, dims);
            let shortest = taken.spacing.iter().copied().fold(f64::INFINITY, f64::min);
            if apart > APART * shortest {
                tracing::warn!(
                    "{}: sform and qform place samples up to {} {} apart: sform is taken",
                    shown(path),
                    rounded(apart),
                    unit.symbol()
                );
            }
        }
        Ok(taken)
    }

    fn sform(&self, path: &Path) -> Result<Frame, VolumeError> {
        let row = |r: usize| [0, 1, 2, 3].map(|c| self.real(280, 400, 4 * r + c));
        let rows = [row(0), row(1), row(2)];
        let column = |c: usize| [0, 1, 2].map(|r| rows[r][c]);
        let axes = [column(0), column(1), column(2)];
        frame(path, column(3), axes, self.coordinates(Space::Ras))
    }

    /// The frame according to `qform`, or else to `pixdim` alone.
    fn qform(&self, path: &Path) -> Result<Frame, VolumeError> {
        let pixdim = |i: usize| self.real(76, 104, i);
        // In some files, 0 stands for "unknown".
        let length = |i: usize| if pixdim(i) == 0.0 { 1.0 } else { pixdim(i).abs() };
        let spacing = [1, 2, 3].map(length);
        if [1, 2, 3].map(pixdim).iter().any(|&length| length < 0.0) {
            tracing::warn!("{}: its pixdim is negative, and taken without the sign", shown(path));
        }
        if self.code(252, 344) <= 0 {
            let coordinates = self.coordinates(Space::Unknown);
            let is_placed = spacing != [1.0; 3] || coordinates.unit.is_known();
            let coordinates = if is_placed { coordinates } else { Coordinates::VOXEL };
            return frame(path, [0.0; 3], diagonal(spacing), coordinates);
        }
        let mut imaginary = [0, 1, 2].map(|i| self.real(256, 352, i));
        let square: f64 = imaginary.iter().map(|v| v * v).sum();
        if square > 1.0 + LONGER {
            tracing::warn!(
                "{}: its quaternion (quatern_b…) is longer than 1, and shortened",
                shown(path)
            );
        }
        // For a turn of almost 180°, the real part would consist of rounding errors. NIfTI's own library does the same.
        let half_turn = 1.0 - square < 1e-7;
        if half_turn && square > 0.0 {
            imaginary = imaginary.map(|v| v / square.sqrt());
        }
        let a = if half_turn { 0.0 } else { (1.0 - square).sqrt() };
        let [b, c, d] = imaginary;
        let mut rotation = [
            [a * a + b * b - c * c - d * d, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
            [2.0 * (b * c + a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d - a * b)],
            [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a + d * d - b * b - c * c],
        ];
        if pixdim(0) < 0.0 {
            rotation.iter_mut().for_each(|row| row[2] = -row[2]);
        }
        let axis = |c: usize| [0, 1, 2].map(|r| rotation[r][c] * spacing[c]);
        let origin = [0, 1, 2].map(|i| self.real(268, 376, i));
        frame(path, origin, [axis(0), axis(1), axis(2)], self.coordinates(Space::Ras))
    }

    /// The code of the unit of lengths in `xyzt_units`.
    fn length_unit(&self) -> u8 {
        let code = match self.version {
            1 => self.at::<1>(123, 0)[0],
            _ => self.at::<4>(0, 500)[0],
        };
        code & 7
    }

    /// The unit of `xyzt_units`; millimetres for a patient if it names none.
    fn coordinates(&self, space: Space) -> Coordinates {
        let unit = match self.length_unit() {
            1 => LengthUnit::Metre,
            2 => LengthUnit::Millimetre,
            3 => LengthUnit::Micrometre,
            _ if space.is_known() => LengthUnit::Millimetre,
            _ => LengthUnit::Unstated,
        };
        Coordinates { space, unit }
    }
}

/// The largest distance between the places of a sample in two frames, which occurs at a corner of the grid.
fn apart(one: &Frame, other: &Frame, dims: Dims) -> f64 {
    let last = dims.xyz().map(|n| n.saturating_sub(1) as f64);
    let distance = |corner: usize| {
        let index = [0, 1, 2].map(|k| if corner >> k & 1 == 1 { last[k] } else { 0.0 });
        let [a, b] = [one, other].map(|frame| frame.to_world(index));
        [0, 1, 2].map(|k| (a[k] - b[k]).powi(2)).iter().sum::<f64>().sqrt()
    };
    (0..8).map(distance).fold(0.0, f64::max)
}
