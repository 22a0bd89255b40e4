//! NPY, `NumPy`'s file format for one array (versions 1 to 3 of `numpy.lib.format`).
//!
//! ```
//! use walpha_base::npy::Header;
//!
//! let mut file = b"\x93NUMPY\x01\x00\x3a\x00".to_vec();
//! file.extend(b"{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3)}\n");
//! let header = Header::read(&mut &file[..])?;
//! assert_eq!((header.descr.as_str(), header.shape), ("<f8", vec![2, 3]));
//! assert_eq!(header.length, file.len() as u64);
//! # Ok::<(), walpha_base::npy::NpyError>(())
//! ```

use std::io::{self, ErrorKind, Read, Write};

use crate::advice::{Advise, wrapped};

/// The first bytes of every NPY file.
pub const MAGIC: &[u8] = b"\x93NUMPY";
/// The longest header; `NumPy` refuses longer ones as unsafe.
const MAX_HEADER: u64 = 10_000;

/// The header of an NPY file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Header {
    /// The element type as `NumPy` writes it, such as `<f4` or `|u1`; meaningless text for a
    /// structured type.
    pub descr: String,
    /// Whether the first axis varies fastest in the file.
    pub fortran: bool,
    /// The lengths of the axes; empty for a scalar.
    pub shape: Vec<u64>,
    /// The length of the header in bytes; the elements follow it.
    pub length: u64,
}

/// Why a header cannot be read. The messages continue a sentence that begins with a name.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NpyError {
    /// The reader failed.
    #[error("cannot be read: {0}")]
    Io(#[source] io::Error),
    /// The file ends inside the header.
    #[error("ends inside its NPY header: it is truncated; save it again")]
    Truncated,
    /// The first bytes are not [`MAGIC`].
    #[error("is not an NPY file: it does not begin with \\x93NUMPY")]
    Magic,
    /// The version of the format is one that `NumPy` does not write.
    #[error("is NPY version {0}: 1, 2 and 3 are read")]
    Version(u8),
    /// The header is longer than `NumPy` accepts.
    #[error("has an NPY header of {0} bytes: it is damaged")]
    Length(u64),
    /// The header is not the dictionary it should be.
    #[error("has an NPY header that is not understood: {0:?}")]
    Dictionary(String),
}

impl Advise for NpyError {
    wrapped!(Io);
}

impl Header {
    /// Reads a header; the reader is then at the first element.
    ///
    /// # Errors
    /// [`NpyError`].
    pub fn read(reader: &mut impl Read) -> Result<Self, NpyError> {
        let preamble: [u8; 8] = bytes(reader)?;
        if !preamble.starts_with(MAGIC) {
            return Err(NpyError::Magic);
        }
        let (width, length) = match preamble[6] {
            1 => (2, u64::from(u16::from_le_bytes(bytes(reader)?))),
            2 | 3 => (4, u64::from(u32::from_le_bytes(bytes(reader)?))),
            other => return Err(NpyError::Version(other)),
        };
        if length > MAX_HEADER {
            return Err(NpyError::Length(length));
        }
        let mut text = vec![0; length as usize];
        fill(reader, &mut text)?;
        let text = String::from_utf8_lossy(&text).into_owned();
        let Some((descr, fortran, shape)) = dictionary(&text) else {
            return Err(NpyError::Dictionary(text));
        };
        Ok(Self { descr, fortran, shape, length: 8 + width + length })
    }
}

/// A type of elements that can be written.
pub trait Element: Copy {
    /// The type as `NumPy` writes it.
    const DESCR: &str;

    /// Appends the bytes of the element.
    fn put(self, bytes: &mut Vec<u8>);
}

macro_rules! elements {
    ($($kind:ty: $descr:literal),*) => {
        $(impl Element for $kind {
            const DESCR: &str = $descr;

            fn put(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
        })*
    };
}

elements!(u8: "|u1", i32: "<i4", u32: "<u4", i64: "<i8", u64: "<u8", f32: "<f4", f64: "<f8");

impl Element for bool {
    const DESCR: &str = "|b1";

    fn put(self, bytes: &mut Vec<u8>) {
        bytes.push(self.into());
    }
}

/// The number of elements of an array that are turned into bytes at a time. What is compressed has other bytes if it changes.
const OF_ARRAYS: usize = 1 << 20;
/// The number of elements without a header that are turned into bytes at a time.
const OF_ELEMENTS: usize = 1 << 16;

/// Writes an array whose last axis varies fastest.
///
/// ```
/// use walpha_base::npy::{self, Header};
///
/// let mut file = Vec::new();
/// npy::write(&mut file, &[2, 3], &[0.5, 1.0, 1.5, 2.0, 2.5, 3.0])?;
/// let mut elements = &file[..];
/// assert_eq!(Header::read(&mut elements)?.shape, [2, 3]);
/// assert_eq!(elements[..8], 0.5_f64.to_le_bytes());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Errors of `out`.
///
/// # Panics
/// The elements are not those of the shape.
pub fn write<T: Element>(out: &mut dyn Write, shape: &[usize], elements: &[T]) -> io::Result<()> {
    assert_eq!(shape.iter().product::<usize>(), elements.len(), "elements of shape {shape:?}");
    out.write_all(&header(T::DESCR, shape))?;
    in_chunks(out, elements, OF_ARRAYS)
}

/// Writes the elements of an array and nothing else, little-endian.
///
/// # Errors
/// Errors of `out`.
pub fn write_elements<T: Element>(out: &mut dyn Write, elements: &[T]) -> io::Result<()> {
    in_chunks(out, elements, OF_ELEMENTS)
}

fn in_chunks<T: Element>(out: &mut dyn Write, elements: &[T], size: usize) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(size_of::<T>() * elements.len().min(size));
    for chunk in elements.chunks(size) {
        bytes.clear();
        chunk.iter().for_each(|element| element.put(&mut bytes));
        out.write_all(&bytes)?;
    }
    Ok(())
}

/// A header of version 1. The elements begin at a multiple of 64 bytes.
fn header(descr: &str, shape: &[usize]) -> Vec<u8> {
    let shape = match shape {
        [length] => format!("({length},)"),
        axes => format!("({})", axes.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    };
    let mut text = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}}}");
    const PREAMBLE: usize = 10;
    let spaces = 64 - (PREAMBLE + text.len() + 1) % 64;
    text.extend(std::iter::repeat_n(' ', spaces));
    text.push('\n');
    let length = (text.len() as u16).to_le_bytes();
    [MAGIC, &[1, 0], &length, text.as_bytes()].concat()
}

fn bytes<const N: usize>(reader: &mut impl Read) -> Result<[u8; N], NpyError> {
    let mut bytes = [0; N];
    fill(reader, &mut bytes)?;
    Ok(bytes)
}

fn fill(reader: &mut impl Read, bytes: &mut [u8]) -> Result<(), NpyError> {
    reader.read_exact(bytes).map_err(|error| match error.kind() {
        ErrorKind::UnexpectedEof => NpyError::Truncated,
        _ => NpyError::Io(error),
    })
}

/// `descr`, `fortran_order` and `shape` of a header such as
/// `{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 4), }`.
fn dictionary(text: &str) -> Option<(String, bool, Vec<u64>)> {
    let after = |key: &str| {
        let at = text.find(&format!("'{key}'"))? + key.len() + 2;
        Some(text[at..].trim_start().strip_prefix(':')?.trim_start())
    };
    let descr = after("descr")?;
    let descr = match descr.strip_prefix('\'') {
        Some(quoted) => quoted.split_once('\'')?.0,
        // A structured type is a list. It is kept unchanged, for readers to refuse.
        None => descr.split_once(']').map_or(descr, |(list, _)| list),
    };
    let order = after("fortran_order")?;
    let fortran = if order.starts_with("True") {
        true
    } else if order.starts_with("False") {
        false
    } else {
        return None;
    };
    let (tuple, _) = after("shape")?.strip_prefix('(')?.split_once(')')?;
    let axes = tuple.split(',').map(str::trim).filter(|axis| !axis.is_empty());
    let shape = axes.map(|axis| axis.trim_end_matches('L').parse().ok()).collect::<Option<_>>()?;
    Some((descr.to_owned(), fortran, shape))
}
