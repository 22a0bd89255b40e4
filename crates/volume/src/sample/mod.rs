//! Sample volumes: the skull of CGAL's data, a phantom, and a CT of it.

mod ct;
mod phantom;

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use flate2::read::GzDecoder;
use walpha_base::Monitor;
use walpha_base::advice::Advice;
use walpha_base::near::nearest;
use walpha_base::shown::shown;

pub use ct::ct;
pub(super) use phantom::PhantomBoxes;
pub use phantom::phantom;

use crate::error::io_error;
use crate::read::{Length, OpenFile, inr};
use crate::{Frame, Reason, Volume, VolumeError};

/// The samples there are, as a user writes them.
pub const SAMPLES: [&str; 4] = ["sample:ct", "sample:skull", "sample:phantom", "sample:phantom@N"];
/// Samples along each axis of the phantom unless `@N` says otherwise: as many as the skull has.
const PHANTOM_SIZE: u64 = 64;

/// A sample by its name: one of [`SAMPLES`].
///
/// `sample:skull` is `skull_2.9.inr` of CGAL's own data, 64³ samples of a CT scan, read in place;
/// `sample:phantom` is a [`phantom`] of 64³ samples, `sample:phantom@N` one of N³;
/// `sample:ct` is a [`ct`] of the phantom, in Hounsfield units.
///
/// # Errors
/// Unknown name; the skull is not installed, or its archive is damaged; N is not a size.
pub fn sample(name: &str) -> Result<Volume, VolumeError> {
    match name.strip_prefix("sample:") {
        // Its header has numbers, but the paper's lengths are voxels.
        Some("skull") => Ok(skull()?.resolve_nan(None)?.with_frame(Frame::VOXEL)),
        Some("phantom") => phantom(PHANTOM_SIZE),
        Some("ct") => Ok(ct()),
        Some(other) if other.starts_with("phantom@") => {
            if let Ok(size) = other["phantom@".len()..].parse() {
                phantom(size)
            } else {
                let advice = "give N as a number of samples along each axis, as in @128";
                Err(unknown(name, advice.into()))
            }
        }
        _ => {
            let meant = nearest(name, SAMPLES).map(|near| format!("did you mean {near}?"));
            let advice = meant.map_or("name one of these, or a file".into(), Advice::from);
            Err(unknown(name, advice))
        }
    }
}

fn unknown(name: &str, advice: Advice) -> VolumeError {
    VolumeError::UnknownSample { name: name.into(), known: SAMPLES.join(", "), advice }
}

/// Where Debian and Ubuntu put CGAL's data, in the package `libcgal-demo`.
const ARCHIVE: &str = "/usr/share/doc/libcgal-dev/data.tar.gz";
/// The skull in that archive, and below CGAL's data directory.
const MEMBER: &str = "data/images/skull_2.9.inr";
const FILE: &str = "images/skull_2.9.inr";

/// The skull from `CGAL_DATA_DIR`, the variable CGAL's own programs look at, or from Debian's
/// archive, without unpacking it to disk.
fn skull() -> Result<Volume, VolumeError> {
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
    fn unknown_samples_name_the_known_ones() {
        for name in ["sample:skul", "sample:phantom@", "sample:phantom@-3", "phantom"] {
            let text = sample(name).unwrap_err().to_string();
            assert!(text.contains(name) && text.contains("sample:phantom@N"), "{text}");
        }
        let advice = sample("sample:skul").unwrap_err().advice().unwrap().to_string();
        assert_eq!(advice, "did you mean sample:skull?");
        assert!(matches!(sample("sample:phantom@0"), Err(VolumeError::EmptyAxis { .. })));
        assert!(matches!(sample("sample:phantom@99999"), Err(VolumeError::TooManySamples { .. })));
    }

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
