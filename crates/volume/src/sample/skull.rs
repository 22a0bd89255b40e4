//! The skull in CGAL's data: where it is found, and its checksum.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use flate2::read::GzDecoder;
use sha2::{Digest, Sha256};
use walpha_base::Monitor;
use walpha_base::shown::shown;

use crate::error::io_error;
use crate::read::{Length, OpenFile, inr};
use crate::{Reason, Volume, VolumeError};

/// The archive of CGAL's data in Debian's and Ubuntu's package `libcgal-demo`.
const ARCHIVE: &str = "/usr/share/doc/libcgal-dev/data.tar.gz";
/// The path of the skull in that archive, and below CGAL's data directory.
const MEMBER: &str = "data/images/skull_2.9.inr";
const FILE: &str = "images/skull_2.9.inr";

/// The SHA-256 of `skull_2.9.inr` in CGAL 5.5.
pub const SKULL_SHA256: &str = "7a9147c819e426fbd7bf4f0ed5ddac799e54376f64260ef4f650f29e3aa5d4c4";

/// Reads the skull from `CGAL_DATA_DIR`, the variable of CGAL's own programs, or from Debian's archive, without unpacking it to
/// disk.
pub(super) fn skull() -> Result<Volume, VolumeError> {
    Found::installed()?.read()
}

/// The SHA-256 of the file that `sample:skull` reads, in hexadecimal. It is [`SKULL_SHA256`] if the file is CGAL's.
///
/// # Errors
/// The skull is not installed, or cannot be read.
pub fn skull_sha256() -> Result<String, VolumeError> {
    Found::installed()?.sha256()
}

/// A file or archive that contains the skull.
enum Found {
    File(PathBuf),
    Archive(PathBuf),
}

impl Found {
    fn installed() -> Result<Self, VolumeError> {
        let directory = std::env::var_os("CGAL_DATA_DIR").map(PathBuf::from);
        Self::find(directory.as_deref(), Path::new(ARCHIVE))
    }

    fn find(directory: Option<&Path>, archive: &Path) -> Result<Self, VolumeError> {
        if let Some(file) = directory.map(|d| d.join(FILE)).filter(|f| f.exists()) {
            Ok(Self::File(file))
        } else if archive.exists() {
            Ok(Self::Archive(archive.into()))
        } else {
            let sought = format!(
                "below CGAL_DATA_DIR ({}) as {FILE}, and in {}",
                directory.map_or("not set".into(), shown),
                shown(archive),
            );
            Err(VolumeError::NoSkull { sought })
        }
    }

    fn read(&self) -> Result<Volume, VolumeError> {
        match self {
            Self::File(file) => inr::open(&OpenFile::open(file)?, &Monitor::noop()),
            Self::Archive(archive) => in_archive(archive, |entry, size| {
                let length = Length::Exactly(size);
                inr::read(&archive.join(MEMBER), entry, length, &Monitor::noop())
            }),
        }
    }

    fn sha256(&self) -> Result<String, VolumeError> {
        match self {
            Self::File(path) => {
                File::open(path).and_then(|mut file| digest(&mut file)).map_err(io_error(path))
            }
            Self::Archive(archive) => {
                in_archive(archive, |entry, _| digest(entry).map_err(io_error(archive)))
            }
        }
    }
}

fn digest(bytes: &mut dyn Read) -> io::Result<String> {
    let mut hash = Sha256::new();
    io::copy(bytes, &mut hash)?;
    Ok(hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}

/// Calls `read` with the skull in an archive and its size in bytes.
fn in_archive<T>(
    path: &Path,
    read: impl FnOnce(&mut dyn Read, u64) -> Result<T, VolumeError>,
) -> Result<T, VolumeError> {
    let file = File::open(path).map_err(io_error(path))?;
    let mut archive = tar::Archive::new(GzDecoder::new(BufReader::new(file)));
    for entry in archive.entries().map_err(io_error(path))? {
        let mut entry = entry.map_err(io_error(path))?;
        if entry.path().is_ok_and(|p| p.ends_with(MEMBER)) {
            let size = entry.size();
            return read(&mut entry, size);
        }
    }
    Err(VolumeError::Format {
        path: path.into(),
        reason: Reason::content(
            format!("has no {MEMBER}"),
            "install libcgal-demo again, or use sample:phantom",
        ),
    })
}

#[cfg(test)]
mod tests {
    use walpha_base::advice::Advise;

    use super::*;

    #[test]
    fn a_missing_skull_says_how_to_get_it() {
        let nowhere = Path::new("/nonexistent");
        let Err(error) = Found::find(Some(nowhere), &nowhere.join("data.tar.gz")) else {
            panic!("there is nothing")
        };
        let text = format!("{error}; {}", error.advice().unwrap());
        for part in ["libcgal-demo", "CGAL_DATA_DIR", "sample:phantom", "/nonexistent"] {
            assert!(text.contains(part), "{part} is missing in: {text}");
        }
    }

    #[test]
    fn the_skull_is_read_from_a_folder_and_from_an_archive() {
        let folder = tempfile::tempdir().unwrap();
        let mut image =
            b"#INRIMAGE-4#{\nXDIM=2\nYDIM=1\nZDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=decm\n"
                .to_vec();
        image.resize(252, b'\n');
        image.extend(b"##}\n");
        image.extend([1.5f32, -2.0].iter().flat_map(|v| v.to_le_bytes()));
        let file = folder.path().join(FILE);
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(&file, &image).unwrap();

        let archive = folder.path().join("data.tar.gz");
        let gzip = flate2::write::GzEncoder::new(
            File::create(&archive).unwrap(),
            flate2::Compression::fast(),
        );
        let mut builder = tar::Builder::new(gzip);
        builder.append_path_with_name(&file, MEMBER).unwrap();
        builder.into_inner().unwrap().finish().unwrap();

        let from_folder = Found::find(Some(folder.path()), Path::new("/nonexistent")).unwrap();
        let volume = from_folder.read().unwrap();
        assert_eq!(volume.as_slice(), [1.5, -2.0]);
        let from_archive = Found::find(None, &archive).unwrap();
        assert_eq!(from_archive.read().unwrap(), volume);
        // This checksum was computed by sha256sum.
        let expected = "63c610005658298b7582f67710dfb28995f9b7d3dd33477cff519212ae19297c";
        assert_eq!([from_folder, from_archive].map(|found| found.sha256().unwrap()), [expected; 2]);
    }
}
