//! The numbers in the names of slices: one of them must count the slices without a gap.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use walpha_base::shown::shown;
use walpha_base::sort::sort_by;

use crate::error::format_error;
use crate::{Reason, VolumeError};

/// The name of a slice without its extension.
struct Name {
    /// The text around the numbers.
    around: Vec<String>,
    /// The numbers in it.
    numbers: Vec<Number>,
}

/// A run of digits without leading zeros, preceded by its length: of two numbers, the longer one is larger.
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

/// Refuses slices that form several groups, or of which one is missing. They are in the natural order of their names.
pub(super) fn check(folder: &Path, paths: &[PathBuf]) -> Result<(), VolumeError> {
    let names: Vec<Name> = paths.iter().map(|path| Name::of(path)).collect();
    if names.len() < 2 {
        return Ok(());
    }
    if names.iter().all(|name| name.numbers.is_empty()) {
        tracing::warn!(
            "{}: its slices have no numbers, and are taken in the order of their names",
            shown(folder)
        );
        return Ok(());
    }
    let Some(reason) = wrong(paths, &names) else { return Ok(()) };
    if by_real_numbers(paths).is_some() {
        tracing::warn!(
            "{}: the numbers of its slices are taken with their decimals and signs, from {} to {}",
            shown(folder),
            file_name(&paths[0]),
            file_name(&paths[paths.len() - 1])
        );
        return Ok(());
    }
    Err(format_error(folder, reason))
}

/// What is wrong with names whose numbers are whole.
fn wrong(paths: &[PathBuf], names: &[Name]) -> Option<Reason> {
    let first = names.first()?;
    match names.iter().position(|name| name.around != first.around) {
        Some(other) => Some(groups(&paths[0], &paths[other])),
        None => check_row(paths, names),
    }
}

/// Orders the slices by a number with decimals or signs in their names, if that number counts them in equal steps and whole
/// numbers do not.
pub(super) fn by_real_numbers(paths: &[PathBuf]) -> Option<Vec<PathBuf>> {
    let names: Vec<Name> = paths.iter().map(|path| Name::of(path)).collect();
    let is_apart = |name: &Name| {
        let before = &name.around[..name.numbers.len()];
        before.iter().skip(1).any(|text| text == ".")
            || before.iter().any(|text| text.ends_with('-'))
    };
    if names.len() < 2 || !names.iter().any(is_apart) || wrong(paths, &names).is_none() {
        return None;
    }
    let named: Vec<(Vec<String>, Vec<f64>)> = paths.iter().map(|path| real_numbers(path)).collect();
    let (around, numbers) = named.first()?;
    let varies = |i: &usize| named.iter().any(|(_, other)| other[*i] != numbers[*i]);
    if named.iter().any(|(other, _)| other != around) {
        return None;
    }
    let varying: Vec<usize> = (0..numbers.len()).filter(varies).collect();
    let &[i] = varying.as_slice() else { return None };
    let mut order: Vec<usize> = (0..paths.len()).collect();
    sort_by(&mut order, |&a, &b| named[a].1[i].total_cmp(&named[b].1[i]));
    let steps: Vec<f64> =
        order.windows(2).map(|pair| named[pair[1]].1[i] - named[pair[0]].1[i]).collect();
    let is_even =
        steps.iter().all(|step| *step > 0.0 && (step - steps[0]).abs() <= 1e-6 * steps[0]);
    is_even.then(|| order.into_iter().map(|i| paths[i].clone()).collect())
}

/// The numbers in a name, with their decimals and signs, and the text around them.
fn real_numbers(path: &Path) -> (Vec<String>, Vec<f64>) {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let (mut around, mut numbers) = (vec![String::new()], Vec::new());
    let mut rest = stem.as_str();
    while let Some(first) = rest.find(|c: char| c.is_ascii_digit()) {
        let count = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        let start = if rest[..first].ends_with('-') { first - 1 } else { first };
        let whole = first + count(&rest[first..]);
        let decimals = rest[whole..].strip_prefix('.').map_or(0, count);
        let end = if decimals > 0 { whole + 1 + decimals } else { whole };
        around.last_mut().expect("there is one").push_str(&rest[..start]);
        numbers.push(rest[start..end].parse().unwrap_or(f64::NAN));
        around.push(String::new());
        rest = &rest[end..];
    }
    around.last_mut().expect("there is one").push_str(rest);
    (around, numbers)
}

/// What is wrong with names that differ only in their numbers.
fn check_row(paths: &[PathBuf], names: &[Name]) -> Option<Reason> {
    let column = |i: usize| names.iter().map(move |name| &name.numbers[i]);
    let distinct = |i: usize| column(i).collect::<BTreeSet<_>>().len();
    let varying: Vec<usize> = (0..names[0].numbers.len()).filter(|&i| distinct(i) > 1).collect();
    let is_row = |i: &&usize| distinct(**i) == names.len() && column(**i).is_sorted();
    let rows: Vec<usize> = varying.iter().filter(is_row).copied().collect();
    if rows.is_empty() {
        // Two slices have the same number, and the first of several numbers distinguishes them.
        let last = *varying.last().unwrap_or(&0);
        let mut first = BTreeMap::new();
        let again = |i: usize| first.insert(&names[i].numbers[last], i).map(|earlier| (earlier, i));
        let (a, b) = (0..names.len()).find_map(again).unwrap_or((0, 1));
        return Some(groups(&paths[a], &paths[b]));
    }
    let gaps: Option<Vec<Reason>> = rows.iter().map(|&i| gap(paths, column(i))).collect();
    gaps?.into_iter().next()
}

/// The first gap in a sequence of numbers.
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
            &["z0.25.png", "z0.5.png", "z0.75.png", "z1.0.png"],
            &["z9.5.png", "z10.0.png", "z10.5.png"],
            &["z-10.png", "z-5.png", "z0.png", "z5.png"],
            &[
                "s99999999999999999999999999999999999999999.png",
                "s99999999999999999999999999999999999999999990.png",
            ],
        ] {
            assert_eq!(told(names), None, "{names:?}");
        }
    }

    #[test]
    fn decimals_and_signs_order_slices() {
        let sorted = |names: &[&str]| {
            let paths: Vec<PathBuf> = names.iter().map(PathBuf::from).collect();
            let paths = by_real_numbers(&paths)?;
            Some(paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>())
        };
        let expected = |names: &[&str]| Some(names.iter().map(ToString::to_string).collect());
        assert_eq!(
            sorted(&["s_0.1.tif", "s_0.2.tif", "s_0.15.tif"]),
            expected(&["s_0.1.tif", "s_0.15.tif", "s_0.2.tif"])
        );
        assert_eq!(
            sorted(&["z-1.png", "z-2.png", "z0.png"]),
            expected(&["z-2.png", "z-1.png", "z0.png"])
        );
        // They are a sequence of whole numbers.
        assert_eq!(sorted(&["s1.1.png", "s1.2.png", "s1.3.png"]), None);
        assert_eq!(sorted(&["a-1.png", "a-2.png"]), None);
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
            (&["z0.25.png", "z0.5.png", "z1.0.png"], "several groups"),
            (&["a-1.png", "a-2.png", "a-4.png"], "misses slice 3"),
            (&["cover.png", "s1.png", "s2.png"], "cover.png and s1.png"),
        ] {
            let told = told(names).unwrap_or_default();
            assert!(told.contains(words), "{names:?}: {told}");
        }
    }
}
