use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use flate2::read::GzDecoder;
use walpha_base::Monitor;
use walpha_base::shown::shown;

use crate::read::{Length, OpenFile, inr, io_error};
use crate::{Reason, Volume, VolumeError};

/// Where Debian and Ubuntu put CGAL's data, in the package `libcgal-demo`.
const ARCHIVE: &str = "/usr/share/doc/libcgal-dev/data.tar.gz";
/// The skull in that archive, and below CGAL's data directory.
const MEMBER: &str = "data/images/skull_2.9.inr";
const FILE: &str = "images/skull_2.9.inr";

/// The skull from `CGAL_DATA_DIR`, the variable CGAL's own programs look at, or from Debian's
/// archive, without unpacking it to disk.
pub(super) fn skull() -> Result<Volume, VolumeError> {
    find(std::env::var_os("CGAL_DATA_DIR").map(PathBuf::from).as_deref(), Path::new(ARCHIVE))
}

fn find(directory: Option<&Path>, archive: &Path) -> Result<Volume, VolumeError> {
    if let Some(file) = directory.map(|d| d.join(FILE)).filter(|f| f.exists()) {
        inr::open(&OpenFile::open(&file)?, &Monitor::noop())
    } else if archive.exists() {
        from_archive(archive)
    } else {
        let sought = format!(
            "below CGAL_DATA_DIR ({}) as {FILE}, and in {}",
            directory.map_or("not set".into(), shown),
            shown(archive),
        );
        Err(VolumeError::NoSkull { sought })
    }
}

fn from_archive(path: &Path) -> Result<Volume, VolumeError> {
    let file = File::open(path).map_err(io_error(path))?;
    let mut archive = tar::Archive::new(GzDecoder::new(BufReader::new(file)));
    for entry in archive.entries().map_err(io_error(path))? {
        let entry = entry.map_err(io_error(path))?;
        if entry.path().is_ok_and(|p| p.ends_with(MEMBER)) {
            let length = Length::Exactly(entry.size());
            return inr::read(&path.join(MEMBER), entry, length, &Monitor::noop());
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
    use super::*;

    #[test]
    fn a_missing_skull_says_how_to_get_it() {
        let nowhere = Path::new("/nonexistent");
        let error = find(Some(nowhere), &nowhere.join("data.tar.gz")).unwrap_err();
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

        let from_folder = find(Some(folder.path()), Path::new("/nonexistent")).unwrap();
        assert_eq!(from_folder.as_slice(), [1.5, -2.0]);
        assert_eq!(find(None, &archive).unwrap(), from_folder);
    }
}
