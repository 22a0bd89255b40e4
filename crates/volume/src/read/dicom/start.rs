//! Finds the start and the encoding of the data set in a file. Files have a preamble, a mark and a group of elements that names
//! the encoding (PS3.10, 7.1), or lack any of these.

use std::fs::File;
use std::io::{self, BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use dicom_encoding::decode::Decode;
use dicom_encoding::decode::explicit_le::ExplicitVRLittleEndianDecoder;
use dicom_encoding::{TransferSyntax, TransferSyntaxIndex};
use dicom_object::file::ReadPreamble;
use dicom_object::{DefaultDicomObject, OpenFileOptions, Tag};
use dicom_transfer_syntax_registry::TransferSyntaxRegistry;

use super::claims::{check_length, damaged};
use crate::error::{format_error, io_error};
use crate::formats::{dicom_mark, dicom_order};
use crate::{Endian, Reason, VolumeError};

const TRANSFER_SYNTAX: Tag = Tag(0x0002, 0x0010);
const IMPLICIT: &str = "1.2.840.10008.1.2";
const EXPLICIT: &str = "1.2.840.10008.1.2.1";
const EXPLICIT_BIG: &str = "1.2.840.10008.1.2.2";

/// The start and the encoding of a data set.
#[derive(Clone, Debug)]
pub(super) struct Start {
    /// The position of its first byte.
    at: u64,
    /// The UID of its transfer syntax.
    pub uid: String,
    /// The warning if the encoding was recognised by the first elements.
    pub guessed: Option<String>,
}

impl Start {
    /// Finds the data set in a file.
    pub(super) fn of(path: &Path) -> Result<Self, VolumeError> {
        let mut file = BufReader::new(File::open(path).map_err(io_error(path))?);
        let length = file.get_ref().metadata().map_err(io_error(path))?.len();
        let mark = dicom_mark(&peek(&mut file, 132).map_err(io_error(path))?);
        let mut at = mark.map_or(0, |mark| mark + 4);
        file.seek(SeekFrom::Start(at)).map_err(io_error(path))?;
        let decoder = ExplicitVRLittleEndianDecoder::default();
        let mut uid = None;
        // This is the group of elements about the file, whose length need not be stated.
        while peek(&mut file, 2).map_err(io_error(path))? == [2, 0] {
            let Ok((header, bytes)) = decoder.decode_header(&mut file) else { break };
            let claimed = header.len.get().unwrap_or(0);
            check_length(path, claimed, length)?;
            if header.tag == TRANSFER_SYNTAX {
                let mut value = Vec::new();
                file.by_ref()
                    .take(claimed.into())
                    .read_to_end(&mut value)
                    .map_err(io_error(path))?;
                let value = String::from_utf8_lossy(&value);
                uid = Some(value.trim_matches(['\0', ' ']).to_owned());
            } else {
                file.seek_relative(claimed.into()).map_err(io_error(path))?;
            }
            at += bytes as u64 + u64::from(claimed);
        }
        let seen =
            dicom_order(&peek(&mut file, 1024).map_err(io_error(path))?).map(|order| match order {
                (Endian::Big, _) => (EXPLICIT_BIG, "explicit big endian"),
                (Endian::Little, true) => (EXPLICIT, "explicit little endian"),
                (Endian::Little, false) => (IMPLICIT, "implicit little endian"),
            });
        let is_plain = |uid: &str| [IMPLICIT, EXPLICIT, EXPLICIT_BIG].contains(&uid);
        match (uid.filter(|uid| !uid.is_empty()), seen) {
            // Some programs state one encoding and write another.
            (Some(uid), Some((other, how))) if is_plain(&uid) && uid != other => {
                let guessed = format!(
                    "states an encoding that its first elements do not have, and is read as {how}"
                );
                Ok(Self { at, uid: other.into(), guessed: Some(guessed) })
            }
            (Some(uid), _) => Ok(Self { at, uid, guessed: None }),
            (None, Some((uid, how))) => {
                let guessed = format!(
                    "does not say how it is encoded, and is read as {how}, as its first elements look"
                );
                Ok(Self { at, uid: uid.into(), guessed: Some(guessed) })
            }
            (None, None) => {
                let what = "does not say how it is encoded (Transfer Syntax UID), and its first elements do not show it";
                Err(format_error(path, Reason::header(what)))
            }
        }
    }

    /// The encoding, or the error that it has no decoder.
    pub(super) fn syntax(&self, path: &Path) -> Result<&'static TransferSyntax, VolumeError> {
        static REGISTRY: TransferSyntaxRegistry = TransferSyntaxRegistry;
        REGISTRY.get(&self.uid).ok_or_else(|| {
            let what =
                format!("is encoded in a way that is not known (transfer syntax {})", self.uid);
            format_error(path, Reason::unsupported(what, "convert it, as `gdcmconv --raw` does"))
        })
    }

    /// Opens the file at the start of the data set.
    pub(super) fn open(&self, path: &Path) -> Result<BufReader<File>, VolumeError> {
        let mut file = File::open(path).map_err(io_error(path))?;
        file.seek(SeekFrom::Start(self.at)).map_err(io_error(path))?;
        Ok(BufReader::new(file))
    }

    /// Reads the data set, or the part before the element `until`.
    pub(super) fn object(
        &self,
        path: &Path,
        until: Option<Tag>,
    ) -> Result<DefaultDicomObject, VolumeError> {
        let options = OpenFileOptions::new().read_preamble(ReadPreamble::Never);
        let options = match until {
            Some(tag) => options.read_until(tag),
            None => options,
        };
        // The parser needs a whole file. It gets a header that states only the transfer syntax.
        let head = Cursor::new(head(&self.uid));
        options.from_reader(head.chain(self.open(path)?)).map_err(|error| damaged(path, &error))
    }
}

/// Returns the next bytes without consuming them.
fn peek(file: &mut BufReader<File>, bytes: u64) -> io::Result<Vec<u8>> {
    let mut found = Vec::new();
    file.take(bytes).read_to_end(&mut found)?;
    file.seek_relative(-(found.len() as i64))?;
    Ok(found)
}

/// Creates the mark and the group of elements with which a file should begin.
fn head(syntax: &str) -> Vec<u8> {
    let element = |number: u16, value: &str| {
        let padded = value.len().next_multiple_of(2);
        let mut bytes = [2u16.to_le_bytes(), number.to_le_bytes(), *b"UI"].concat();
        bytes.extend((padded as u16).to_le_bytes());
        bytes.extend(value.as_bytes());
        bytes.resize(8 + padded, 0);
        bytes
    };
    let version = [2, 0, 1, 0, b'O', b'B', 0, 0, 2, 0, 0, 0, 0, 1];
    let named = [element(2, ""), element(3, ""), element(0x10, syntax), element(0x12, "1.2")];
    let group = [&version[..], &named.concat()].concat();
    let length = [2, 0, 0, 0, b'U', b'L', 4, 0];
    [&b"DICM"[..], &length, &(group.len() as u32).to_le_bytes(), &group].concat()
}
