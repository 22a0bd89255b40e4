//! What a DICOM file claims, looked at before a reader believes it: a parser takes memory for each
//! element by the length in its header.

use std::fs::File;
use std::io::{BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use dicom_encoding::transfer_syntax::Codec;
use dicom_encoding::{TransferSyntax, TransferSyntaxIndex};
use dicom_object::FileMetaTable;
use dicom_parser::dataset::LazyDataToken;
use dicom_parser::dataset::lazy_read::LazyDataSetReader;
use dicom_transfer_syntax_registry::TransferSyntaxRegistry;

use super::slice::damaged;
use crate::volume::VolumeError;
use crate::volume::read::payload::MOST_EXPANSION;
use crate::volume::read::{format_error, io_error};

/// Bytes before the mark `DICM`.
const PREAMBLE: u64 = 128;
/// The encoding of the table that every file begins with.
const EXPLICIT_LITTLE_ENDIAN: &str = "1.2.840.10008.1.2.1";

/// Refuses a file with an element longer than the file. Values are passed over; what else may be
/// wrong is for the reader to say.
pub(super) fn check(path: &Path) -> Result<(), VolumeError> {
    let mut file = BufReader::new(File::open(path).map_err(io_error(path))?);
    let length = file.get_ref().metadata().map_err(io_error(path))?.len();
    let table = TransferSyntaxRegistry.get(EXPLICIT_LITTLE_ENDIAN).expect("the default encoding");
    file.seek(SeekFrom::Start(PREAMBLE + 4)).map_err(io_error(path))?;
    walk(path, &mut file, table, length, |group| group == 2)?;
    file.seek(SeekFrom::Start(PREAMBLE)).map_err(io_error(path))?;
    let table = FileMetaTable::from_reader(&mut file).map_err(|error| damaged(path, &error))?;
    let Some(syntax) = TransferSyntaxRegistry.get(table.transfer_syntax()) else { return Ok(()) };
    if let Codec::Dataset(Some(adapter)) = syntax.codec() {
        let most = length.saturating_mul(MOST_EXPANSION);
        let mut data = Vec::new();
        // A stream that breaks off is walked as far as it goes.
        let _ = adapter.adapt_reader(Box::new(file)).take(most).read_to_end(&mut data);
        let length = data.len() as u64;
        return walk(path, Cursor::new(data), syntax, length, |_| true);
    }
    walk(path, file, syntax, length, |_| true)
}

/// Walks over elements as long as they are of groups wanted.
fn walk(
    path: &Path,
    source: impl Read + Seek,
    syntax: &TransferSyntax,
    length: u64,
    wanted: impl Fn(u16) -> bool,
) -> Result<(), VolumeError> {
    let Ok(mut reader) = LazyDataSetReader::new_with_ts(source, syntax) else { return Ok(()) };
    while let Some(Ok(token)) = reader.advance() {
        let claimed = match &token {
            LazyDataToken::ElementHeader(header) if !wanted(header.tag.group()) => return Ok(()),
            LazyDataToken::ElementHeader(header) => header.len.get().unwrap_or(0),
            LazyDataToken::LazyItemValue { len, .. } => *len,
            _ => 0,
        };
        if u64::from(claimed) > length {
            let what = format!(
                "claims an element of {claimed} bytes and has {length} in all: it is truncated or damaged"
            );
            return Err(format_error(path, what));
        }
        let is_value =
            matches!(token, LazyDataToken::LazyValue { .. } | LazyDataToken::LazyItemValue { .. });
        if is_value && token.skip().is_err() {
            break;
        }
    }
    Ok(())
}
