//! The bytes of a file of points, unpacked if the file is compressed with gzip, or is a ZIP archive of one file.

use std::io::{self, BufRead, BufReader, Cursor, Read};
use std::path::{Path, PathBuf};

use walpha_base::memory::try_reserve;
use zip::ZipArchive;

use super::{PointsError, format};
use walpha_volume::{Gunzip, OpenFile, Reason, io_error};

/// The magic bytes of gzip streams.
const GZIP: &[u8] = b"\x1f\x8b";
/// The magic bytes of ZIP archives.
const ZIP: &[u8] = b"PK\x03\x04";
/// The number of unpacked bytes by which a format is recognised.
const START: u64 = 1024;

/// The content of a compressed file.
pub(crate) struct Packed {
    /// Its name, as far as it is known.
    pub name: PathBuf,
    /// Its first bytes.
    pub start: Vec<u8>,
}

impl Packed {
    /// The content of a file that is compressed with gzip, or is an archive of one file.
    pub(crate) fn of(file: &OpenFile) -> Option<Self> {
        let (path, mut start) = (file.path(), Vec::new());
        if file.start().starts_with(GZIP) {
            // If it cannot be unpacked, the reader says why.
            let _ = Gunzip::quiet(file.reader().ok()?).take(START).read_to_end(&mut start);
            let is_gz = path.extension().is_some_and(|own| own.eq_ignore_ascii_case("gz"));
            let name = if is_gz { path.with_extension("") } else { path.to_owned() };
            return Some(Self { name, start });
        }
        if !file.start().starts_with(ZIP) {
            return None;
        }
        let mut archive = ZipArchive::new(file.reader().ok()?).ok()?;
        let [only] = members(&archive)[..] else { return None };
        let mut member = archive.by_index(only).ok()?;
        let name = member.name().into();
        let _ = (&mut member).take(START).read_to_end(&mut start);
        Some(Self { name, start })
    }
}

/// The files of an archive, without those that macOS adds.
fn members(archive: &ZipArchive<impl Read + io::Seek>) -> Vec<usize> {
    let is_file = |i: &usize| {
        archive.name_for_index(*i).is_some_and(|name| {
            let last = name.rsplit('/').next().unwrap_or_default();
            !last.is_empty() && !last.starts_with('.') && !name.starts_with("__MACOSX/")
        })
    };
    (0..archive.len()).filter(is_file).collect()
}

/// The bytes of a file, unpacked.
pub(super) struct Content<'a> {
    /// The reader, at the first byte.
    pub reader: Box<dyn BufRead + 'a>,
    /// The number of bytes.
    pub length: u64,
}

impl<'a> Content<'a> {
    pub(super) fn of(file: &'a OpenFile) -> Result<Self, PointsError> {
        let path = file.path();
        let mut reader = file.reader()?;
        let start = reader.fill_buf().map_err(io_error(path))?;
        let bytes = if start.starts_with(GZIP) {
            let mut bytes = Vec::new();
            append(&mut bytes, Gunzip::new(path, reader), |error| damaged(path, &error))?;
            bytes
        } else if start.starts_with(ZIP) && file.is_ordinary() {
            only_member(path, reader)?
        } else if !file.is_ordinary() {
            let mut bytes = Vec::new();
            append(&mut bytes, reader, io_error(path))?;
            bytes
        } else {
            return Ok(Self { reader: Box::new(reader), length: file.length() });
        };
        Ok(Self { length: bytes.len() as u64, reader: Box::new(Cursor::new(bytes)) })
    }

    /// Reads all bytes.
    pub(super) fn bytes(self, path: &Path) -> Result<Vec<u8>, PointsError> {
        let mut bytes = Vec::new();
        append(&mut bytes, self.reader, io_error(path))?;
        Ok(bytes)
    }
}

/// Reads the lines of a header in front of other data. The first line shows how lines end: with LF, CR LF, or CR.
pub(super) struct HeaderLines<'a> {
    reader: Box<dyn BufRead + 'a>,
    end: Option<u8>,
    bytes: u64,
}

impl<'a> HeaderLines<'a> {
    pub(super) fn new(reader: Box<dyn BufRead + 'a>) -> Self {
        Self { reader, end: None, bytes: 0 }
    }

    /// The next line without its end. Bytes that are not UTF-8 are replaced.
    pub(super) fn read(&mut self) -> io::Result<Option<String>> {
        /// The largest length of a line. Longer ones are data mistaken for a header.
        const MOST: u64 = 1 << 16;
        let end = match self.end {
            Some(end) => end,
            None => *self.end.insert(line_end(&mut self.reader)?),
        };
        let mut line = Vec::new();
        let found = (&mut self.reader).take(MOST).read_until(end, &mut line)? as u64;
        if found == MOST {
            let what = "a line of its header has no end within 64 kB";
            return Err(io::Error::new(io::ErrorKind::InvalidData, what));
        }
        self.bytes += found;
        let line = line.strip_suffix(&[end]).unwrap_or(&line);
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        Ok((found > 0).then(|| String::from_utf8_lossy(line).into_owned()))
    }

    /// The number of bytes of the lines so far.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The reader, after the last line.
    pub(super) fn into_inner(self) -> Box<dyn BufRead + 'a> {
        self.reader
    }
}

/// The last byte of each line: LF, unless the first line ends with a CR without LF.
fn line_end(reader: &mut impl BufRead) -> io::Result<u8> {
    let start = reader.fill_buf()?;
    let at = start.iter().position(|byte| b"\r\n".contains(byte));
    Ok(match at.map(|at| &start[at..]) {
        Some([b'\r', next, ..]) if *next != b'\n' => b'\r',
        _ => b'\n',
    })
}

fn only_member<R: Read + io::Seek>(
    path: &Path,
    reader: BufReader<R>,
) -> Result<Vec<u8>, PointsError> {
    let damaged = |error: io::Error| damaged(path, &error);
    let mut archive = ZipArchive::new(reader).map_err(|error| damaged(error.into()))?;
    let [only] = members(&archive)[..] else {
        let what = format!("is a ZIP archive of {} files", members(&archive).len());
        let reason = Reason::unsupported(what, "unpack it, and name one of them");
        return Err(format(path, reason));
    };
    let member = archive.by_index(only).map_err(|error| damaged(error.into()))?;
    let mut bytes = Vec::new();
    append(&mut bytes, member, damaged)?;
    Ok(bytes)
}

fn damaged(path: &Path, error: &io::Error) -> PointsError {
    format(
        path,
        match error.kind() {
            io::ErrorKind::UnexpectedEof => {
                Reason::truncated("ends inside its compressed data: it is truncated")
            }
            _ => Reason::damaged(format!("has damaged compressed data ({error})")),
        },
    )
}

/// Reads to the end. The memory for that may be refused.
fn append<E>(
    bytes: &mut Vec<u8>,
    mut reader: impl Read,
    fail: impl Fn(io::Error) -> E,
) -> Result<(), PointsError>
where
    PointsError: From<E>,
{
    const PIECE: usize = 1 << 20;
    loop {
        try_reserve(bytes, PIECE, || "what a file holds".into())?;
        if (&mut reader).take(PIECE as u64).read_to_end(bytes).map_err(&fail)? == 0 {
            return Ok(());
        }
    }
}
