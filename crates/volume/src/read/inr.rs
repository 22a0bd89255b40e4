use std::io::{ErrorKind, Read};
use std::path::Path;

use ndarray::Array3;
use walpha_base::Monitor;
use walpha_base::shown::shown;

use super::OpenFile;
use super::payload::{Length, Payload, payload_error, unreadable};
use crate::{Coordinates, Dims, Dtype, Endian, Frame, Reason, Volume, VolumeError};

/// The first bytes of each INRIMAGE-4 file.
const MAGIC: &[u8] = b"#INRIMAGE-4#{";
/// The line that ends a header.
const END: &[u8] = b"\n##}\n";
/// Headers longer than these 16 kB are taken for damage.
const MAX_HEADER: usize = 1 << 14;

/// Reads a file, gzipped or not.
pub(crate) fn open(file: &OpenFile, monitor: &Monitor) -> Result<Volume, VolumeError> {
    let (reader, length) = file.unpacked()?;
    read(file.path(), reader, length, monitor)
}

/// Reads an INRIMAGE-4 image, INRIA's format in which CGAL ships its sample volumes: lines `KEY=VALUE` up to a line `##}`, then
/// the samples, x fastest. Headers should be padded to a multiple of 256 bytes; this reader accepts any length, like CGAL's.
///
/// `SCALE`, `XO`, `YO` and `ZO` are ignored, as by CGAL, with a warning if they are not neutral. Images with several values in a
/// voxel (`VDIM`) or rotated axes (`RX`…) are refused.
pub(crate) fn read(
    path: &Path,
    mut reader: impl Read,
    length: Length,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let text = header(path, &mut reader)?;
    let Header { dims, dtype, endian, frame } =
        parse(&text).map_err(|error| error.located(path))?;
    Fields(&String::from_utf8_lossy(&text)).say_what_is_passed_over(path);
    let payload = Payload { reader, length: length.minus(text.len() as u64) };
    let samples = payload
        .samples(path, dtype, endian, dims.samples() as u64, monitor)
        .map_err(payload_error(path, &dims, dtype))?;
    let samples = Array3::from_shape_vec(dims.shape(), samples).expect("count was checked");
    Ok(Volume::of_file(samples, frame)?.with_dtype(dtype))
}

struct Header {
    dims: Dims,
    dtype: Dtype,
    endian: Endian,
    frame: Frame,
}

enum HeaderError {
    Format(Reason),
    Volume(VolumeError),
}

impl HeaderError {
    fn located(self, path: &Path) -> VolumeError {
        match self {
            Self::Format(reason) => VolumeError::Format { path: path.into(), reason },
            Self::Volume(error) => error,
        }
    }
}

/// Reads up to the line that closes the header.
fn header(path: &Path, reader: &mut impl Read) -> Result<Vec<u8>, VolumeError> {
    let format = |reason: Reason| VolumeError::Format { path: path.into(), reason };
    let mut text = Vec::new();
    reader.take(MAGIC.len() as u64).read_to_end(&mut text).map_err(unreadable(path))?;
    if text != MAGIC {
        return Err(format(Reason::other(
            "is not an INRIMAGE-4 file: it does not begin with #INRIMAGE-4#{",
        )));
    }
    while !text.ends_with(END) {
        if text.len() == MAX_HEADER {
            return Err(format(Reason::header("has no end of header (a line ##}) in 16 kB")));
        }
        let mut byte = [0];
        reader.read_exact(&mut byte).map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => {
                format(Reason::truncated("ends inside its INRIMAGE header: it is truncated"))
            }
            _ => unreadable(path)(error),
        })?;
        text.extend(byte);
    }
    Ok(text)
}

fn parse(text: &[u8]) -> Result<Header, HeaderError> {
    let text = String::from_utf8_lossy(text);
    let fields = Fields(&text);
    let [x, y, z] = ["XDIM", "YDIM", "ZDIM"].map(|key| size(key, fields.needed(key)?));
    let dims = Dims::new(x?, y?, z?).map_err(HeaderError::Volume)?;
    let values = size("VDIM", fields.value("VDIM").unwrap_or("1"))?;
    if values != 1 {
        return Err(HeaderError::Format(Reason::not_scalar(
            format!("{values} values a voxel (VDIM)"),
            Some(dims.xyz().map(|n| n as u64)),
        )));
    }
    let dtype = fields.dtype()?;
    Ok(Header { dims, dtype, endian: fields.endian(dtype)?, frame: fields.frame()? })
}

fn size(key: &str, text: &str) -> Result<u64, HeaderError> {
    text.parse().map_err(|_| {
        let what = format!("{key}={text} in its header is not a number of samples");
        HeaderError::Format(Reason::header(what))
    })
}

/// The text of a header: lines `KEY=value` and comments.
struct Fields<'a>(&'a str);

impl<'a> Fields<'a> {
    fn value(&self, key: &str) -> Option<&'a str> {
        let fields = self.0.lines().filter(|line| !line.starts_with('#'));
        fields
            .filter_map(|line| line.split_once('='))
            .find_map(|(name, value)| (name.trim() == key).then(|| value.trim()))
    }

    fn say_what_is_passed_over(&self, path: &Path) {
        if let Some(scale) =
            self.value("SCALE").filter(|scale| !matches!(*scale, "2**0" | "1" | "1.0"))
        {
            tracing::warn!("{}: SCALE={scale} is passed over: values are as stored", shown(path));
        }
        for key in ["XO", "YO", "ZO"] {
            if let Some(place) = self.value(key).filter(|place| place.parse() != Ok(0.0)) {
                tracing::warn!("{}: {key}={place} is passed over", shown(path));
            }
        }
    }

    fn needed(&self, key: &str) -> Result<&'a str, HeaderError> {
        self.value(key).ok_or_else(|| {
            let what = format!("its INRIMAGE header has no {key}");
            HeaderError::Format(Reason::header(what))
        })
    }

    fn number(&self, key: &str, default: f64) -> Result<f64, HeaderError> {
        let Some(text) = self.value(key) else { return Ok(default) };
        text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| {
            let what = format!("{key}={text} in its header is not a finite number");
            HeaderError::Format(Reason::value(what))
        })
    }

    fn dtype(&self) -> Result<Dtype, HeaderError> {
        let (kind, bits) = (self.needed("TYPE")?, self.needed("PIXSIZE")?);
        Ok(match (kind, bits.split_whitespace().next().unwrap_or("")) {
            ("float", "32") => Dtype::F32,
            ("float", "64") => Dtype::F64,
            ("unsigned fixed", "8") => Dtype::U8,
            ("unsigned fixed", "16") => Dtype::U16,
            ("unsigned fixed", "32") => Dtype::U32,
            ("unsigned fixed", "64") => Dtype::U64,
            ("signed fixed", "8") => Dtype::I8,
            ("signed fixed", "16") => Dtype::I16,
            ("signed fixed", "32") => Dtype::I32,
            ("signed fixed", "64") => Dtype::I64,
            _ => {
                return Err(HeaderError::Format(Reason::header(format!(
                    "TYPE={kind} of PIXSIZE={bits} is not an INRIMAGE sample type: float is 32 or 64 \
                     bits, signed fixed and unsigned fixed are 8, 16, 32 or 64"
                ))));
            }
        })
    }

    fn endian(&self, dtype: Dtype) -> Result<Endian, HeaderError> {
        match (self.value("CPU"), dtype.size()) {
            (Some("decm" | "alpha" | "pc"), _) | (None, 1) => Ok(Endian::Little),
            (Some("sun" | "sgi"), _) => Ok(Endian::Big),
            (cpu, _) => {
                let cpu = cpu.unwrap_or("(missing)");
                Err(HeaderError::Format(Reason::header(format!(
                    "CPU={cpu} is not a byte order: decm, alpha and pc are little endian, sun and sgi \
                     big"
                ))))
            }
        }
    }

    fn frame(&self) -> Result<Frame, HeaderError> {
        for key in ["RX", "RY", "RZ"] {
            if self.number(key, 0.0)? != 0.0 {
                return Err(HeaderError::Format(Reason::unsupported(
                    format!("has rotated axes ({key}), which are not read"),
                    "resample it",
                )));
            }
        }
        let mut frame = Frame::VOXEL;
        let keys = [["VX", "TX"], ["VY", "TY"], ["VZ", "TZ"]];
        for (axis, [spacing, origin]) in keys.iter().enumerate() {
            frame.spacing[axis] = self.number(spacing, 1.0)?;
            frame.origin[axis] = self.number(origin, 0.0)?;
            if frame.spacing[axis] <= 0.0 {
                let what = format!("{spacing} in its header must be a positive length");
                return Err(HeaderError::Format(Reason::header(what)));
            }
            if self.value(spacing).or(self.value(origin)).is_some() {
                frame.coordinates = Coordinates::default();
            }
        }
        Ok(frame)
    }
}
