//! The text before the rows of a table of points: comments, the names of columns, and their units.

use std::path::Path;

use walpha_base::advice::{Setting, advice};
use walpha_base::shown::shown;

use super::columns::{is_of_coordinate, is_unit, name_and_unit};
use super::dialect::number;
use super::lines::{Labelled, Numbered, count, fields_at, is_comment, mark};
use super::rows::is_missing;
use super::{Columns, PointsError, UnknownColumns, format};
use walpha_volume::{LengthUnit, Reason};

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
    /// Reads the lines before the first row or count. Names may follow `#` or `//`. If `given` states the columns, a first line
    /// of other names is not a row. From here on, the lines know which rows begin like comments.
    pub(super) fn read(
        path: &Path,
        lines: &mut Numbered<'_>,
        given: Option<&Columns>,
    ) -> Result<Self, PointsError> {
        let mut remark = None;
        while let Some((_, line)) = lines.peek() {
            let bare = line.trim_start_matches(['#', '/', ' ', '\t']).trim_end();
            // A unit belongs to the name before it.
            let joined = bare.replace(" [", "[").replace(" (", "(");
            let names = names(&joined);
            if let Ok(columns) = Columns::named(&names) {
                lines.next();
                let columns = given.cloned().unwrap_or(columns);
                lines.set_labelled(Labelled::new(&columns, mark(&joined)));
                return Self::with_unit(path, lines, columns, &names)
                    .map_err(|error| unknown(path, &error));
            }
            if bare.is_empty() || bare.to_ascii_lowercase().starts_with("sep=") {
                lines.next();
                continue;
            }
            if is_comment(line) {
                if given.is_some_and(|given| Labelled::new(given, mark(line)).is_row(line)) {
                    break;
                }
                if given.is_none() && may_head(&names, lines) {
                    if is_header(&names, mark(&joined)) {
                        let Err(error) = Columns::named(&names) else {
                            unreachable!("tried above")
                        };
                        return Err(unknown(path, &error));
                    }
                    remark = Some(line.trim());
                }
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
                if is_prose(lines) {
                    let what =
                        "holds text without numbers, and does not look like a table of points";
                    let next = "name a file of points or a volume";
                    return Err(format(path, Reason::content(what, next)));
                }
                let Err(error) = Columns::named(&names) else { unreachable!("tried above") };
                return Err(unknown(path, &error));
            }
            lines.next();
            break;
        }
        if let (Some(given), Some((_, row))) = (given, lines.peek()) {
            lines.set_labelled(Labelled::new(given, mark(row)));
        }
        if let Some(remark) = remark {
            tracing::warn!(
                "{}: {remark:?} is taken for a remark, as it names no x, y or z; if it names the columns, say with \
                 `columns` what they are",
                shown(path)
            );
        }
        say_first_row(path, lines);
        Ok(Self { columns: given.cloned(), unit: LengthUnit::Unstated })
    }

    /// Adds the unit, from brackets behind the names or from a separate line.
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
            if words.len() == names.len() && words.iter().any(|word| is_unit(word)) {
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
    format(path, Reason::content(format!("{FIRST_LINE}: {error}"), error.next))
}

/// Whether none of the first lines holds a number.
fn is_prose(lines: &Numbered<'_>) -> bool {
    /// Enough lines for a header of several, with units.
    const FIRST: usize = 20;
    !lines.contents().take(FIRST).any(|(_, line)| holds_number(line))
}

/// The names in a line.
fn names(line: &str) -> Vec<&str> {
    fields_at(line, mark(line))
}

/// Whether a comment may name the columns: it has a word for each number of the first row, and contains no number.
fn may_head(names: &[&str], lines: &Numbered<'_>) -> bool {
    let is_row = |line: &&str| count(line).is_none();
    let row = lines.contents().map(|(_, line)| line).find(is_row).unwrap_or_default();
    names.len() > 1
        && holds_number(row)
        && !names.iter().any(|name| number(name, true).is_some())
        && [self::names(row).len(), row.split_whitespace().count()].contains(&names.len())
}

/// Whether words that may name columns do so: one of them is the name of a coordinate, or they are separated by a mark. Other
/// words may be a remark.
fn is_header(names: &[&str], mark: Option<char>) -> bool {
    mark.is_some() || names.iter().any(|name| is_of_coordinate(name))
}

/// Whether a line contains a number, or a word for a missing number.
fn holds_number(line: &str) -> bool {
    let words = line.split(|c: char| c.is_whitespace() || ";,\"".contains(c));
    let is_number = |word: &str| number(word, false).is_some() || is_missing(word);
    words.filter(|word| !word.is_empty()).any(is_number)
}

/// Whether a line has an empty field and then 0, 1, 2 and so on, which is how pandas names columns without names.
fn numbered_columns(line: &str) -> bool {
    let words = names(line);
    words.len() > 2 && words[0].is_empty() && is_count_up(&words[1..])
}

fn is_count_up(words: &[&str]) -> bool {
    words.iter().enumerate().all(|(k, word)| word.parse() == Ok(k))
}

/// Reports that a first row 0, 1, 2 is taken for a point, if the other rows are not whole numbers.
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
