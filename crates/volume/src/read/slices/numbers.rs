//! The numbers in the names of slices: one of them counts the slices, without a gap.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use walpha_base::shown::shown;

use crate::error::format_error;
use crate::{Reason, VolumeError};

/// A name without its extension.
struct Name {
    /// The text around the numbers.
    around: Vec<String>,
    /// The numbers in it.
    numbers: Vec<Number>,
}

/// A run of digits without zeros in front, behind their number: the longer one is the larger one.
type Number = (usize, String);

impl Name {
    fn of(path: &Path) -> Self {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let (mut around, mut numbers) = (vec![String::new()], Vec::new());
        let mut rest = stem.as_str();
        while let Some(first) = rest.find(|c: char| c.is_ascii_digit()) {
            let (before, digits) = rest.split_at(first);
            let end = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
            around.last_mut().expect("there is one").push_str(before);
            let significant = digits[..end].trim_start_matches('0');
            numbers.push((significant.len(), significant.to_owned()));
            around.push(String::new());
            rest = &digits[end..];
        }
        around.last_mut().expect("there is one").push_str(rest);
        Self { around, numbers }
    }
}

/// Refuses slices that are several groups, or of which one is missing. They come in the natural order of their
/// names.
pub(super) fn check(folder: &Path, paths: &[PathBuf]) -> Result<(), VolumeError> {
    let names: Vec<Name> = paths.iter().map(|path| Name::of(path)).collect();
    let ([first, ..], true) = (&names[..], names.len() > 1) else { return Ok(()) };
    if names.iter().all(|name| name.numbers.is_empty()) {
        tracing::warn!(
            "{}: its slices have no numbers, and are taken in the order of their names",
            shown(folder)
        );
        return Ok(());
    }
    let reason = match names.iter().position(|name| name.around != first.around) {
        Some(other) => Some(groups(&paths[0], &paths[other])),
        None => check_row(paths, &names),
    };
    reason.map_or(Ok(()), |reason| Err(format_error(folder, reason)))
}

/// What is wrong with names that differ in their numbers alone.
fn check_row(paths: &[PathBuf], names: &[Name]) -> Option<Reason> {
    let column = |i: usize| names.iter().map(move |name| &name.numbers[i]);
    let distinct = |i: usize| column(i).collect::<BTreeSet<_>>().len();
    let varying: Vec<usize> = (0..names[0].numbers.len()).filter(|&i| distinct(i) > 1).collect();
    let is_row = |i: &&usize| distinct(**i) == names.len() && column(**i).is_sorted();
    let rows: Vec<usize> = varying.iter().filter(is_row).copied().collect();
    if rows.is_empty() {
        // Two slices of one number, which the first of several numbers tells apart.
        let last = *varying.last().unwrap_or(&0);
        let mut first = BTreeMap::new();
        let again = |i: usize| first.insert(&names[i].numbers[last], i).map(|earlier| (earlier, i));
        let (a, b) = (0..names.len()).find_map(again).unwrap_or((0, 1));
        return Some(groups(&paths[a], &paths[b]));
    }
    let gaps: Option<Vec<Reason>> = rows.iter().map(|&i| gap(paths, column(i))).collect();
    gaps?.into_iter().next()
}

/// The first gap in a row of numbers.
fn gap<'a>(paths: &[PathBuf], numbers: impl Iterator<Item = &'a Number>) -> Option<Reason> {
    // Numbers of more than 38 digits are not counts.
    let value =
        |(_, digits): &Number| if digits.is_empty() { Some(0) } else { digits.parse().ok() };
    let numbers: Vec<u128> = numbers.map(value).collect::<Option<_>>()?;
    let steps = || numbers.windows(2).map(|pair| pair[1] - pair[0]);
    let step = steps().min()?;
    let place = steps().position(|other| other != step)?;
    let [before, after] = [&paths[place], &paths[place + 1]].map(|path| file_name(path));
    let what = format!("misses slice {}: {after} follows {before}", numbers[place] + step);
    Some(Reason::content(what, "add what is missing, or number the slices without gaps"))
}

fn groups(one: &Path, other: &Path) -> Reason {
    let [one, other] = [one, other].map(file_name);
    let what = format!("holds several groups of slices, to which {one} and {other} belong");
    Reason::content(what, "give each group a folder of its own, and name one")
}

fn file_name(path: &Path) -> String {
    shown(Path::new(path.file_name().unwrap_or_default()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(names: &[&str]) -> Option<String> {
        let paths: Vec<PathBuf> = names.iter().map(PathBuf::from).collect();
        check(Path::new("folder"), &paths).err().map(|error| error.to_string())
    }

    #[test]
    fn rows_without_gaps_pass() {
        for names in [
            &["s1.png", "s2.png", "s3.png"][..],
            &["s008.png", "s09.png", "s10.png"],
            &["s10.png", "s20.png", "s30.png"],
            &["t0_z1.png", "t0_z2.png", "t1_z3.png"],
            &["a1_x7.png", "a2_x9.png", "a3_x1.png"],
            &["one.png"],
            &["front.png", "middle.png"],
            &["only7.png"],
            &[
                "s99999999999999999999999999999999999999999.png",
                "s99999999999999999999999999999999999999999990.png",
            ],
        ] {
            assert_eq!(told(names), None, "{names:?}");
        }
    }

    #[test]
    fn gaps_and_groups_are_named() {
        for (names, words) in [
            (&["s1.png", "s2.png", "s4.png"][..], "misses slice 3: s4.png follows s2.png"),
            (&["s004.png", "s006.png", "s007.png"], "misses slice 5: s006.png follows s004.png"),
            (&["s10.png", "s20.png", "s40.png"], "misses slice 30"),
            (&["t0_z1.png", "t0_z2.png", "t1_z1.png", "t1_z2.png"], "t0_z1.png and t1_z1.png"),
            (&["a1.png", "b1.png"], "a1.png and b1.png"),
            (&["s01.png", "s1.png"], "s01.png and s1.png"),
            (&["cover.png", "s1.png", "s2.png"], "cover.png and s1.png"),
        ] {
            let told = told(names).unwrap_or_default();
            assert!(told.contains(words), "{names:?}: {told}");
        }
    }
}
