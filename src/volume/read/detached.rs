use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use super::io_error;
use crate::volume::VolumeError;

/// Samples that stand in other files than their header: these files one after the other, each
/// without its first bytes. One is open at a time.
#[derive(Debug)]
pub(super) struct Detached {
    /// Those still to come, and the bytes to pass over in each.
    files: VecDeque<(PathBuf, u64)>,
    current: Option<File>,
    /// Bytes in all, those skipped left out.
    pub bytes: u64,
}

impl Detached {
    /// Files by their names in a header, which are relative to its folder; `skip` gives how much
    /// of a file of this length is passed over.
    pub fn new(
        header: &Path,
        names: &[String],
        skip: impl Fn(u64) -> u64,
    ) -> Result<Self, VolumeError> {
        let folder = header.parent().unwrap_or(Path::new(""));
        let mut detached = Self { files: VecDeque::new(), current: None, bytes: 0 };
        for name in names {
            let path = folder.join(name);
            let file = std::fs::metadata(&path).map_err(io_error(&path))?;
            if file.is_dir() {
                return Err(io_error(&path)(io::ErrorKind::IsADirectory.into()));
            }
            let skip = skip(file.len());
            detached.bytes += file.len().saturating_sub(skip);
            detached.files.push_back((path, skip));
        }
        Ok(detached)
    }
}

impl Read for Detached {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            if let Some(file) = &mut self.current {
                let found = file.read(buffer)?;
                if found > 0 || buffer.is_empty() {
                    return Ok(found);
                }
            }
            let Some((path, skip)) = self.files.pop_front() else { return Ok(0) };
            let mut file = File::open(&path)?;
            file.seek(SeekFrom::Start(skip))?;
            self.current = Some(file);
        }
    }
}
