//! Files and folders that are not complete yet, in the folder of their destination.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::destination::Destination;
use crate::target::Content;
use crate::unfinished::{Gate, Temporary};

const PREFIX: &str = ".walpha-";
const SUFFIX: &str = ".part";

/// A temporary file to be filled.
#[derive(Debug)]
pub(super) struct PartialFile {
    file: File,
    whole: CompleteFile,
}

/// A complete file that has not been moved to its destination yet.
#[derive(Debug)]
pub(super) struct CompleteFile {
    temporary: Temporary,
    destination: Destination,
    method: Method,
}

/// How a file gets to its destination.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Method {
    /// It is renamed, which is atomic.
    Renamed,
    /// Its bytes are copied into the existing file, which has other names, an owner to whom we cannot give a file, or an access
    /// control list. A new file under this name would be another file.
    #[cfg_attr(not(unix), expect(dead_code, reason = "only Unix has these"))]
    Copied,
}

impl PartialFile {
    pub(super) fn for_destination(destination: Destination) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX).suffix(SUFFIX);
        let private = destination.existing.is_some();
        let create = |path: &Path| create(path, private);
        let (file, temporary) = Temporary::make(&builder, destination.folder(), create)?;
        let method = match &destination.existing {
            Some(existing) => method(&file, existing, &destination)?,
            None => Method::Renamed,
        };
        Ok(Self { file, whole: CompleteFile { temporary, destination, method } })
    }

    /// Fills the file and closes it. Also returns its number of bytes.
    pub(super) fn fill(self, content: Content<'_>) -> io::Result<(CompleteFile, u64)> {
        let Self { file, whole } = self;
        // The file itself is wrapped, as its errors do not contain its name.
        let mut buffered = BufWriter::new(file);
        content(&mut buffered)?;
        buffered.flush()?;
        let bytes = buffered.get_ref().metadata()?.len();
        Ok((whole, bytes))
    }
}

impl CompleteFile {
    /// Moves the file to its destination. The gate is locked, so that an interrupt waits.
    pub(super) fn put(&mut self, gate: &Gate) -> io::Result<()> {
        let Some(temporary) = self.temporary.take() else { return Ok(()) };
        match self.method {
            Method::Renamed => {
                temporary.persist(&self.destination.path).map_err(|refused| refused.error)?;
            }
            Method::Copied => overwrite(
                &mut OpenOptions::new().write(true).open(&self.destination.path)?,
                &mut File::open(&temporary)?,
            )?,
        }
        self.temporary.finish(gate);
        Ok(())
    }
}

/// A temporary folder. If it is dropped before it is renamed, it is removed with its contents.
#[derive(Debug)]
pub(super) struct PartialFolder(Option<PathBuf>);

impl PartialFolder {
    pub(super) fn of(path: PathBuf) -> Self {
        Self(Some(path))
    }

    /// Renames the folder.
    pub(super) fn put(&mut self, path: &Path) -> io::Result<()> {
        let Some(part) = &self.0 else { return Ok(()) };
        fs::rename(part, path)?;
        self.0 = None;
        Ok(())
    }
}

impl Drop for PartialFolder {
    fn drop(&mut self) {
        if let Some(part) = &self.0 {
            // This error is not reported: an earlier one is.
            let _ = fs::remove_dir_all(part);
        }
    }
}

/// Removes the incomplete files that processes left in a folder when they were killed. No process may be writing there.
///
/// # Errors
/// The folder cannot be read, or a file cannot be removed.
pub fn remove_parts(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        let name = name.as_encoded_bytes();
        let is_part = name.starts_with(PREFIX.as_bytes()) && name.ends_with(SUFFIX.as_bytes());
        if is_part && entry.file_type()?.is_file() {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// Replaces the content of a file. The step that could fail for lack of space comes first, and is undone if it does.
fn overwrite(file: &mut File, content: &mut File) -> io::Result<()> {
    let (old, new) = (file.metadata()?.len(), content.metadata()?.len());
    if new > old {
        content.seek(SeekFrom::Start(old))?;
        file.seek(SeekFrom::Start(old))?;
        if let Err(error) = io::copy(content, file) {
            file.set_len(old)?;
            return Err(error);
        }
    }
    content.rewind()?;
    file.rewind()?;
    io::copy(&mut content.take(old), file)?;
    file.set_len(new)
}

/// Creates a file. A file that replaces another is private until it gets its permissions.
#[cfg(unix)]
fn create(path: &Path, private: bool) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    let mode = if private { 0o600 } else { 0o666 };
    OpenOptions::new().write(true).create_new(true).mode(mode).open(path)
}

#[cfg(not(unix))]
fn create(path: &Path, _: bool) -> io::Result<File> {
    OpenOptions::new().write(true).create_new(true).open(path)
}

/// Gives a file the owner and permissions of the one it replaces, if that is possible, and chooses the method.
#[cfg(unix)]
fn method(file: &File, existing: &Metadata, destination: &Destination) -> io::Result<Method> {
    use std::fs::Permissions;
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let ours = file.metadata()?;
    let (user, group) = (existing.uid(), existing.gid());
    let same_owner = (ours.uid(), ours.gid()) == (user, group);
    if existing.nlink() > 1
        || has_access_list(&destination.path)
        || !same_owner && fchown(file, Some(user), Some(group)).is_err()
    {
        return Ok(Method::Copied);
    }
    file.set_permissions(Permissions::from_mode(existing.mode() & 0o777))?;
    Ok(Method::Renamed)
}

#[cfg(not(unix))]
fn method(_: &File, _: &Metadata, _: &Destination) -> io::Result<Method> {
    Ok(Method::Renamed)
}

/// Whether a file has an access control list besides its mode.
#[cfg(target_os = "linux")]
fn has_access_list(path: &Path) -> bool {
    let mut empty: [u8; 0] = [];
    rustix::fs::getxattr(path, "system.posix_acl_access", &mut empty).is_ok()
}

#[cfg(all(unix, not(target_os = "linux")))]
fn has_access_list(_: &Path) -> bool {
    false
}
