//! Volumes at hand without a file of one's own.

mod phantom;
mod skull;

use std::path::Path;

pub(super) use phantom::PhantomBoxes;
pub use phantom::phantom;

use walpha_base::Monitor;
use walpha_base::advice::Advice;
use walpha_base::near::nearest;

use super::{Frame, ReadOptions, Volume, VolumeError, read_monitored};

/// The samples there are, as a user writes them.
pub const SAMPLES: [&str; 3] = ["sample:skull", "sample:phantom", "sample:phantom@N"];
/// Samples along each axis of the phantom unless `@N` says otherwise: as many as the skull has.
const PHANTOM_SIZE: u64 = 64;

/// Opens what a user names: a sample, or else a file.
///
/// # Errors
/// Those of [`sample`] and [`read()`](super::read()).
pub fn open(input: impl AsRef<Path>, options: &ReadOptions) -> Result<Volume, VolumeError> {
    open_monitored(input, options, &Monitor::noop())
}

/// The same, which says how far it is and can be cancelled.
///
/// # Errors
/// Those of [`open`], and [`VolumeError::Cancelled`].
pub fn open_monitored(
    input: impl AsRef<Path>,
    options: &ReadOptions,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let input = input.as_ref();
    match input.to_str() {
        Some(name) if name.starts_with("sample:") => options.part(sample(name)?),
        _ => read_monitored(input, options, monitor),
    }
}

/// A sample by its name: one of [`SAMPLES`].
///
/// `sample:skull` is `skull_2.9.inr` of CGAL's own data, 64³ samples of a CT scan, read in place;
/// `sample:phantom` is a [`phantom`] of 64³ samples, `sample:phantom@N` one of N³.
///
/// # Errors
/// Unknown name; the skull is not installed, or its archive is damaged; N is not a size.
pub fn sample(name: &str) -> Result<Volume, VolumeError> {
    match name.strip_prefix("sample:") {
        // Its header has numbers, but the paper's lengths are voxels.
        Some("skull") => Ok(skull::skull()?.settled(None)?.with_frame(Frame::VOXEL)),
        Some("phantom") => phantom(PHANTOM_SIZE),
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
    VolumeError::UnknownSample { name: name.into(), advice }
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
    fn inputs_are_samples_or_files() {
        let volume = open("sample:phantom@5", &ReadOptions::default()).unwrap();
        assert_eq!(volume.dims().xyz(), [5, 5, 5]);
        let error = open("no/such.inr", &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("no/such.inr"), "{error}");
        assert!(error.advice().unwrap().to_string().contains("sample:phantom"));
    }
}
