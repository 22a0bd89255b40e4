use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::part::Part;

/// A file to be: opened before the long work, so that a bad place is known at once, and put under
/// its name only when it is complete. Dropped before that, it leaves nothing behind.
///
/// `-` is standard output. That, and what is no ordinary file (a pipe, a device), is written to as it
/// comes.
#[derive(Debug)]
pub struct Target {
    path: PathBuf,
    sink: Sink,
}

#[derive(Debug)]
enum Sink {
    Part(Part),
    Stream,
}

/// A file cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}; nothing was left behind, choose a place with room that you may write to", path.display())]
pub struct TargetError {
    path: PathBuf,
    source: io::Error,
}

impl Target {
    /// The path that is standard output.
    pub const STDOUT: &str = "-";

    /// Opens a temporary file in the folder of `path`.
    ///
    /// # Errors
    /// When the folder does not exist or cannot be written, or `path` is a folder itself.
    pub fn open(path: &Path) -> Result<Self, TargetError> {
        let named = |source| TargetError { path: path.to_owned(), source };
        if path.is_dir() {
            return Err(named(io::Error::from(io::ErrorKind::IsADirectory)));
        }
        let stream = path == Path::new(Self::STDOUT) || (path.exists() && !path.is_file());
        let sink =
            if stream { Sink::Stream } else { Sink::Part(Part::beside(path).map_err(named)?) };
        Ok(Self { path: path.to_owned(), sink })
    }

    /// Where the file will stand.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the content and puts the file in its place, replacing what stood there.
    ///
    /// # Errors
    /// What the system said, with the path; the place is then as it was, unless it is a stream.
    pub fn write(
        self,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), TargetError> {
        let Self { path, sink } = self;
        let written = match sink {
            Sink::Part(part) => part.fill(content).and_then(|part| part.put(&path)),
            Sink::Stream if path == Path::new(Self::STDOUT) => {
                through(io::stdout().lock(), content)
            }
            Sink::Stream => std::fs::OpenOptions::new()
                .write(true)
                .open(&path)
                .and_then(|stream| through(stream, content)),
        };
        written.map_err(|source| TargetError { path, source })
    }
}

fn through(
    stream: impl Write,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut buffered = BufWriter::new(stream);
    content(&mut buffered)?;
    buffered.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_names_the_file_and_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("shape.ply");
        let target = Target::open(&path).unwrap();
        let error = target.write(|_| Err(io::ErrorKind::StorageFull.into())).unwrap_err();
        let text = error.to_string();
        assert!(text.contains("shape.ply") && !text.contains(".part"), "{text}");
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
        let source = std::error::Error::source(&error).unwrap();
        let kind = source.downcast_ref::<io::Error>().unwrap().kind();
        assert_eq!(kind, io::ErrorKind::StorageFull);
    }

    #[test]
    fn a_place_that_cannot_be_is_known_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let text = Target::open(&folder.path().join("no/a.ply")).unwrap_err().to_string();
        assert!(text.contains("no/a.ply") && !text.contains(".part"), "{text}");
        assert!(Target::open(folder.path()).unwrap_err().to_string().contains("directory"));
    }
}
