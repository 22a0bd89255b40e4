use std::path::Path;

use walpha_base::vector::{cross, dot};

use super::slice::Slice;
use crate::error::format_error;
use crate::read::layout;
use crate::{Coordinates, Frame, Reason, VolumeError};

/// Unit vectors this alike are one; headers have six digits or more.
const SAME_DIRECTION: f64 = 1e-3;
/// A gap this many times the usual one, or more, has slices missing.
const MISSING: f64 = 1.5;
/// A warning is given for distances that differ by more than this share of the usual one.
const UNEVEN: f64 = 0.01;

/// Slices in the order of their positions along the normal, and where their grid lies.
///
/// Slices of other sizes or directions, two at one place and missing ones are errors; uneven distances
/// are a warning, and their mean is the spacing. Where slices are shifted against each other, as a
/// tilted gantry does, the third axis is oblique.
pub(super) fn stacked(
    path: &Path,
    mut slices: Vec<Slice>,
) -> Result<(Vec<Slice>, Frame), VolumeError> {
    let fail = |reason: Reason| format_error(path, reason);
    let Some(first) = slices.first().cloned() else {
        return Err(fail(Reason::content("holds no DICOM slices", "name a folder of them")));
    };
    for slice in &slices {
        let (name, other) = (slice.name(), first.name());
        if (slice.columns, slice.rows) != (first.columns, first.rows) {
            return Err(fail(Reason::content(
                format!(
                    "has a slice of {}×{} pixels in {name}, and of {}×{} in {other}",
                    slice.columns, slice.rows, first.columns, first.rows
                ),
                "move those that do not belong away",
            )));
        }
        let turned = slice.orientation.as_flattened().iter().zip(first.orientation.as_flattened());
        if turned.into_iter().any(|(a, b)| (a - b).abs() > SAME_DIRECTION) {
            return Err(fail(Reason::content(
                format!("has slices of different orientations, as {name} and {other}"),
                "move localisers and other views away",
            )));
        }
        let spaced = slice.spacing.iter().zip(&first.spacing);
        if spaced.into_iter().any(|(a, b)| (a - b).abs() > SAME_DIRECTION * b.abs()) {
            return Err(fail(Reason::content(
                format!(
                    "has pixels {:?} mm apart in {name}, and {:?} in {other}",
                    slice.spacing, first.spacing
                ),
                "move those that do not belong away",
            )));
        }
    }
    let [column, row] = first.orientation;
    let normal = cross(column, row);
    slices.sort_by(|a, b| {
        let [a_at, b_at] = [a, b].map(|slice| dot(slice.position, normal));
        a_at.total_cmp(&b_at).then_with(|| (&a.path, a.frame).cmp(&(&b.path, b.frame)))
    });
    let step = match even(&slices, normal).map_err(fail)? {
        Some(step) => step,
        None => normal.map(|n| n * first.thickness),
    };
    let axes = [column.map(|v| v * first.spacing[0]), row.map(|v| v * first.spacing[1]), step];
    let frame = layout::frame(path, slices[0].position, axes, Coordinates::PATIENT)?;
    Ok((slices, frame))
}

/// The step from one slice to the next; `None` for a single one.
fn even(slices: &[Slice], normal: [f64; 3]) -> Result<Option<[f64; 3]>, Reason> {
    let [first, .., last] = slices else { return Ok(None) };
    let at = |slice: &Slice| dot(slice.position, normal);
    let mut gaps: Vec<f64> = slices.windows(2).map(|two| at(&two[1]) - at(&two[0])).collect();
    let pairs: Vec<_> = slices.windows(2).zip(gaps.clone()).collect();
    let names = |two: &[Slice]| format!("{} and {}", two[0].name(), two[1].name());
    gaps.sort_by(f64::total_cmp);
    // Of an even number the greater, so that not all places need be doubled; the lesser for what is
    // usual, so that a gap among few stands out.
    let [greater, usual] = [gaps[gaps.len() / 2], gaps[(gaps.len() - 1) / 2]];
    if let Some((two, _)) = pairs.iter().find(|(_, gap)| *gap <= UNEVEN * greater) {
        return Err(Reason::content(
            format!("has two slices at one place, {}: it has several times or echoes", names(two)),
            "move those of one into a folder of their own, or convert it to NRRD or NIfTI",
        ));
    }
    if let Some((two, gap)) = pairs.iter().find(|(_, gap)| *gap >= MISSING * usual) {
        return Err(Reason::content(
            format!(
                "has a gap of {gap:.3} mm between {}, where {usual:.3} mm are usual (slices \
                     missing: {})",
                names(two),
                (gap / usual).round() - 1.0
            ),
            "copy the whole series again",
        ));
    }
    let (least, most) = (gaps[0], gaps[gaps.len() - 1]);
    if most - least > UNEVEN * usual {
        tracing::warn!(
            "slices are {least:.3} to {most:.3} mm apart; the mean is taken for all of them"
        );
    }
    let count = (slices.len() - 1) as f64;
    Ok(Some([0, 1, 2].map(|k| (last.position[k] - first.position[k]) / count)))
}
