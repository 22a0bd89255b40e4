//! Orders slices by their places, and finds their grid.

use std::path::Path;

use walpha_base::advice::{Setting, advice};
use walpha_base::shown::six_digits;
use walpha_base::sort::sort_by;
use walpha_base::vector::{dot, length, sub};

use super::distances::{Distances, Wide, distances};
use super::slice::Slice;
use crate::error::format_error;
use crate::read::layout;
use crate::{Coordinates, Frame, Reason, VolumeError};

/// Unit vectors whose difference is below this are equal; headers have six digits or more.
const SAME_DIRECTION: f64 = 1e-3;
/// The largest distance of a slice from the line through the others, in pixels.
const ASIDE: f64 = 0.5;
/// The largest number of planes of a grid, as a multiple of the number of slices.
const MOST_FINER: usize = 32;
/// A plane of the grid that is this near to a slice, as a share of the distance of planes, is that of the slice.
const SAME_PLACE: f64 = 0.01;

/// Slices ordered along their normal, and their grid.
pub(super) struct Stack {
    pub slices: Vec<Slice>,
    pub frame: Frame,
    pub order: Order,
}

/// The planes of the grid.
pub(super) enum Order {
    /// The slices, one after the other.
    Slices,
    /// Planes between slices: for each, the slice below and the share of the next one.
    Between(Vec<(usize, f64)>),
    /// For each slice of a segmentation, the planes that it fills.
    Planes(Vec<Vec<usize>>),
}

/// Orders slices by their places along the normal, and finds their grid.
///
/// Slices of different sizes or directions, two slices at one place and missing slices are errors. If distances differ, the grid
/// has the smallest of them. If slices are shifted against each other, as a tilted gantry does, the third axis is oblique.
pub(super) fn stacked(
    path: &Path,
    mut slices: Vec<Slice>,
    no_resample: bool,
) -> Result<Stack, VolumeError> {
    let fail = |reason: Reason| format_error(path, reason);
    let Some(first) = slices.first().cloned() else {
        return Err(fail(Reason::content("holds no DICOM slices", "name a folder of them")));
    };
    alike(&slices, &first).map_err(fail)?;
    let normal = first.normal();
    let at = |slice: &Slice| dot(slice.position, normal);
    sort_by(&mut slices, |a, b| {
        at(a).total_cmp(&at(b)).then_with(|| (&a.path, a.frame).cmp(&(&b.path, b.frame)))
    });
    let is_segmentation = first.segment.is_some();
    let (step, order) = if is_segmentation {
        planes(&slices, normal, no_resample).map_err(fail)?
    } else {
        even(&slices, normal, no_resample).map_err(fail)?
    };
    let line = line(&slices, normal).map_err(fail)?;
    let [column, row] = first.orientation;
    let axes = [
        column.map(|v| v * first.spacing[0]),
        row.map(|v| v * first.spacing[1]),
        line.map(|v| v * step),
    ];
    let frame = layout::frame(path, slices[0].position, axes, Coordinates::PATIENT)?;
    Ok(Stack { slices, frame, order })
}

/// Refuses slices that do not belong to one grid.
fn alike(slices: &[Slice], first: &Slice) -> Result<(), Reason> {
    for slice in slices {
        let (name, other) = (slice.name(), first.name());
        if (slice.columns, slice.rows) != (first.columns, first.rows) {
            return Err(Reason::content(
                format!(
                    "has a slice of {}×{} pixels in {name}, and of {}×{} in {other}",
                    slice.columns, slice.rows, first.columns, first.rows
                ),
                "move away those that do not belong",
            ));
        }
        let turned = slice.orientation.as_flattened().iter().zip(first.orientation.as_flattened());
        if turned.into_iter().any(|(a, b)| (a - b).abs() > SAME_DIRECTION) {
            return Err(Reason::content(
                format!("has slices of different orientations, as {name} and {other}"),
                "move away localisers and other views",
            ));
        }
        let spaced = slice.spacing.iter().zip(&first.spacing);
        if spaced.into_iter().any(|(a, b)| (a - b).abs() > SAME_DIRECTION * b.abs()) {
            return Err(Reason::content(
                format!(
                    "has pixels {:?} mm apart in {name}, and {:?} in {other}",
                    slice.spacing, first.spacing
                ),
                "move away those that do not belong",
            ));
        }
    }
    Ok(())
}

/// The displacement along the line through the first and the last slice for one millimetre along the normal. A slice beside this
/// line is an error.
fn line(slices: &[Slice], normal: [f64; 3]) -> Result<[f64; 3], Reason> {
    let [first, .., last] = slices else { return Ok(normal) };
    let whole = sub(last.position, first.position);
    let along = dot(whole, normal);
    if along == 0.0 {
        return Ok(normal);
    }
    let line = whole.map(|v| v / along);
    for slice in slices {
        let way = sub(slice.position, first.position);
        let aside = length(sub(way, line.map(|v| v * dot(way, normal))));
        if aside > ASIDE * slice.spacing[0].min(slice.spacing[1]) {
            return Err(Reason::content(
                format!(
                    "has slices that are shifted against each other unevenly: {} lies {aside:.3} mm beside the line from {} to {}",
                    slice.name(),
                    first.name(),
                    last.name()
                ),
                "move away slices of other views, or convert it to NRRD with a program that resamples them",
            ));
        }
    }
    Ok(line)
}

/// The distance of planes, and the planes themselves.
fn even(slices: &[Slice], normal: [f64; 3], no_resample: bool) -> Result<(f64, Order), Reason> {
    let at: Vec<f64> = slices.iter().map(|slice| dot(slice.position, normal)).collect();
    let numbers: Option<Vec<f64>> = slices.iter().map(|slice| slice.number).collect();
    let step = match distances(&at, numbers.as_deref()) {
        Distances::One => return Ok((thickness(&slices[0]), Order::Slices)),
        Distances::Same(i) => return Err(same_place(&slices[i], &slices[i + 1])),
        Distances::Wide(wide) => return Err(gap(slices, &wide)),
        Distances::Even { step, off } => {
            if off > 0.0 {
                tracing::warn!(
                    "slices lie up to {off:.3} mm off places {} mm apart, which are taken",
                    six_digits(step)
                );
            }
            return Ok((step, Order::Slices));
        }
        Distances::Several(step) => step,
    };
    let places = between(&at, step)?;
    let said = format!("{} slices {} mm apart", places.len(), six_digits(step));
    let what = several(&at);
    if no_resample {
        return Err(refused(what, &said, "linearly"));
    }
    tracing::warn!("{what}: they are resampled linearly to {said}");
    Ok((step, Order::Between(places)))
}

/// Like [`even`], for a segmentation, in which a plane without a frame is empty.
fn planes(slices: &[Slice], normal: [f64; 3], no_resample: bool) -> Result<(f64, Order), Reason> {
    let places: Vec<f64> = slices.iter().map(|slice| dot(slice.position, normal)).collect();
    let first = &slices[0];
    // Each of several segments may have a frame at the same place.
    let mut at: Vec<f64> = Vec::new();
    for &place in &places {
        if at.last().is_none_or(|last| place - last > 1e-3) {
            at.push(place);
        }
    }
    let stated = first.step.filter(|step| slices.iter().all(|slice| slice.step == Some(*step)));
    let on_grid = |step: f64| {
        let off = |place: &f64| ((place - at[0]) / step - ((place - at[0]) / step).round()).abs();
        step > 0.0 && at.iter().all(|place| off(place) <= 0.1)
    };
    let finest = at.windows(2).map(|two| two[1] - two[0]).fold(f64::INFINITY, f64::min);
    let found = distances(&at, None);
    let step = match (stated.map(f64::abs), &found) {
        (Some(step), _) if on_grid(step) => step,
        (_, Distances::One) => thickness(first),
        (_, Distances::Even { step, .. }) => *step,
        (_, Distances::Several(step)) => {
            let below = between(&at, *step)?;
            let said = format!("{} planes {} mm apart", below.len(), six_digits(*step));
            let what = several(&at);
            if no_resample {
                return Err(refused(what, &said, "to the nearest slice"));
            }
            tracing::warn!("{what}: {said} take the nearest slice each");
            let nearest = |&(below, share): &(usize, f64)| below + usize::from(share >= 0.5);
            let nearest: Vec<f64> = below.iter().map(nearest).map(|i| at[i]).collect();
            let planes = |place: &f64| {
                let near = |(_, at): &(usize, &f64)| (*at - place).abs() <= 1e-3;
                nearest.iter().enumerate().filter(near).map(|(plane, _)| plane).collect()
            };
            return Ok((*step, Order::Planes(places.iter().map(planes).collect())));
        }
        _ if on_grid(finest) => finest,
        _ => {
            let what = format!(
                "is a segmentation whose frames do not lie on an even grid: {} to {} mm",
                six_digits(finest),
                six_digits(at.windows(2).map(|two| two[1] - two[0]).fold(0.0, f64::max))
            );
            return Err(Reason::content(
                what,
                "convert it to NRRD with a program that resamples it",
            ));
        }
    };
    let most = (at[at.len() - 1] - at[0]) / step;
    if most > (MOST_FINER * 64 * slices.len()) as f64 {
        let what = format!("is a segmentation of {} frames in {most:.0} planes", slices.len());
        return Err(Reason::header(what));
    }
    let plane = |place: &f64| vec![((place - at[0]) / step).round() as usize];
    Ok((step, Order::Planes(places.iter().map(plane).collect())))
}

/// The distance to the next slice if there is only one.
fn thickness(slice: &Slice) -> f64 {
    slice.step.map(f64::abs).or(slice.thickness).filter(|&step| step > 0.0).unwrap_or(1.0)
}

/// For each plane of a finer grid, the slice below and the share of the next.
fn between(at: &[f64], step: f64) -> Result<Vec<(usize, f64)>, Reason> {
    let most = (at[at.len() - 1] - at[0]) / step + SAME_PLACE;
    if most >= (MOST_FINER * at.len()) as f64 {
        let what = format!(
            "has slices at distances from {} mm up, which would make {} slices of {}",
            six_digits(step),
            most as u64 + 1,
            at.len()
        );
        return Err(Reason::content(what, "move away slices that do not belong to the others"));
    }
    let mut below = 0;
    let place = |k: usize| {
        let place = at[0] + k as f64 * step;
        while below + 1 < at.len() && at[below + 1] <= place + SAME_PLACE * step {
            below += 1;
        }
        let Some(next) = at.get(below + 1) else { return (below, 0.0) };
        let share = (place - at[below]) / (next - at[below]);
        (below, if place - at[below] <= SAME_PLACE * step { 0.0 } else { share })
    };
    Ok((0..=most as usize).map(place).collect())
}

/// Describes the distances, for people.
fn several(at: &[f64]) -> String {
    let mut counts: Vec<(f64, usize)> = Vec::new();
    for two in at.windows(2) {
        let gap = two[1] - two[0];
        match counts.iter_mut().find(|(of, _)| (gap - *of).abs() <= SAME_PLACE * *of) {
            Some((_, count)) => *count += 1,
            None => counts.push((gap, 1)),
        }
    }
    sort_by(&mut counts, |a, b| a.0.total_cmp(&b.0));
    let shown = |gap: f64| six_digits((gap * 1e6).round() / 1e6);
    match &counts[..] {
        [(least, _), .., (most, _)] if counts.len() > 4 => {
            format!("slices are {} to {} mm apart", shown(*least), shown(*most))
        }
        _ => {
            let each: Vec<String> =
                counts.iter().map(|&(gap, n)| format!("{} mm ({n} times)", shown(gap))).collect();
            format!("slices are at several distances, {}", each.join(", "))
        }
    }
}

/// The error if slices would have to be resampled but must not be.
fn refused(what: String, said: &str, how: &str) -> Reason {
    let next = advice!["omit ", Setting::NoResample, format!(" to resample them {how} to {said}")];
    Reason::choice(Setting::NoResample, format!("holds a series whose {what}"), next)
}

/// The error for two slices at one place.
fn same_place(a: &Slice, b: &Slice) -> Reason {
    let next = if a.path == b.path {
        "convert the frames of one volume to NRRD or NIfTI"
    } else {
        "move those of one volume into a folder of their own, or convert it to NRRD or NIfTI"
    };
    let (a, b) = (a.name(), b.name());
    Reason::content(
        format!(
            "has two slices at one place, {a} and {b}, and says of neither to which volume it belongs"
        ),
        next,
    )
}

/// The error for a distance that no rule explains.
fn gap(slices: &[Slice], &Wide { slice, gap, usual, missing }: &Wide) -> Reason {
    let beside = [&slices[slice], &slices[slice + 1]];
    let next = if beside[0].path == beside[1].path {
        "write the file anew without the gap, or convert the frames on one side of it to NRRD or NIfTI"
    } else {
        "add what is missing, or move the slices on one side of the gap into a folder of their own"
    };
    let [a, b] = beside.map(Slice::name);
    let what =
        format!("has a gap of {gap:.3} mm between {a} and {b}, where {usual:.3} mm are usual");
    let cause = match missing {
        Some(count) => format!("(slices missing: {count})"),
        None => {
            "(neither the place of whole slices, nor a distance that several slices have)".into()
        }
    };
    Reason::content(format!("{what} {cause}"), next)
}
