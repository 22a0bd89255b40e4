use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::Path;

/// Opens a file of a folder that others may write to, too. Returns `None` if it is not an ordinary file but a link (which might
/// lead anywhere), a folder, a pipe or a device.
///
/// # Errors
/// Errors of the file system.
pub fn open_ordinary(path: &Path) -> io::Result<Option<File>> {
    if !fs::symlink_metadata(path)?.is_file() {
        return Ok(None);
    }
    let mut options = OpenOptions::new();
    options.read(true);
    // It may have been replaced by something else since it was checked.
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        let flags = rustix::fs::OFlags::NOFOLLOW | rustix::fs::OFlags::NONBLOCK;
        options.custom_flags(flags.bits().cast_signed());
    }
    options.open(path).map(Some)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn links_and_folders_are_not_ordinary() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("file"), "a").unwrap();
        std::os::unix::fs::symlink("file", at("link")).unwrap();
        assert!(open_ordinary(&at("file")).unwrap().is_some());
        assert!(open_ordinary(&at("link")).unwrap().is_none());
        assert!(open_ordinary(folder.path()).unwrap().is_none());
        assert_eq!(open_ordinary(&at("none")).unwrap_err().kind(), io::ErrorKind::NotFound);
    }
}
