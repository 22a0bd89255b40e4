//! Checks the lengths that a DICOM file claims before the parser trusts them: it allocates memory for each element by the length
//! in its header.

use std::io::{self, Read};
use std::path::Path;

use dicom_encoding::TransferSyntax;
use dicom_encoding::transfer_syntax::Codec;
use dicom_object::Tag;
use dicom_parser::DataSetReader;
use dicom_parser::dataset::DataToken;

use super::start::Start;
use crate::error::{format_error, io_error};
use crate::read::payload::MOST_EXPANSION;
use crate::{Reason, VolumeError};

pub(super) const FLOAT_PIXEL_DATA: Tag = Tag(0x7FE0, 0x0008);
pub(super) const DOUBLE_PIXEL_DATA: Tag = Tag(0x7FE0, 0x0009);
pub(super) const PIXEL_DATA: Tag = Tag(0x7FE0, 0x0010);
const PIXELS: [Tag; 3] = [FLOAT_PIXEL_DATA, DOUBLE_PIXEL_DATA, PIXEL_DATA];

/// The number of unpacked bytes of a packed file that are read whatever they are. A header is smaller than this, and states how
/// many pixels there are.
const MOST_UNPACKED: u64 = 64 << 20;

/// The element that holds the samples of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pixels {
    pub tag: Tag,
    /// The number of its bytes; `None` if they are compressed.
    pub bytes: Option<u64>,
}

/// Refuses a file with an element longer than the file, and finds its pixels. The reader reports all other errors.
pub(super) fn check(path: &Path, start: &Start) -> Result<Option<Pixels>, VolumeError> {
    let file = start.open(path)?;
    let length = file.get_ref().metadata().map_err(io_error(path))?.len();
    let syntax = start.syntax(path)?;
    let Codec::Dataset(Some(adapter)) = syntax.codec() else {
        return check_elements(path, file, syntax, Limits { each: length, all: None });
    };
    // The file is unpacked twice, piece by piece: first to find its length, if it is not too long. A truncated file is as long as
    // what can be unpacked.
    let mut data = adapter.adapt_reader(Box::new(file)).take(MOST_UNPACKED);
    let found = discard(&mut data);
    let (each, all) = if found < MOST_UNPACKED {
        (found, None)
    } else {
        (length.saturating_mul(MOST_EXPANSION), Some(MOST_UNPACKED))
    };
    let again = adapter.adapt_reader(Box::new(start.open(path)?));
    check_elements(path, again, syntax, Limits { each, all })
}

/// Reads to the end, or as far as possible, and returns the number of bytes read.
fn discard(data: &mut impl Read) -> u64 {
    let (mut found, mut buffer) = (0, [0; 1 << 14]);
    while let Ok(bytes @ 1..) = data.read(&mut buffer) {
        found += bytes as u64;
    }
    found
}

/// Limits for the lengths that elements claim.
struct Limits {
    /// The limit for one element.
    each: u64,
    /// The limit for the sum of all elements before the pixels.
    all: Option<u64>,
}

/// Checks the elements in the order in which the reader of the series reads them: the header of an element, then its value.
fn check_elements(
    path: &Path,
    source: impl Read,
    syntax: &TransferSyntax,
    Limits { each, all }: Limits,
) -> Result<Option<Pixels>, VolumeError> {
    let Ok(reader) = DataSetReader::new_with_ts(source, syntax) else { return Ok(None) };
    let mut left = all;
    let mut pixels = None;
    // Pixels inside a sequence are those of an icon.
    let mut depth = 0usize;
    for token in reader.map_while(Result::ok) {
        let claimed = match token {
            DataToken::ElementHeader(header) => {
                if depth == 0 && PIXELS.contains(&header.tag) {
                    let bytes = header.len.get().map(u64::from);
                    pixels = Some(Pixels { tag: header.tag, bytes });
                }
                header.len.get()
            }
            DataToken::PixelSequenceStart => {
                if depth == 0 {
                    pixels = Some(Pixels { tag: PIXEL_DATA, bytes: None });
                }
                depth += 1;
                None
            }
            DataToken::SequenceStart { len, .. } => {
                depth += 1;
                len.get()
            }
            DataToken::SequenceEnd => {
                depth = depth.saturating_sub(1);
                None
            }
            DataToken::ItemStart { len } => len.get(),
            _ => None,
        };
        let claimed = claimed.unwrap_or(0);
        check_length(path, claimed, each)?;
        if let Some(left) = &mut left {
            if pixels.is_some() {
                break;
            }
            if u64::from(claimed) > *left {
                let reason = Reason::header(format!(
                    "claims an element of {claimed} bytes before its pixels, and of what is packed no more than \
                     {MOST_UNPACKED} bytes are taken for a header"
                ));
                return Err(format_error(path, reason));
            }
            // The content of a sequence is counted twice, which does no harm.
            *left = left.saturating_sub(claimed.into());
        }
    }
    Ok(pixels)
}

pub(super) fn check_length(path: &Path, claimed: u32, length: u64) -> Result<(), VolumeError> {
    if u64::from(claimed) <= length {
        return Ok(());
    }
    let reason = Reason::truncated(format!(
        "claims an element of {claimed} bytes and has {length} in all: it is truncated or damaged"
    ));
    Err(format_error(path, reason))
}

/// The error for a file that the parser rejects, with its message and causes.
pub(super) fn damaged(path: &Path, error: &dyn std::error::Error) -> VolumeError {
    let mut what = error.to_string();
    let mut cause = error.source();
    let mut ends_early = false;
    while let Some(inner) = cause {
        what = format!("{what}, {inner}");
        let io = inner.downcast_ref::<io::Error>();
        ends_early |= io.is_some_and(|error| error.kind() == io::ErrorKind::UnexpectedEof);
        cause = inner.source();
    }
    if ends_early {
        let reason =
            Reason::truncated(format!("ends inside of an element ({what}): it is truncated"));
        return format_error(path, reason);
    }
    let reason = Reason::content(
        format!("is a DICOM file that cannot be read ({what})"),
        "convert it with another program, as `gdcmconv --raw` or dcm2niix do, or copy it again if it is shorter than its original",
    );
    format_error(path, reason)
}
