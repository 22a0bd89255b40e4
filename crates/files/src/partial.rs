//! Files and folders that are not complete yet, next to those that they are to become.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::destination::Destination;
use crate::unfinished::{Gate, Temporary};

/// A temporary file to be filled.
#[derive(Debug)]
pub(super) struct PartialFile {
    file: File,
    whole: Whole,
}

/// A complete file that waits to be put in its place.
#[derive(Debug)]
pub(super) struct Whole {
    temporary: Temporary,
    place: Destination,
    way: Way,
}

/// How a file gets into its place.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    /// At once, for all who look.
    Renamed,
    /// Byte by byte into the existing file, which has other names, an owner we cannot give
    /// away to, or a list of who may read it: a new file under this name would be another file.
    #[cfg_attr(not(unix), expect(dead_code, reason = "only Unix has these"))]
    Copied,
}

impl PartialFile {
    pub(super) fn beside(place: Destination) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".walpha-").suffix(".part");
        let private = place.existing.is_some();
        let create = |path: &Path| create(path, private);
        let (file, temporary) = Temporary::make(&builder, place.folder(), create)?;
        let way = match &place.existing {
            Some(existing) => way(&file, existing, &place)?,
            None => Way::Renamed,
        };
        Ok(Self { file, whole: Whole { temporary, place, way } })
    }

    /// Fills the file and closes it; says how many bytes it has.
    pub(super) fn fill(
        self,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<(Whole, u64)> {
        let Self { file, whole } = self;
        // The file itself: its errors do not name it.
        let mut buffered = BufWriter::new(file);
        content(&mut buffered)?;
        buffered.flush()?;
        let bytes = buffered.get_ref().metadata()?.len();
        Ok((whole, bytes))
    }
}

impl Whole {
    /// Gives the file its name. The gate is held, so that an interrupt waits.
    pub(super) fn put(&mut self, gate: &Gate) -> io::Result<()> {
        let Some(temporary) = self.temporary.take() else { return Ok(()) };
        match self.way {
            Way::Renamed => temporary.persist(&self.place.path).map_err(|refused| refused.error)?,
            Way::Copied => overwrite(
                &mut OpenOptions::new().write(true).open(&self.place.path)?,
                &mut File::open(&temporary)?,
            )?,
        }
        self.temporary.settle(gate);
        Ok(())
    }
}

/// A folder beside the one it is to become. Dropped before it is put there, it goes with all that is in it.
#[derive(Debug)]
pub(super) struct PartialFolder(Option<PathBuf>);

impl PartialFolder {
    pub(super) fn of(path: PathBuf) -> Self {
        Self(Some(path))
    }

    /// Gives the folder its name.
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
            // The error reported is an earlier one.
            let _ = fs::remove_dir_all(part);
        }
    }
}

/// Puts new content into a file. What could fail for want of room comes first and is undone then.
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

/// A new file. One that replaces another is private until it has the permissions of that one.
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

/// Makes a file like the one it is to replace, or says that it cannot be.
#[cfg(unix)]
fn way(file: &File, existing: &Metadata, place: &Destination) -> io::Result<Way> {
    use std::fs::Permissions;
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let ours = file.metadata()?;
    let (user, group) = (existing.uid(), existing.gid());
    let same_owner = (ours.uid(), ours.gid()) == (user, group);
    if existing.nlink() > 1
        || has_access_list(&place.path)
        || !same_owner && fchown(file, Some(user), Some(group)).is_err()
    {
        return Ok(Way::Copied);
    }
    file.set_permissions(Permissions::from_mode(existing.mode() & 0o777))?;
    Ok(Way::Renamed)
}

#[cfg(not(unix))]
fn way(_: &File, _: &Metadata, _: &Destination) -> io::Result<Way> {
    Ok(Way::Renamed)
}

/// Whether more is said of who may read a file than by its mode.
#[cfg(target_os = "linux")]
fn has_access_list(path: &Path) -> bool {
    let mut no_room: [u8; 0] = [];
    rustix::fs::getxattr(path, "system.posix_acl_access", &mut no_room).is_ok()
}

#[cfg(all(unix, not(target_os = "linux")))]
fn has_access_list(_: &Path) -> bool {
    false
}
