use std::fs::OpenOptions;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::destination::{Claim, Destination};
use crate::error::TargetError;
use crate::filled::{Filled, put_all};
use crate::identity::{Key, STDOUT};
use crate::inputs;
use crate::partial::{CompleteFile, PartialFile};

/// A future file. It is opened before the long work, so that a bad destination is reported at once, and moved to its name only
/// when it is complete. If it is dropped before that, it leaves nothing behind.
///
/// A file of this name is replaced, and the new file has its mode and owner. Links are followed. A file that has other names, or
/// whose owner cannot be kept, is not replaced but overwritten once all of the new content is on the disk; only this case is not
/// atomic. No two targets are open for one file at the same time.
///
/// `-` is standard output. It and everything else that is not an ordinary file (a pipe, a device) are written
/// directly.
#[derive(Debug)]
pub struct Target {
    path: PathBuf,
    sink: Sink,
    /// `None` for a device, which several targets may write to.
    claim: Option<Claim>,
}

#[derive(Debug)]
enum Sink {
    PartialFile(Box<PartialFile>),
    Device,
    Stdout,
}

/// Writes the content of a file.
pub type Content<'a> = Box<dyn FnOnce(&mut dyn Write) -> io::Result<()> + 'a>;

impl Target {
    /// The path that means standard output.
    pub const STDOUT: &str = STDOUT;

    /// Opens a temporary file in the folder of `path`.
    ///
    /// # Errors
    /// The folder does not exist or cannot be written to; `path` is a folder itself or a write-protected file; its name is too
    /// long; or a target of the same file is open.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, TargetError> {
        let path = path.as_ref();
        Self::sink(path)
            .map(|(sink, claim)| Self { path: path.to_owned(), sink, claim })
            .map_err(TargetError::of(path, ""))
    }

    /// Like [`open`](Self::open), for a file of a folder that others may write to, too. Whatever has this name is replaced,
    /// except a folder. Links are not followed, so that nothing outside the folder changes.
    ///
    /// # Errors
    /// See [`open`](Self::open).
    pub fn replacing(path: impl AsRef<Path>) -> Result<Self, TargetError> {
        let path = path.as_ref();
        Destination::replacing(path)
            .and_then(Self::of_file)
            .map(|(sink, claim)| Self { path: path.to_owned(), sink, claim })
            .map_err(TargetError::of(path, ""))
    }

    fn sink(path: &Path) -> io::Result<(Sink, Option<Claim>)> {
        if path == Path::new(Self::STDOUT) {
            walpha_base::standard_output::check()?;
            return Ok((Sink::Stdout, Some(Claim::of_stdout()?)));
        }
        let destination = Destination::of(path)?;
        if destination.is_stream() {
            return Ok((Sink::Device, None));
        }
        Self::of_file(destination)
    }

    fn of_file(destination: Destination) -> io::Result<(Sink, Option<Claim>)> {
        let claim = Claim::of(&destination)?;
        Ok((Sink::PartialFile(PartialFile::for_destination(destination)?.into()), Some(claim)))
    }

    /// Checks, as [`open`](Self::open) does, that a destination is neither an input nor in a working folder. The destination may
    /// be a folder.
    ///
    /// # Errors
    /// The destination is an input, or in a working folder.
    pub fn check(path: &Path) -> Result<(), TargetError> {
        // Nothing is read from a folder that does not exist.
        let checked = Key::of(path).map_or(Ok(()), |key| inputs::check(&key));
        checked.map_err(TargetError::of(path, ""))
    }

    /// The path of the future file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the content and moves the file to its destination, replacing what was there.
    ///
    /// # Errors
    /// Errors of the file system, with the path. The destination is then unchanged, unless it is a stream.
    pub fn write(
        self,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), TargetError> {
        put_all(vec![self.fill(content)?])
    }

    /// Writes the content, but leaves the destination unchanged until [`put_all`]. A stream is written now.
    ///
    /// # Errors
    /// Errors of the file system, with the path.
    pub fn fill(
        self,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<Filled, TargetError> {
        self.fill_with(Box::new(content))
    }

    /// Compiled once for all contents.
    fn fill_with(self, content: Content<'_>) -> Result<Filled, TargetError> {
        let Self { path, sink, claim } = self;
        let (filled, left) = match sink {
            Sink::PartialFile(part) => (
                part.fill(content).map(|(whole, bytes)| (Some(whole), bytes)),
                TargetError::NOTHING_LEFT,
            ),
            Sink::Stdout => (write_stream(io::stdout().lock(), content), ""),
            Sink::Device => {
                let device = OpenOptions::new().write(true).open(&path);
                (device.and_then(|device| write_stream(device, content)), "")
            }
        };
        let (whole, bytes) = filled.map_err(TargetError::of(&path, left))?;
        Ok(match whole {
            Some(whole) => Filled::file(path, whole, bytes, claim),
            None => Filled::stream(path, claim),
        })
    }
}

/// Writes all of several files or none of them, and then the streams, whose readers may close them early.
///
/// # Errors
/// Errors of the file system for the first file that cannot be written.
pub fn write_all<'a>(
    files: impl IntoIterator<Item = (Target, Content<'a>)>,
) -> Result<(), TargetError> {
    fill_all(files)?.put(Vec::new())
}

/// Outputs whose files are complete but not at their destinations yet.
pub struct FilledAll<'a> {
    files: Vec<Filled>,
    streams: Vec<(Target, Content<'a>)>,
}

/// Fills all files. Streams are written once the files are at their destinations.
///
/// # Errors
/// [`TargetError`].
pub fn fill_all<'a>(
    files: impl IntoIterator<Item = (Target, Content<'a>)>,
) -> Result<FilledAll<'a>, TargetError> {
    let is_part = |(target, _): &(Target, Content<'_>)| matches!(target.sink, Sink::PartialFile(_));
    let (files, streams): (Vec<_>, Vec<_>) = files.into_iter().partition(is_part);
    let filled = files.into_iter().map(|(target, content)| target.fill(content));
    Ok(FilledAll { files: filled.collect::<Result<_, _>>()?, streams })
}

impl FilledAll<'_> {
    /// Moves all files to their destinations, after others that are complete, and writes the streams.
    ///
    /// # Errors
    /// [`TargetError`].
    pub fn put(self, mut others: Vec<Filled>) -> Result<(), TargetError> {
        others.extend(self.files);
        put_all(others)?;
        self.streams.into_iter().try_for_each(|(target, content)| target.write(content))
    }
}

fn write_stream(
    stream: impl Write,
    content: Content<'_>,
) -> io::Result<(Option<CompleteFile>, u64)> {
    let mut buffered = BufWriter::new(stream);
    content(&mut buffered)?;
    buffered.flush()?;
    Ok((None, 0))
}

#[cfg(test)]
mod tests {
    use std::io::ErrorKind;

    use walpha_base::advice::Advise;

    use super::*;

    #[test]
    fn a_full_disk_names_the_file_and_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("shape.ply");
        let target = Target::open(&path).unwrap();
        let error = target.write(|_| Err(ErrorKind::StorageFull.into())).unwrap_err();
        let text = format!("{error}; {}", error.advice().unwrap());
        assert!(text.contains("shape.ply") && !text.contains(".part"), "{text}");
        assert!(
            text.contains("nothing was left behind, choose a disk with enough space"),
            "{text}"
        );
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
    }

    #[test]
    fn a_stream_that_takes_nothing_says_so() {
        let path = Path::new("/dev/full");
        if !path.exists() {
            return;
        }
        let target = Target::open(path).unwrap();
        let error = target.write(|out| out.write_all(b"text")).unwrap_err();
        assert!(!error.to_string().contains("left behind"), "who knows: {error}");
        let source = std::error::Error::source(&error).unwrap();
        let kind = source.downcast_ref::<io::Error>().unwrap().kind();
        assert_eq!(kind, ErrorKind::StorageFull);
    }

    #[test]
    fn an_impossible_path_is_refused_on_open() {
        let folder = tempfile::tempdir().unwrap();
        let said = |name: &str| {
            let error = Target::open(folder.path().join(name)).unwrap_err();
            format!("{error}; {}", error.advice().unwrap())
        };
        let text = said("no/a.ply");
        assert!(
            text.contains("no/a.ply: there is no folder") && text.contains("create the folder"),
            "{text}"
        );
        assert!(said(".").contains("directory"));
        let text = said(&format!("{}.ply", "a".repeat(400)));
        assert!(text.contains("too long") && text.contains("shorter"), "{text}");
    }

    #[test]
    fn all_files_or_none() {
        let folder = tempfile::tempdir().unwrap();
        let open = |name: &str| Target::open(folder.path().join(name)).unwrap();
        let good = |out: &mut dyn Write| out.write_all(b"text");
        let bad = |_: &mut dyn Write| Err(ErrorKind::StorageFull.into());
        let files: Vec<(_, Content<'_>)> =
            vec![(open("a"), Box::new(good)), (open("b"), Box::new(bad))];
        assert!(write_all(files).is_err());
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
        let files: Vec<(_, Content<'_>)> =
            vec![(open("a"), Box::new(good)), (open("b"), Box::new(good))];
        write_all(files).unwrap();
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 2);
    }

    #[test]
    fn what_a_killed_process_leaves_can_be_removed() {
        let folder = tempfile::tempdir().unwrap();
        let target = Target::open(folder.path().join("a")).unwrap();
        // As if it were killed before the file is moved.
        std::mem::forget(target.fill(|out| out.write_all(b"half")).unwrap());
        std::fs::write(folder.path().join(".walpha-notes"), "").unwrap();
        let names = || {
            let entries = std::fs::read_dir(&folder).unwrap();
            entries.map(|entry| entry.unwrap().file_name()).collect::<Vec<_>>()
        };
        assert_eq!(names().len(), 2);
        crate::remove_parts(folder.path()).unwrap();
        assert_eq!(names(), [".walpha-notes"]);
    }

    /// They are as many files after they are written.
    #[cfg(unix)]
    #[test]
    fn links_to_one_file_are_replaced_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("precious"), "PRECIOUS").unwrap();
        for name in ["a", "b"] {
            std::os::unix::fs::symlink("precious", at(name)).unwrap();
        }
        let followed = Target::open(at("a")).unwrap();
        let error = Target::open(at("b")).unwrap_err();
        assert!(std::error::Error::source(&error).unwrap().to_string().contains("too"), "{error}");
        drop(followed);
        let both = ["a", "b"].map(|name| Target::replacing(at(name)).unwrap());
        assert!(Target::replacing(at("a")).is_err());
        both.into_iter().for_each(|target| target.write(|out| out.write_all(b"text")).unwrap());
        assert_eq!(std::fs::read(at("precious")).unwrap(), b"PRECIOUS");
        assert_eq!(std::fs::read(at("b")).unwrap(), b"text");
    }
}
