//! What comes before the rows of a table of points: comments, the names of columns, and their units.

use std::path::Path;

use walpha_base::advice::{Setting, advice};
use walpha_base::shown::shown;

use super::columns::name_and_unit;
use super::dialect::{number, split_at};
use super::lines::{Numbered, count};
use super::rows::is_missing;
use super::{Columns, PointsError, UnknownColumns, format};
use crate::volume::{LengthUnit, Reason};

/// The columns that a table names, and their unit.
#[derive(Default)]
pub(super) struct Header {
    pub columns: Option<Columns>,
    pub unit: LengthUnit,
}

/// What the first line must be, for error messages.
const FIRST_LINE: &str = "its first line must name the columns x, y and z, perhaps weight (or radius) and \
                          value, or hold numbers";

impl Header {
    /// Reads the lines before the first row or count. Names follow `#` or `//`, or nothing. A first line of other names is
    /// no row where `given` says what the columns are.
    pub(super) fn read(
        path: &Path,
        lines: &mut Numbered<'_>,
        given: Option<&Columns>,
    ) -> Result<Self, PointsError> {
        while let Some((_, line)) = lines.peek() {
            let bare = line.trim_start_matches(['#', '/', ' ', '\t']).trim_end();
            // Units belong to the names before them.
            let joined = bare.replace(" [", "[").replace(" (", "(");
            let names = names(&joined);
            let is_comment = line.trim_start().starts_with(['#', '/']);
            if let Ok(columns) = Columns::named(&names) {
                lines.next();
                let columns = given.cloned().unwrap_or(columns);
                return Self::with_unit(path, lines, columns, &names)
                    .map_err(|error| unknown(path, &error));
            }
            if bare.is_empty() || is_comment || bare.to_ascii_lowercase().starts_with("sep=") {
                lines.next();
                continue;
            }
            if names[0].eq_ignore_ascii_case("ncols") {
                let what = "is a grid of heights (ESRI ASCII), not a list of points";
                return Err(format(path, Reason::unsupported(what, "convert it to x,y,z")));
            }
            if numbered_columns(line) {
                if given.is_none() {
                    let reason = Reason::choice(
                        Setting::Columns,
                        format!("its first line, {bare}, numbers the columns and names none"),
                        advice!["name them with ", Setting::Columns, " -,x,y,z"],
                    );
                    return Err(format(path, reason));
                }
                lines.next();
                continue;
            }
            if count(bare).is_some() || holds_number(bare) {
                break;
            }
            if given.is_none() {
                let Err(error) = Columns::named(&names) else { unreachable!("tried above") };
                return Err(unknown(path, &error));
            }
            lines.next();
            break;
        }
        say_first_row(path, lines);
        Ok(Self { columns: given.cloned(), unit: LengthUnit::Unstated })
    }

    /// Takes the unit, from brackets behind the names or from a line of its own.
    fn with_unit(
        path: &Path,
        lines: &mut Numbered<'_>,
        columns: Columns,
        names: &[&str],
    ) -> Result<Self, UnknownColumns> {
        let mut units: Vec<_> = names.iter().map(|name| name_and_unit(name).1).collect();
        if let Some((_, line)) = lines.contents().next()
            && !holds_number(line)
            && units.iter().all(Option::is_none)
        {
            let words = self::names(line);
            if words.len() == names.len() {
                let words =
                    words.into_iter().map(|word| word.trim_matches(['[', ']', '(', ')', ' ']));
                units = words.map(|word| Some(word).filter(|word| !word.is_empty())).collect();
                lines.next_content();
            }
        }
        let stated = columns.unit(names, &units)?;
        let unit = stated.map(LengthUnit::named).unwrap_or_default();
        if let (Some(name), false) = (stated, unit.is_known()) {
            tracing::warn!("{}: the unit {name} is not known, and passed over", shown(path));
        }
        Ok(Self { columns: Some(columns), unit })
    }
}

/// The error for names that do not identify x, y and z.
fn unknown(path: &Path, error: &UnknownColumns) -> PointsError {
    format(path, Reason::content(format!("{FIRST_LINE}: {error}"), error.advice()))
}

/// The names in a line, which are between semicolons, tabs, commas, or else blanks.
fn names(line: &str) -> Vec<&str> {
    let mark = [';', '\t', ','].into_iter().find(|&mark| line.contains(mark));
    let mut names = match mark {
        Some(mark) => split_at(line, mark),
        None => line.split_whitespace().collect(),
    };
    while names.len() > 1 && names.last().is_some_and(|name| name.is_empty()) {
        names.pop();
    }
    names
}

/// Whether a line has a number in it, or a word for a missing one.
fn holds_number(line: &str) -> bool {
    let words = line.split(|c: char| c.is_whitespace() || ";,\"".contains(c));
    let is_number = |word: &str| number(word, false).is_some() || is_missing(word);
    words.filter(|word| !word.is_empty()).any(is_number)
}

/// Whether a line has an empty field and then 0, 1, 2 and so on, as pandas names columns that have no names.
fn numbered_columns(line: &str) -> bool {
    let words = names(line);
    words.len() > 2 && words[0].is_empty() && is_count_up(&words[1..])
}

fn is_count_up(words: &[&str]) -> bool {
    words.iter().enumerate().all(|(k, word)| word.parse() == Ok(k))
}

/// Says that a first row 0, 1, 2 is a point, where the others are not whole numbers.
fn say_first_row(path: &Path, lines: &Numbered<'_>) {
    let mut rows = lines.contents();
    if let (Some((_, first)), Some((_, second))) = (rows.next(), rows.next())
        && names(first).len() > 1
        && is_count_up(&names(first))
        && second.contains('.')
    {
        tracing::warn!(
            "{}: its first line, {first}, is taken for a point, as numbers are not names; remove the line if it \
             numbers the columns",
            shown(path)
        );
    }
}
