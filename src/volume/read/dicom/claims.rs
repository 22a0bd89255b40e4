//! What a DICOM file claims, looked at before a reader believes it: a parser takes memory for each
//! element by the length in its header.

use std::fs::File;
use std::io::{BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use dicom_encoding::decode::Decode;
use dicom_encoding::decode::explicit_le::ExplicitVRLittleEndianDecoder;
use dicom_encoding::transfer_syntax::Codec;
use dicom_encoding::{TransferSyntax, TransferSyntaxIndex};
use dicom_object::FileMetaTable;
use dicom_parser::DataSetReader;
use dicom_parser::dataset::DataToken;
use dicom_transfer_syntax_registry::TransferSyntaxRegistry;

use super::slice::damaged;
use crate::volume::read::payload::MOST_EXPANSION;
use crate::volume::read::{format_error, io_error};
use crate::volume::{Reason, VolumeError};

/// Bytes before the mark `DICM`.
const PREAMBLE: u64 = 128;

/// Refuses a file with an element longer than the file. What else may be wrong is for the reader to say.
pub(super) fn check(path: &Path) -> Result<(), VolumeError> {
    let mut file = BufReader::new(File::open(path).map_err(io_error(path))?);
    let length = file.get_ref().metadata().map_err(io_error(path))?.len();
    file.seek(SeekFrom::Start(PREAMBLE + 4)).map_err(io_error(path))?;
    check_table(path, &mut file, length)?;
    file.seek(SeekFrom::Start(PREAMBLE)).map_err(io_error(path))?;
    let table = FileMetaTable::from_reader(&mut file).map_err(|error| damaged(path, &error))?;
    let Some(syntax) = TransferSyntaxRegistry.get(table.transfer_syntax()) else { return Ok(()) };
    if let Codec::Dataset(Some(adapter)) = syntax.codec() {
        let most = length.saturating_mul(MOST_EXPANSION);
        let mut data = Vec::new();
        // A stream that breaks off is walked as far as it goes.
        let _ = adapter.adapt_reader(Box::new(file)).take(most).read_to_end(&mut data);
        let length = data.len() as u64;
        return check_elements(path, Cursor::new(data), syntax, length);
    }
    check_elements(path, file, syntax, length)
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
        believe(path, claimed, length)?;
        file.seek_relative(claimed.into()).map_err(io_error(path))?;
        read += bytes as u64 + u64::from(claimed);
    }
    Ok(())
}

/// Reads as the reader of the series does: an element's header comes before its value is read.
fn check_elements(
    path: &Path,
    source: impl Read,
    syntax: &TransferSyntax,
    length: u64,
) -> Result<(), VolumeError> {
    let Ok(reader) = DataSetReader::new_with_ts(source, syntax) else { return Ok(()) };
    for token in reader.map_while(Result::ok) {
        let claimed = match token {
            DataToken::ElementHeader(header) => header.len.get(),
            DataToken::ItemStart { len } => len.get(),
            _ => None,
        };
        believe(path, claimed.unwrap_or(0), length)?;
    }
    Ok(())
}

fn believe(path: &Path, claimed: u32, length: u64) -> Result<(), VolumeError> {
    if u64::from(claimed) <= length {
        return Ok(());
    }
    let reason = Reason::truncated(format!(
        "claims an element of {claimed} bytes and has {length} in all: it is truncated or damaged"
    ));
    Err(format_error(path, reason))
}
