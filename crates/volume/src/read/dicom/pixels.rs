//! The pixels of slices, as values.

use std::path::Path;

use dicom_encoding::{Endianness, TransferSyntax};
use dicom_object::mem::InMemElement;
use dicom_object::{DefaultDicomObject, Tag};
use dicom_pixeldata::PixelDecoder;
use walpha_base::memory::afford;

use super::claims::{DOUBLE_PIXEL_DATA, FLOAT_PIXEL_DATA, PIXEL_DATA, damaged};
use super::slice::Slice;
use super::start::Start;
use super::values::Coding;
use crate::error::format_error;
use crate::formats::decoded;
use crate::rounding::Rounding;
use crate::{Reason, VolumeError};

/// The pixels of one slice, row by row.
pub(super) struct Plane {
    /// The values, in the units of the modality (rescaled, as Hounsfield units are).
    pub samples: Vec<f32>,
    /// Which of them are padding, if any is.
    pub padded: Option<Vec<bool>>,
}

/// The pixels of frames of one file. `rounding` records whether whole numbers are rounded.
pub(super) fn pixels(slices: &[&Slice], rounding: &Rounding) -> Result<Vec<Plane>, VolumeError> {
    let Some(first) = slices.first() else { return Ok(Vec::new()) };
    let bytes = stored_in(first)?;
    slices.iter().map(|slice| plane(slice, &bytes, rounding)).collect()
}

/// The pixels of one slice, from those of its file.
pub(super) fn plane(
    slice: &Slice,
    bytes: &[u8],
    rounding: &Rounding,
) -> Result<Plane, VolumeError> {
    let Slice { columns, rows, frames, .. } = *slice;
    let each = (columns * rows) as usize;
    let before = each.saturating_mul(slice.frame as usize);
    let (samples, padded) = slice.values.decode(bytes, before, each, rounding).ok_or_else(|| {
        let reason = Reason::truncated(format!(
            "claims {frames} × {columns}×{rows} pixels and holds {} bytes of them: it is truncated or damaged",
            bytes.len()
        ));
        format_error(&slice.path, reason)
    })?;
    Ok(Plane { samples, padded })
}

/// The unpacked bytes of all pixels of the file that contains a slice.
pub(super) fn stored_in(slice: &Slice) -> Result<Vec<u8>, VolumeError> {
    let path = &slice.path;
    let start = Start::of(path)?;
    check_syntax(path, &start)?;
    let mut object = start.object(path, None)?;
    join_fragments(path, &mut object, slice.frames as usize)?;
    // Each pixel takes 16 bits twice: as it is decoded and as it is returned.
    let room = slice.columns.saturating_mul(slice.rows).saturating_mul(slice.frames.into());
    let room = usize::try_from(room.saturating_mul(4)).unwrap_or(usize::MAX);
    afford(room, || "the pixels of a DICOM file".into())?;
    stored(path, &object, &start, slice.values.coding)
}

/// The unpacked bytes of all pixels of a file, each with its lowest byte first.
fn stored(
    path: &Path,
    object: &DefaultDicomObject,
    start: &Start,
    coding: Coding,
) -> Result<Vec<u8>, VolumeError> {
    let tag: Tag = match coding {
        Coding::Float => FLOAT_PIXEL_DATA,
        Coding::Double => DOUBLE_PIXEL_DATA,
        _ => PIXEL_DATA,
    };
    let element = object.get(tag);
    let Some(value) = element.and_then(|element| element.value().primitive()) else {
        // Each slice fails separately, so that the series may go on without it.
        let pixels = || object.decode_pixel_data().map_err(|error| damaged(path, &error));
        return Ok(decoded(path, pixels)?.data().to_vec());
    };
    let bytes = value.to_bytes();
    let is_of_words = element.is_some_and(|element| element.vr().to_string() == "OW");
    let is_big = start.syntax(path)?.endianness() == Endianness::Big;
    // Words are in the byte order of this machine, and the words of longer numbers are in the opposite order.
    Ok(if is_big && is_of_words && matches!(coding, Coding::Integer { bytes: 4, .. }) {
        let turned = bytes.as_chunks::<4>().0.iter().flat_map(|&[a, b, c, d]| [c, d, a, b]);
        turned.collect()
    } else {
        bytes.into_owned()
    })
}

/// Joins fragments that are parts of one frame if no offset table says which are: a frame begins with the magic bytes of its
/// coding.
fn join_fragments(
    path: &Path,
    object: &mut DefaultDicomObject,
    frames: usize,
) -> Result<(), VolumeError> {
    let value = object.get(PIXEL_DATA).map(InMemElement::value);
    let fragments = value.and_then(|value| value.fragments().zip(value.offset_table()));
    let Some((fragments, [])) = fragments else { return Ok(()) };
    let count = fragments.len();
    if frames < 2 || count == frames {
        return Ok(());
    }
    if begins(fragments) != Some(frames) {
        let what = format!(
            "has {frames} compressed frames in {count} fragments, and neither a table of offsets nor what fragments \
             begin with says which belong together"
        );
        let next = "unpack it first, as `gdcmconv --raw` does";
        return Err(format_error(path, Reason::unsupported(what, next)));
    }
    object.update_value(PIXEL_DATA, |value| {
        if let Some(fragments) = value.fragments_mut() {
            let all = joined(fragments.drain(..));
            fragments.extend(all);
        }
    });
    Ok(())
}

/// Whether a fragment begins as JPEG or JPEG 2000 do.
fn is_start(fragment: &[u8]) -> bool {
    fragment.starts_with(b"\xff\xd8\xff") || fragment.starts_with(b"\xff\x4f\xff\x51")
}

/// The number of fragments that begin a frame; `None` if the first does not begin one.
fn begins(fragments: &[Vec<u8>]) -> Option<usize> {
    is_start(fragments.first()?).then(|| fragments.iter().filter(|one| is_start(one)).count())
}

/// Joins the fragments of each frame into one.
fn joined(fragments: impl Iterator<Item = Vec<u8>>) -> Vec<Vec<u8>> {
    let mut frames: Vec<Vec<u8>> = Vec::new();
    for fragment in fragments {
        match frames.last_mut() {
            Some(last) if !is_start(&fragment) => last.extend(fragment),
            _ => frames.push(fragment),
        }
    }
    frames
}

/// Refuses pixels in a compression that has no decoder.
fn check_syntax(path: &Path, start: &Start) -> Result<(), VolumeError> {
    let syntax: &TransferSyntax = start.syntax(path)?;
    if syntax.can_decode_all() {
        return Ok(());
    }
    let what =
        format!("has pixels compressed as {} ({}), which is not read", syntax.name(), syntax.uid());
    Err(format_error(path, Reason::unsupported(what, "unpack it first, as `gdcmconv --raw` does")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fragments_belong_to_the_frame_that_began_before_them() {
        let of = |fragments: &[&[u8]]| fragments.iter().map(|one| one.to_vec()).collect::<Vec<_>>();
        let (jpeg, j2k) = (&b"\xff\xd8\xff\xe0"[..], &b"\xff\x4f\xff\x51"[..]);
        let parts = of(&[j2k, b"1", b"2", j2k, j2k, b"3"]);
        assert_eq!(begins(&parts), Some(3));
        let frames = joined(parts.into_iter());
        assert_eq!(frames, of(&[&[j2k, b"12"].concat(), j2k, &[j2k, b"3"].concat()]));
        assert_eq!(begins(&of(&[jpeg, b"1", jpeg])), Some(2));
        assert_eq!(begins(&of(&[b"1", jpeg])), None);
    }
}
