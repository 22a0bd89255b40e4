use std::io::BufRead;
use std::path::Path;

use super::super::lines::Lines;
use super::super::{format_error, io_error};
use crate::{Reason, VolumeError};

/// The names a `data file` field gives: one, a `LIST` of the lines that follow, or a numbered row
/// `pattern min max step`, where the pattern has one `%d` or, say, `%03d`.
pub(super) fn named(
    path: &Path,
    value: &str,
    lines: &mut Lines<impl BufRead>,
) -> Result<Vec<String>, VolumeError> {
    if value.starts_with("LIST") {
        let mut names = Vec::new();
        while let Some(line) = lines.read_line().map_err(io_error(path))? {
            if !line.trim().is_empty() {
                names.push(line.trim().to_owned());
            }
        }
        return Ok(names);
    }
    let words: Vec<&str> = value.split_whitespace().collect();
    match numbered(&words) {
        Some(names) => names.map_err(|reason| format_error(path, reason)),
        None => Ok(vec![value.to_owned()]),
    }
}

/// The files of a numbered sequence; `None` if the words do not describe one.
pub(crate) fn numbered(words: &[&str]) -> Option<Result<Vec<String>, Reason>> {
    /// A row has a file a slice, at most.
    const MAX_FILES: i64 = 1 << 20;
    let &[pattern, first, last, step, ..] = words else { return None };
    let (before, rest) = pattern.split_once('%')?;
    let (width, after) = rest.split_once('d')?;
    let zeros = width.starts_with('0');
    let width: usize = if width.is_empty() { 0 } else { width.parse().ok()? };
    let [first, last, step] = [first, last, step].map(|number| number.parse::<i32>().ok());
    let (first, last, step) = (i64::from(first?), i64::from(last?), i64::from(step?));
    if step == 0 || (last - first) / step < 0 || (last - first) / step >= MAX_FILES || width > 20 {
        return Some(Err(Reason::header(format!(
            "numbers its data files {}, which is not a row",
            words.join(" ")
        ))));
    }
    let name = |i: i64| {
        let number = first + i * step;
        let number = if zeros { format!("{number:0width$}") } else { format!("{number:width$}") };
        format!("{before}{number}{after}")
    };
    Some(Ok((0..=(last - first) / step).map(name).collect()))
}
