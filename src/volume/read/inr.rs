use std::io::{ErrorKind, Read};
use std::path::Path;

use ndarray::Array3;

use super::payload::{Length, Payload};
use super::{io_error, payload_error, unpacked};
use crate::volume::{Coordinates, Dims, Dtype, Endian, Frame, Reason, Volume, VolumeError};

/// The first bytes of each INRIMAGE-4 file.
const MAGIC: &[u8] = b"#INRIMAGE-4#{";
/// The line that ends a header.
const END: &[u8] = b"\n##}\n";
/// Longer headers than these 16 kB are taken for damage.
const MAX_HEADER: usize = 1 << 14;

/// Reads a file, gzipped or not.
pub(crate) fn open(path: &Path) -> Result<Volume, VolumeError> {
    let (reader, length) = unpacked(path)?;
    read(path, reader, length)
}

/// Reads an INRIMAGE-4 image, INRIA's format in which CGAL ships its sample volumes: lines
/// `KEY=VALUE` up to a line `##}`, then the samples, x fastest. Headers should be padded to a multiple
/// of 256 bytes; like CGAL's reader, this one takes any length.
///
/// `SCALE`, `XO`, `YO` and `ZO` have no bearing on where a sample lies and are passed over, as by
/// CGAL; images with several values a voxel (`VDIM`) or rotated axes (`RX`…) are refused.
pub(crate) fn read(
    path: &Path,
    mut reader: impl Read,
    length: Length,
) -> Result<Volume, VolumeError> {
    let text = header(path, &mut reader)?;
    let Header { dims, dtype, endian, frame } =
        parse(&text).map_err(|error| error.located(path))?;
    let payload = Payload { reader, length: length.minus(text.len() as u64) };
    let samples = payload
        .samples(dtype, endian, dims.samples() as u64)
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
    Said(Reason),
    Volume(VolumeError),
}

impl HeaderError {
    fn located(self, path: &Path) -> VolumeError {
        match self {
            Self::Said(reason) => VolumeError::Format { path: path.into(), reason },
            Self::Volume(error) => error,
        }
    }
}

/// Reads up to the line that closes the header.
fn header(path: &Path, reader: &mut impl Read) -> Result<Vec<u8>, VolumeError> {
    let format = |reason: Reason| VolumeError::Format { path: path.into(), reason };
    let mut text = Vec::new();
    reader.take(MAGIC.len() as u64).read_to_end(&mut text).map_err(io_error(path))?;
    if text != MAGIC {
        return Err(format(Reason::other(
            "is no INRIMAGE-4 file: it does not begin with #INRIMAGE-4#{",
        )));
    }
    while !text.ends_with(END) {
        if text.len() == MAX_HEADER {
            return Err(format(Reason::damaged(
                "has no end of header (a line ##}) in 16 kB: it is damaged",
            )));
        }
        let mut byte = [0];
        reader.read_exact(&mut byte).map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => {
                format(Reason::truncated("ends inside its INRIMAGE header: it is truncated"))
            }
            _ => io_error(path)(error),
        })?;
        text.extend(byte);
    }
    Ok(text)
}

fn parse(text: &[u8]) -> Result<Header, HeaderError> {
    let said = HeaderError::Said;
    let text = String::from_utf8_lossy(text);
    let value = |key: &str| {
        let of_key = |line: &str| {
            Some(line.split_once('=')?)
                .filter(|(k, _)| k.trim() == key)
                .map(|(_, v)| v.trim().to_owned())
        };
        text.lines().filter(|line| !line.starts_with('#')).find_map(of_key)
    };
    let needed = |key: &str| {
        value(key).ok_or_else(|| {
            said(Reason::damaged(format!("its INRIMAGE header has no {key}: it is damaged")))
        })
    };
    let size = |key: &str, text: String| {
        text.parse::<u64>().map_err(|_| {
            said(Reason::header(format!("{key}={text} in its header is not a number of samples")))
        })
    };
    let number = |key: &str, default: f64| match value(key) {
        None => Ok(default),
        Some(text) => match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                Err(said(Reason::value(format!("{key}={text} in its header is not a finite number"))))
            }
        },
    };

    let [x, y, z] = ["XDIM", "YDIM", "ZDIM"].map(|key| size(key, needed(key)?));
    let dims = Dims::new(x?, y?, z?).map_err(HeaderError::Volume)?;
    let values = size("VDIM", value("VDIM").unwrap_or_else(|| "1".into()))?;
    if values != 1 {
        return Err(said(Reason::not_scalar(format!("{values} values a voxel (VDIM)"))));
    }
    for key in ["RX", "RY", "RZ"] {
        if number(key, 0.0)? != 0.0 {
            return Err(said(Reason::unsupported(
                format!("has rotated axes ({key}), which are not read"),
                "resample it",
            )));
        }
    }

    let (kind, bits) = (needed("TYPE")?, needed("PIXSIZE")?);
    let dtype = match (kind.as_str(), bits.split_whitespace().next().unwrap_or("")) {
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
            return Err(said(Reason::header(format!(
                "TYPE={kind} of PIXSIZE={bits} is no INRIMAGE sample type: float is 32 or 64 \
                     bits, signed fixed and unsigned fixed are 8, 16, 32 or 64"
            ))));
        }
    };
    let endian = match (value("CPU").as_deref(), dtype.size()) {
        (Some("decm" | "alpha" | "pc"), _) | (None, 1) => Endian::Little,
        (Some("sun" | "sgi"), _) => Endian::Big,
        (cpu, _) => {
            let cpu = cpu.unwrap_or("(missing)");
            return Err(said(Reason::header(format!(
                "CPU={cpu} names no byte order: decm, alpha and pc are little endian, sun \
                     and sgi big"
            ))));
        }
    };

    let mut frame = Frame::VOXEL;
    for (axis, [spacing, origin]) in [["VX", "TX"], ["VY", "TY"], ["VZ", "TZ"]].iter().enumerate() {
        frame.spacing[axis] = number(spacing, 1.0)?;
        frame.origin[axis] = number(origin, 0.0)?;
        if frame.spacing[axis] <= 0.0 {
            return Err(said(Reason::header(format!(
                "{spacing} in its header must be a positive length"
            ))));
        }
        if value(spacing).or(value(origin)).is_some() {
            frame.coordinates = Coordinates::default();
        }
    }
    Ok(Header { dims, dtype, endian, frame })
}
