//! Segmentations (DICOM SEG, PS3.3, C.8.20): each frame shows one segment in one plane.

use std::collections::BTreeMap;
use std::path::Path;

use dicom_object::Tag;
use walpha_base::Monitor;
use walpha_base::advice::{Setting, advice};
use walpha_base::memory::try_with_capacity;
use walpha_base::parallel::prelude::*;
use walpha_base::shown::shown;

use super::header::Header;
use super::pixels::{plane, stored_in};
use super::slice::Slice;
use super::stack::{Order, Stack, stacked};
use crate::error::format_error;
use crate::read::frames::FrameChoice;
use crate::read::layout::{Encoding, Layout};
use crate::rounding::Rounding;
use crate::{Dims, Dtype, Endian, ReadOptions, Reason, Volume, VolumeError};

const SOP_CLASS_UID: Tag = Tag(0x0008, 0x0016);
const SEGMENTATION_TYPE: Tag = Tag(0x0062, 0x0001);
const SEGMENTS: Tag = Tag(0x0062, 0x0002);
const SEGMENT_NUMBER: Tag = Tag(0x0062, 0x0004);
const SEGMENT_LABEL: Tag = Tag(0x0062, 0x0005);
const SEGMENT_IDENTIFICATION: Tag = Tag(0x0062, 0x000A);
const REFERENCED_SEGMENT_NUMBER: Tag = Tag(0x0062, 0x000B);
const MAXIMUM_FRACTIONAL_VALUE: Tag = Tag(0x0062, 0x000E);

/// The UIDs of Segmentation Storage and Label Map Segmentation Storage.
const CLASSES: [&str; 2] = ["1.2.840.10008.5.1.4.1.1.66.4", "1.2.840.10008.5.1.4.1.1.66.7"];

/// The content of a frame of a segmentation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Segment {
    /// The number of the segment and its name; `None` if pixels are the numbers of segments.
    pub of: Option<(u16, String)>,
    /// The stored number that means the whole voxel, if pixels are shares.
    pub share: Option<f64>,
}

/// Whether a file is a segmentation.
pub(super) fn is_segmentation(header: Header<'_>) -> bool {
    header.text(None, SOP_CLASS_UID).is_some_and(|class| CLASSES.contains(&class.as_str()))
}

/// Refuses unknown types of segmentation.
pub(super) fn check(header: Header<'_>) -> Result<(), VolumeError> {
    let kind = header.text(None, SEGMENTATION_TYPE).unwrap_or_default();
    if ["BINARY", "FRACTIONAL", "LABELMAP"].contains(&kind.as_str()) {
        return Ok(());
    }
    let what = format!(
        "is a segmentation of type {kind:?} {SEGMENTATION_TYPE}, and BINARY, FRACTIONAL and LABELMAP are read"
    );
    Err(header.fail(Reason::unsupported(what, "convert it to NRRD or NIfTI")))
}

/// The content of a frame; `None` if the file is not a segmentation.
pub(super) fn of_frame(header: Header<'_>) -> Result<Option<Segment>, VolumeError> {
    if !is_segmentation(header) {
        return Ok(None);
    }
    let kind = header.text(None, SEGMENTATION_TYPE).unwrap_or_default();
    if kind == "LABELMAP" {
        return Ok(Some(Segment { of: None, share: None }));
    }
    let segments = header.items(None, SEGMENTS).unwrap_or_default();
    let number_of = |item: &dicom_object::InMemDicomObject| {
        item.get(SEGMENT_NUMBER).and_then(|element| element.to_int::<u16>().ok())
    };
    let stated = header.number(SEGMENT_IDENTIFICATION, REFERENCED_SEGMENT_NUMBER)?;
    let only = match segments {
        [one] => number_of(one).map(f64::from),
        _ => None,
    };
    let Some(number) = stated.or(only).filter(|number| (1.0..=65535.0).contains(number)) else {
        let what = format!(
            "is a segmentation with a frame of no segment: it has no Referenced Segment Number \
             {REFERENCED_SEGMENT_NUMBER} from 1 up"
        );
        return Err(header.fail(Reason::header(what)));
    };
    let number = number as u16;
    let item = segments.iter().find(|item| number_of(item) == Some(number));
    let label = item.and_then(|item| item.get(SEGMENT_LABEL)?.to_str().ok());
    let label = label.map(|label| label.trim().to_owned()).unwrap_or_default();
    let share = if kind == "FRACTIONAL" {
        let most = header.number(None, MAXIMUM_FRACTIONAL_VALUE)?.filter(|&most| most > 0.0);
        let what = || format!("has no Maximum Fractional Value {MAXIMUM_FRACTIONAL_VALUE} above 0");
        Some(most.ok_or_else(|| header.fail(Reason::header(what())))?)
    } else {
        None
    };
    Ok(Some(Segment { of: Some((number, label)), share }))
}

/// Builds the volume of a segmentation: numbers of segments, or shares of one segment. Planes without a frame are 0.
pub(super) fn volume(
    path: &Path,
    mut slices: Vec<Slice>,
    options: &ReadOptions,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let fail = |reason: Reason| format_error(path, reason);
    let file = slices[0].path.clone();
    if let Some(other) = slices.iter().find(|slice| slice.path != file) {
        let what =
            format!("holds several segmentations, {} and {}", shown(&file), shown(&other.path));
        return Err(fail(Reason::content(what, "name one of these files")));
    }
    let of = |slice: &Slice| slice.segment.as_ref().and_then(|segment| segment.of.clone());
    let segments: BTreeMap<u16, String> = slices.iter().filter_map(of).collect();
    let is_shared =
        slices.iter().any(|slice| slice.segment.as_ref().is_some_and(|s| s.share.is_some()));
    let count = segments.len().max(1) as u64;
    let chosen = if options.frame.is_some() || is_shared {
        let choice = FrameChoice::choose(path, &[count], options.frame)?;
        segments.keys().nth(choice.index as usize).copied()
    } else {
        None
    };
    if let Some(chosen) = chosen {
        slices.retain(|slice| of(slice).is_none_or(|(number, _)| number == chosen));
    }
    let Stack { slices, frame, order } = stacked(path, slices, options.no_resample)?;
    let Order::Planes(places) = order else { unreachable!("segments have planes of their own") };
    let planes = places.iter().flatten().max().map_or(1, |last| last + 1);
    let first = &slices[0];
    let dims = Dims::new(first.columns, first.rows, planes as u64)?;
    let each = dims.x() * dims.y();
    let mut samples = try_with_capacity::<f32>(dims.samples(), || "a segmentation".into())?;
    samples.resize(dims.samples(), 0.0);
    let bytes = stored_in(first)?;
    for (done, (slice, places)) in slices.iter().zip(&places).enumerate() {
        let plane = plane(slice, &bytes, &Rounding::default())?;
        let number = of(slice).map(|(number, _)| number).filter(|_| !is_shared);
        for &place in places {
            let target = &mut samples[each * place..each * (place + 1)];
            lay(target, &plane.samples, number)
                .map_err(|under| fail(overlap(&segments, under, slice)))?;
        }
        monitor.report(done as u64, slices.len() as u64)?;
    }
    let dtype = match segments.keys().last() {
        _ if is_shared => Dtype::F32,
        None => first.dtype(),
        Some(0..=255) => Dtype::U8,
        Some(_) => Dtype::U16,
    };
    let (endian, encoding) = (Endian::Little, Encoding::Raw);
    let layout = Layout { dims, dtype, endian, frame, encoding, frames: FrameChoice::ONE };
    let volume = layout.volume(samples)?;
    Ok(if is_shared { volume } else { volume.with_labels() })
}

/// Lays a plane over the existing pixels: a segment as its number, other pixels unchanged. The error is the number of another
/// segment that shares a pixel with this one.
fn lay(target: &mut [f32], plane: &[f32], number: Option<u16>) -> Result<(), u16> {
    let taken = target.par_iter_mut().zip(plane).map(|(target, &value)| {
        let Some(number) = number.filter(|_| value != 0.0) else {
            if number.is_none() {
                *target = value;
            }
            return None;
        };
        let under = std::mem::replace(target, number.into());
        (under != 0.0 && under != f32::from(number)).then_some(under as u16)
    });
    taken.flatten().min().map_or(Ok(()), Err)
}

/// The error for segments that share pixels.
fn overlap(segments: &BTreeMap<u16, String>, under: u16, slice: &Slice) -> Reason {
    let number =
        slice.segment.as_ref().and_then(|segment| segment.of.as_ref()).map_or(0, |of| of.0);
    let called = |number: u16| match segments.get(&number).map(String::as_str) {
        None | Some("") => number.to_string(),
        Some(label) => format!("{number} ({label})"),
    };
    let listed = segments.keys().enumerate().map(|(k, &number)| format!("{k}: {}", called(number)));
    let listed: Vec<String> = listed.collect();
    Reason::choice(
        Setting::Frame,
        format!(
            "has segments that overlap, {} and {} in {}: a voxel has one label",
            called(under.min(number)),
            called(under.max(number)),
            slice.name()
        ),
        advice!["choose one of them with ", Setting::Frame, format!(" ({})", listed.join(", "))],
    )
}
