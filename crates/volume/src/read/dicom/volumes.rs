//! Divides the slices of a series into volumes: copies are dropped, and times, echoes or stacks are separated.

use std::cmp::Ordering;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use walpha_base::shown::{counted, shown};
use walpha_base::sort::sort_by;
use walpha_base::vector::{dot, length, sub};

use super::index::{Key, STACK};
use super::pixels::stored_in;
use super::slice::Slice;
use crate::error::format_error;
use crate::read::frames::FrameChoice;
use crate::{Reason, VolumeError};

/// Places that are nearer than this, in mm, are equal.
const SAME_PLACE: f64 = 1e-3;

/// The slices without copies. Copies are slices in different files with the same SOP Instance UID and place. They are refused if
/// their pixels differ.
///
/// The inner error is about a file whose pixels cannot be read.
pub(super) fn without_copies(
    path: &Path,
    slices: Vec<Slice>,
) -> Result<Result<Vec<Slice>, VolumeError>, VolumeError> {
    let mut kept: Vec<Slice> = Vec::with_capacity(slices.len());
    let mut known: HashMap<(String, u32), Vec<usize>> = HashMap::new();
    let (mut copies, mut shared) = (0, None);
    // All frames of two files are compared at once.
    let mut compared: HashSet<(PathBuf, PathBuf)> = HashSet::new();
    for slice in slices {
        let of = known.entry((slice.instance.clone(), slice.frame)).or_default();
        if slice.instance.is_empty() {
            kept.push(slice);
            continue;
        }
        let is_there = |other: &Slice| {
            length(sub(slice.position, other.position)) < SAME_PLACE && slice.path != other.path
        };
        if let Some(&first) = of.iter().find(|&&i| is_there(&kept[i])) {
            let other = &kept[first];
            let pair = (other.path.clone(), slice.path.clone());
            let is_same = if compared.contains(&pair) {
                true
            } else {
                match (stored_in(other), stored_in(&slice)) {
                    (Ok(a), Ok(b)) => a == b,
                    (Err(error), _) | (_, Err(error)) => return Ok(Err(error)),
                }
            };
            compared.insert(pair);
            if !is_same || slice.values != other.values {
                let what = format!(
                    "has two files of one SOP Instance UID whose pixels differ, {} and {}",
                    shown(&other.path),
                    shown(&slice.path)
                );
                let reason = Reason::content(what, "move away the one that does not belong");
                return Err(format_error(path, reason));
            }
            copies += 1;
            continue;
        }
        if let Some(&first) = of.first() {
            shared = Some((shown(&kept[first].path), shown(&slice.path)));
        }
        of.push(kept.len());
        kept.push(slice);
    }
    if copies > 0 {
        let copies = counted(copies, "slice");
        tracing::warn!(
            "{copies} of {} are copies of others (one SOP Instance UID), and left out",
            shown(path)
        );
    }
    if let Some((a, b)) = shared {
        tracing::warn!("{a} and {b} have one SOP Instance UID and other places: both are taken");
    }
    Ok(Ok(kept))
}

/// The slices of the requested volume of a series.
pub(super) fn chosen(
    path: &Path,
    slices: Vec<Slice>,
    asked: Option<u64>,
) -> Result<Vec<Slice>, VolumeError> {
    let mut volumes = several(slices);
    let choice = FrameChoice::choose(path, &[volumes.len() as u64], asked)?;
    Ok(volumes.swap_remove(choice.index as usize))
}

/// The volumes of a series. Stacks are always separate volumes; slices that share places are separated by the first index that
/// distinguishes them. Without such an index there is one volume.
fn several(slices: Vec<Slice>) -> Vec<Vec<Slice>> {
    let stacks = parted(&slices, &[STACK.to_owned()]).unwrap_or_else(|| vec![slices]);
    stacks.into_iter().flat_map(by_index).collect()
}

/// The volumes of a stack.
fn by_index(slices: Vec<Slice>) -> Vec<Vec<Slice>> {
    if !shares_places(&slices) {
        return vec![slices];
    }
    let names = slices[0].index.iter().map(|index| index.name.clone());
    let names: Vec<String> = names.filter(|name| name != STACK).collect();
    // A single index is tried first, then as few of the first ones together as possible.
    let alone = names.iter().map(std::slice::from_ref);
    let together = (2..=names.len()).map(|count| &names[..count]);
    let volumes = alone.chain(together).filter_map(|names| parted(&slices, names));
    let mut apart = volumes.filter(|volumes| !volumes.iter().any(|volume| shares_places(volume)));
    apart.next().unwrap_or_else(|| vec![slices.clone()])
}

/// The values of these indices of a slice; `None` if it lacks one of them.
fn keys(slice: &Slice, names: &[String]) -> Option<Vec<Key>> {
    let key = |name: &String| slice.index.iter().find(|index| index.name == *name);
    names.iter().map(|name| key(name).map(|index| index.value.clone())).collect()
}

/// Groups slices by their keys, in the order of keys; `None` if a slice has no keys, or all slices have the same.
fn parted(slices: &[Slice], names: &[String]) -> Option<Vec<Vec<Slice>>> {
    let mut keyed: Vec<(Vec<Key>, &Slice)> =
        slices.iter().map(|slice| Some((keys(slice, names)?, slice))).collect::<Option<_>>()?;
    let order = |a: &[Key], b: &[Key]| {
        a.iter().zip(b).fold(Ordering::Equal, |so_far, (a, b)| so_far.then_with(|| a.order(b)))
    };
    sort_by(&mut keyed, |a, b| order(&a.0, &b.0));
    let parts = keyed.chunk_by(|a, b| order(&a.0, &b.0).is_eq());
    let parts: Vec<Vec<Slice>> =
        parts.map(|part| part.iter().map(|(_, slice)| (*slice).clone()).collect()).collect();
    (parts.len() > 1).then_some(parts)
}

/// Whether two slices are at one place along the normal.
fn shares_places(slices: &[Slice]) -> bool {
    let Some(first) = slices.first() else { return false };
    let normal = first.normal();
    let mut at: Vec<f64> = slices.iter().map(|slice| dot(slice.position, normal)).collect();
    at.sort_by(f64::total_cmp);
    at.windows(2).any(|two| two[1] - two[0] < SAME_PLACE)
}
