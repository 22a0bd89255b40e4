//! A file to read. It is opened only once, from the detection of its format to the reading of its samples.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use super::gunzip::Gunzip;
use super::payload::Length;
use crate::VolumeError;
use crate::error::io_error;
use crate::formats::is_gzip;

/// The number of bytes by which a format is recognised.
const START: u64 = 1024;

/// An open file and its first bytes. Detection uses these, and readers start again at the first byte.
#[derive(Debug)]
pub struct OpenFile {
    path: PathBuf,
    file: File,
    length: u64,
    is_ordinary: bool,
    start: Vec<u8>,
}

impl OpenFile {
    /// Opens a file.
    ///
    /// # Errors
    /// [`VolumeError::Io`] if it cannot be opened or read.
    pub fn open(path: &Path) -> Result<Self, VolumeError> {
        let failed = io_error(path);
        let file = File::open(path).map_err(&failed)?;
        let metadata = file.metadata().map_err(&failed)?;
        let mut start = Vec::new();
        // The bytes of a pipe can be read only once: they are left to the reader. Reading a folder gives the error that it is
        // one.
        if metadata.is_file() || metadata.is_dir() {
            (&file).take(START).read_to_end(&mut start).map_err(&failed)?;
        }
        let (length, is_ordinary) = (metadata.len(), metadata.is_file());
        Ok(Self { path: path.into(), file, length, is_ordinary, start })
    }

    /// The path by which it was opened.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The length in bytes.
    pub fn length(&self) -> u64 {
        self.length
    }

    /// Whether it is an ordinary file, which can be read in several passes, and not a pipe or device.
    pub fn is_ordinary(&self) -> bool {
        self.is_ordinary
    }

    /// The first bytes: up to 1024, or none for a pipe.
    pub fn start(&self) -> &[u8] {
        &self.start
    }

    /// Returns a reader at the first byte. All readers of a file share one position: a new one invalidates those before.
    ///
    /// # Errors
    /// [`VolumeError::Io`].
    pub fn reader(&self) -> Result<BufReader<&File>, VolumeError> {
        if self.start.is_empty() { Ok(BufReader::new(&self.file)) } else { self.reader_at(0) }
    }

    /// Reads all bytes.
    ///
    /// # Errors
    /// [`VolumeError::Io`].
    pub fn bytes(&self) -> Result<Vec<u8>, VolumeError> {
        let mut bytes = Vec::new();
        self.reader()?.read_to_end(&mut bytes).map_err(io_error(&self.path))?;
        Ok(bytes)
    }

    /// Returns a reader at another byte.
    ///
    /// # Errors
    /// [`VolumeError::Io`]; among others, a pipe cannot be read from another position.
    pub fn reader_at(&self, offset: u64) -> Result<BufReader<&File>, VolumeError> {
        let mut file = &self.file;
        file.seek(SeekFrom::Start(offset)).map_err(io_error(&self.path))?;
        Ok(BufReader::new(file))
    }

    /// Like [`reader`](Self::reader), for callers that need to own a file: returns another handle of the same open file.
    ///
    /// # Errors
    /// [`VolumeError::Io`].
    pub fn owned_reader(&self) -> Result<BufReader<File>, VolumeError> {
        self.reader()?;
        Ok(BufReader::new(self.handle()?))
    }

    /// Another handle of the same open file, at the same position.
    pub(crate) fn handle(&self) -> Result<File, VolumeError> {
        // WASI has no second handles of open files: the file is opened again, and begins at the first byte.
        #[cfg(target_os = "wasi")]
        let handle = File::open(&self.path);
        #[cfg(not(target_os = "wasi"))]
        let handle = self.file.try_clone();
        handle.map_err(io_error(&self.path))
    }

    /// Returns a reader at the first byte, which unpacks a file that is compressed with gzip; and what is known about the number
    /// of bytes.
    pub(crate) fn unpacked(&self) -> Result<(Box<dyn Read + '_>, Length), VolumeError> {
        let reader = self.reader()?;
        Ok(if is_gzip(&self.start) {
            (Box::new(Gunzip::new(&self.path, reader)), Length::of_gzip(self.length))
        } else {
            (Box::new(reader), Length::Exactly(self.length))
        })
    }
    /// The first bytes of the content of a gzip stream, up to `count`, and the error that ended it.
    pub(crate) fn start_unpacked(
        &self,
        count: u64,
    ) -> Result<(Vec<u8>, Option<io::Error>), VolumeError> {
        let mut start = Vec::new();
        let read = Gunzip::quiet(self.reader()?).take(count).read_to_end(&mut start);
        Ok((start, read.err()))
    }
}
