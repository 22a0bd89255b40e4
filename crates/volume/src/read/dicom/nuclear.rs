//! Frames of nuclear medicine, which are numbered and not placed one by one (PS3.3, C.8.4).

use dicom_object::Tag;

use super::header::Header;
use super::slice::Slice;
use crate::{Reason, VolumeError};

const IMAGE_TYPE: Tag = Tag(0x0008, 0x0008);
const MODALITY: Tag = Tag(0x0008, 0x0060);
const SPACING_BETWEEN_SLICES: Tag = Tag(0x0018, 0x0088);
const SLICE_VECTOR: Tag = Tag(0x0054, 0x0080);

/// Whether a file is from nuclear medicine.
pub(super) fn is_nuclear(header: Header<'_>) -> bool {
    header.text(None, MODALITY).is_some_and(|modality| modality == "NM")
}

/// Places the slices of a reconstruction; the header contains only the place of the first.
pub(super) fn place(header: Header<'_>, slices: &mut [Slice]) -> Result<(), VolumeError> {
    let types = header.text(None, IMAGE_TYPE).unwrap_or_default();
    let kind = types.split('\\').nth(2).unwrap_or_default();
    let numbers = header.numbers(None, SLICE_VECTOR);
    if !kind.starts_with("RECON") && numbers.is_empty() {
        let what = format!(
            "is of nuclear medicine, with {} frames of Image Type {types:?}: views or times of one place, not a volume",
            slices.len()
        );
        let next = "name a reconstruction (Image Type with RECON TOMO)";
        return Err(header.fail(Reason::unsupported(what, next)));
    }
    let counted = (1..=slices.len()).map(|n| n as f64).collect();
    let numbers = if numbers.is_empty() { counted } else { numbers };
    let step = header.number(None, SPACING_BETWEEN_SLICES)?.filter(|&step| step != 0.0);
    let (Some(step), true) = (step, numbers.len() == slices.len()) else {
        let what = format!(
            "has {} frames, a Slice Vector {SLICE_VECTOR} of {} numbers, and {} Spacing Between Slices \
             {SPACING_BETWEEN_SLICES}: its frames cannot be placed",
            slices.len(),
            numbers.len(),
            if step.is_some() { "a" } else { "no" }
        );
        return Err(header.fail(Reason::header(what)));
    };
    // A positive distance follows the normal, a negative one is opposite to it.
    for (slice, number) in slices.iter_mut().zip(numbers) {
        slice.move_by((number - 1.0) * step);
    }
    Ok(())
}
