//! Lengths that a DICOM file claims, checked before the parser trusts them: it allocates memory for each
//! element by the length in its header.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use dicom_encoding::decode::Decode;
use dicom_encoding::decode::explicit_le::ExplicitVRLittleEndianDecoder;
use dicom_encoding::transfer_syntax::Codec;
use dicom_encoding::{TransferSyntax, TransferSyntaxIndex};
use dicom_object::{FileMetaTable, Tag};
use dicom_parser::DataSetReader;
use dicom_parser::dataset::DataToken;
use dicom_transfer_syntax_registry::TransferSyntaxRegistry;

use crate::error::{format_error, io_error};
use crate::read::payload::MOST_EXPANSION;
use crate::{Reason, VolumeError};

pub(super) const PIXEL_DATA: Tag = Tag(0x7FE0, 0x0010);

/// Bytes before the mark `DICM`.
const PREAMBLE: u64 = 128;

/// Unpacked bytes of a packed file that are read without asking what they are. A header is smaller, and of pixels it
/// says how many there are.
const MOST_UNPACKED: u64 = 64 << 20;

/// Refuses a file with an element longer than the file. What else may be wrong is for the reader to say. Of a file that is
/// packed as a whole, gives the bytes that its pixels are said to have.
pub(super) fn check(path: &Path) -> Result<Option<u64>, VolumeError> {
    let mut file = BufReader::new(File::open(path).map_err(io_error(path))?);
    let length = file.get_ref().metadata().map_err(io_error(path))?.len();
    file.seek(SeekFrom::Start(PREAMBLE + 4)).map_err(io_error(path))?;
    check_table(path, &mut file, length)?;
    file.seek(SeekFrom::Start(PREAMBLE)).map_err(io_error(path))?;
    let table = FileMetaTable::from_reader(&mut file).map_err(|error| damaged(path, &error))?;
    let Some(syntax) = TransferSyntaxRegistry.get(table.transfer_syntax()) else { return Ok(None) };
    let Codec::Dataset(Some(adapter)) = syntax.codec() else {
        return check_elements(path, file, syntax, Limits { each: length, all: None })
            .map(|_| None);
    };
    let start = file.stream_position().map_err(io_error(path))?;
    let unpacked = |mut file: BufReader<File>| {
        file.seek(SeekFrom::Start(start)).map_err(io_error(path))?;
        Ok::<_, VolumeError>(adapter.adapt_reader(Box::new(file)))
    };
    // It is unpacked piece by piece, twice: first to see how long it is, if it is not too long. One that breaks off
    // is as long as it goes.
    let again = BufReader::new(File::open(path).map_err(io_error(path))?);
    let mut data = unpacked(file)?.take(MOST_UNPACKED);
    let found = discard(&mut data);
    let (each, all) = if found < MOST_UNPACKED {
        (found, None)
    } else {
        (length.saturating_mul(MOST_EXPANSION), Some(MOST_UNPACKED))
    };
    check_elements(path, unpacked(again)?, syntax, Limits { each, all })
}

/// Reads to the end, or as far as it goes, and says how far.
fn discard(data: &mut impl Read) -> u64 {
    let (mut found, mut buffer) = (0, [0; 1 << 14]);
    while let Ok(bytes @ 1..) = data.read(&mut buffer) {
        found += bytes as u64;
    }
    found
}

/// What elements may claim.
struct Limits {
    /// One of them.
    each: u64,
    /// All that come before the pixels together.
    all: Option<u64>,
}

/// Checks the table that every file begins with: its own length, then its elements.
fn check_table(path: &Path, mut file: impl Read + Seek, length: u64) -> Result<(), VolumeError> {
    let decoder = ExplicitVRLittleEndianDecoder::default();
    let mut size = [0; 4];
    if decoder.decode_header(&mut file).is_err() || file.read_exact(&mut size).is_err() {
        return Ok(());
    }
    let (size, mut read) = (u64::from(u32::from_le_bytes(size)), 0);
    while read < size {
        let Ok((header, bytes)) = decoder.decode_header(&mut file) else { break };
        let claimed = header.len.get().unwrap_or(0);
        check_length(path, claimed, length)?;
        file.seek_relative(claimed.into()).map_err(io_error(path))?;
        read += bytes as u64 + u64::from(claimed);
    }
    Ok(())
}

/// Reads as the reader of the series does: an element's header comes before its value is read. Gives the bytes of the
/// pixels, where these are not looked at themselves.
fn check_elements(
    path: &Path,
    source: impl Read,
    syntax: &TransferSyntax,
    Limits { each, all }: Limits,
) -> Result<Option<u64>, VolumeError> {
    let Ok(reader) = DataSetReader::new_with_ts(source, syntax) else { return Ok(None) };
    let mut left = all;
    let mut pixels = None;
    for token in reader.map_while(Result::ok) {
        let claimed = match token {
            DataToken::ElementHeader(header) => {
                if header.tag == PIXEL_DATA {
                    pixels = header.len.get().map(u64::from);
                }
                header.len.get()
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
            // What is in a sequence counts twice, which does no harm.
            *left = left.saturating_sub(claimed.into());
        }
    }
    Ok(pixels)
}

fn check_length(path: &Path, claimed: u32, length: u64) -> Result<(), VolumeError> {
    if u64::from(claimed) <= length {
        return Ok(());
    }
    let reason = Reason::truncated(format!(
        "claims an element of {claimed} bytes and has {length} in all: it is truncated or damaged"
    ));
    Err(format_error(path, reason))
}

/// The error for a file that the reader gives up on, with all that it says.
pub(super) fn damaged(path: &Path, error: &dyn std::error::Error) -> VolumeError {
    let mut what = error.to_string();
    let mut cause = error.source();
    while let Some(inner) = cause {
        what = format!("{what}, {inner}");
        cause = inner.source();
    }
    let reason = Reason::content(
        format!("is a DICOM file that cannot be read ({what})"),
        "copy it again, or convert the series to NRRD",
    );
    format_error(path, reason)
}
