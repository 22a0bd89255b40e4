//! Sample volumes: the skull of CGAL's data, a phantom, and a CT of it.

mod ct;
mod phantom;
mod skull;

use crate::near::nearest;
use walpha_base::advice::Advice;

pub use ct::ct;
pub(super) use phantom::PhantomBoxes;
pub use phantom::phantom;
use skull::skull;
pub use skull::{SKULL_SHA256, skull_sha256};

use crate::{Frame, Volume, VolumeError};

/// The existing samples, as a user writes them.
pub const SAMPLES: [&str; 4] = ["sample:ct", "sample:skull", "sample:phantom", "sample:phantom@N"];
/// The samples that are points, which the readers of points know.
const POINT_SAMPLES: [&str; 2] = ["sample:peptide", "sample:tile"];
/// The number of samples along each axis of the phantom, unless `@N` says otherwise: as many as the skull has.
const PHANTOM_SIZE: u64 = 64;

/// Returns a sample by its name: one of [`SAMPLES`].
///
/// `sample:skull` is `skull_2.9.inr` of CGAL's own data, 64³ samples of a CT scan, read in place;
/// `sample:phantom` is a [`phantom`] of 64³ samples, `sample:phantom@N` one of N³;
/// `sample:ct` is a [`ct`] of the phantom, in Hounsfield units.
///
/// # Errors
/// The name is unknown; the skull is not installed, or its archive is damaged; N is not a size.
pub fn sample(name: &str) -> Result<Volume, VolumeError> {
    match name.strip_prefix("sample:") {
        // Its header states a spacing, but the paper's lengths are in voxels.
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
            let known = SAMPLES.into_iter().chain(POINT_SAMPLES);
            let meant = nearest(name, known).map(|near| format!("did you mean {near}?"));
            let advice = meant.map_or("name one of these, or a file".into(), Advice::from);
            Err(unknown(name, advice))
        }
    }
}

fn unknown(name: &str, advice: Advice) -> VolumeError {
    let known: Vec<&str> = SAMPLES.into_iter().chain(POINT_SAMPLES).collect();
    VolumeError::UnknownSample { name: name.into(), known: known.join(", "), advice }
}

#[cfg(test)]
mod tests {
    use walpha_base::advice::Advise;

    use super::*;

    #[test]
    fn unknown_samples_name_the_known_ones() {
        for name in ["sample:skul", "sample:phantom@", "sample:phantom@-3", "phantom"] {
            let text = sample(name).unwrap_err().to_string();
            assert!(text.contains(name) && text.contains("sample:phantom@N"), "{text}");
            assert!(text.contains("sample:peptide") && text.contains("sample:tile"), "{text}");
        }
        let advice = sample("sample:skul").unwrap_err().advice().unwrap().to_string();
        assert_eq!(advice, "did you mean sample:skull?");
        assert!(matches!(sample("sample:phantom@0"), Err(VolumeError::EmptyAxis { .. })));
        assert!(matches!(sample("sample:phantom@99999"), Err(VolumeError::TooManySamples { .. })));
    }
}
