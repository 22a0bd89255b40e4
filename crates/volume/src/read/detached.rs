use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use walpha_base::Monitor;
use walpha_base::advice::Advise;
use walpha_base::shown::shown;

use super::layout::Layout;
use crate::error::{format_error, io_error};
use crate::{Reason, Volume, VolumeError};

/// The files that a header names, relative to its folder; they may be anywhere.
pub(super) fn data_paths(header: &Path, names: &[String]) -> Vec<PathBuf> {
    let folder = header.parent().unwrap_or(Path::new(""));
    names.iter().map(|name| folder.join(name)).collect()
}

/// The files of a numbered sequence; `None` if the words do not describe one.
pub(super) fn numbered(words: &[impl AsRef<str>]) -> Option<Result<Vec<String>, Reason>> {
    /// The largest number of files of a sequence, which has at most one file for each slice.
    const MAX_FILES: i64 = 1 << 20;
    let words: Vec<&str> = words.iter().map(AsRef::as_ref).collect();
    let &[pattern, first, last, step, ..] = &words[..] else { return None };
    let (before, rest) = pattern.split_once('%')?;
    let (width, after) = rest.split_once('d')?;
    let zeros = width.starts_with('0');
    let width: usize = if width.is_empty() { 0 } else { width.parse().ok()? };
    let [first, last, step] = [first, last, step].map(|number| number.parse::<i32>().ok());
    let (first, last, step) = (i64::from(first?), i64::from(last?), i64::from(step?));
    if step == 0 || (last - first) / step < 0 || (last - first) / step >= MAX_FILES || width > 20 {
        return Some(Err(Reason::header(format!(
            "numbers its data files {}, which is not a valid sequence",
            words.join(" ")
        ))));
    }
    let name = |i: i64| {
        let number = first + i * step;
        let number = if zeros { format!("{number:0width$}") } else { format!("{number:width$}") };
        format!("{before}{number}{after}")
    };
    Some(Ok((0..=(last - first) / step).map(name).collect()))
}

/// Reads the volume that a header describes from these files. `skip` returns how many bytes to skip in a file of a given length.
pub(super) fn read(
    header: &Path,
    layout: Layout,
    files: &[PathBuf],
    skip: impl Fn(u64) -> u64,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let source = Detached::new(files, skip)?;
    let bytes = source.bytes;
    layout.read(header, source, bytes, monitor).map_err(naming(header, files))
}

/// Converts errors about samples in files separate from their header, so that they name both.
pub(crate) fn naming<'a>(
    header: &'a Path,
    files: &'a [PathBuf],
) -> impl Fn(VolumeError) -> VolumeError + 'a {
    let first = files.first().map_or(String::new(), |file| shown(file));
    let place = match files {
        [.., last] if files.len() > 1 => format!("{first} to {}", shown(last)),
        _ => first,
    };
    move |error| {
        let reason = match error {
            VolumeError::Format { reason, .. } => reason,
            VolumeError::Io { .. } | VolumeError::InFile { .. } | VolumeError::Cancelled(_) => {
                return error;
            }
            other => Reason::content(
                other.to_string(),
                other.advice().unwrap_or_else(|| "correct the header".into()),
            ),
        };
        let (part, reason) = (format!("(samples in {place})"), Box::new(reason));
        format_error(header, Reason::Within { part, reason })
    }
}

/// The samples in files separate from their header: these files one after the other, each without its first bytes. One file is
/// open at a time.
#[derive(Debug)]
struct Detached {
    /// The files that are not read yet, and the number of bytes to skip in each.
    files: VecDeque<(PathBuf, u64)>,
    current: Option<(PathBuf, File)>,
    /// The number of bytes in all files, without those that are skipped.
    bytes: u64,
}

impl Detached {
    fn new(files: &[PathBuf], skip: impl Fn(u64) -> u64) -> Result<Self, VolumeError> {
        let mut detached = Self { files: VecDeque::new(), current: None, bytes: 0 };
        for path in files {
            let file = std::fs::metadata(path).map_err(io_error(path))?;
            if file.is_dir() {
                return Err(io_error(path)(io::ErrorKind::IsADirectory.into()));
            }
            let skip = skip(file.len());
            detached.bytes += file.len().saturating_sub(skip);
            detached.files.push_back((path.clone(), skip));
        }
        Ok(detached)
    }
}

impl Read for Detached {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        // The caller knows only the name of the header.
        let named = |path: &Path, error: io::Error| {
            io::Error::new(error.kind(), format!("{}: {error}", shown(path)))
        };
        loop {
            if let Some((path, file)) = &mut self.current {
                let found = file.read(buffer).map_err(|error| named(path, error))?;
                if found > 0 || buffer.is_empty() {
                    return Ok(found);
                }
            }
            let Some((path, skip)) = self.files.pop_front() else { return Ok(0) };
            let mut file = File::open(&path).map_err(|error| named(&path, error))?;
            file.seek(SeekFrom::Start(skip)).map_err(|error| named(&path, error))?;
            self.current = Some((path, file));
        }
    }
}
