use std::path::Path;

use walpha_base::shown::shown;

use super::dialect::{PLAINLY, number, without_marks};
use super::{COLUMNS, Columns, Points, PointsError, RADIUS, format, take_radii};
use crate::{Attributes, Column};
use walpha_volume::Reason;

/// The number of rows from which columns without names are guessed.
const MAX_PENDING: usize = 100;

/// Converts rows of text to points.
pub(super) struct TextRows<'a> {
    path: &'a Path,
    columns: Option<Columns>,
    /// The first lines, while their columns are not known.
    pending: Vec<(u64, Vec<String>)>,
    /// Whether the decimal mark is a comma.
    pub decimal_comma: bool,
    /// Whether commas are between the fields.
    pub at_commas: bool,
    /// Whether rows may have more columns than are known.
    pub open_ended: bool,
    /// The columns to assume without names, if their number matches.
    pub default_columns: Option<Columns>,
    points: Points,
    /// The other columns that are kept, each with its index, while all of it are numbers.
    others: Vec<(usize, Column)>,
    attributes: &'a Attributes,
    radii: Option<Vec<f64>>,
}

impl<'a> TextRows<'a> {
    pub(super) fn new(
        path: &'a Path,
        columns: Option<Columns>,
        attributes: &'a Attributes,
    ) -> Self {
        let column = |name: &str| Column { name: name.to_owned(), values: Vec::new() };
        let others = columns.iter().flat_map(Columns::others);
        let others = others.filter(|(_, name)| attributes.keeps(name));
        let others = others.map(|(index, name)| (index, column(name))).collect();
        Self {
            others,
            attributes,
            path,
            columns,
            pending: Vec::new(),
            decimal_comma: false,
            at_commas: false,
            open_ended: false,
            default_columns: None,
            points: Points::default(),
            radii: None,
        }
    }

    /// Adds the words of a line. Empty ones at its end follow superfluous separators.
    pub(super) fn push(&mut self, line: u64, words: &[&str]) -> Result<(), PointsError> {
        let expected = match (&self.columns, self.pending.first()) {
            (Some(columns), _) => columns.len(),
            (None, Some((_, first))) => first.len(),
            (None, None) => words.iter().rposition(|word| !word.is_empty()).map_or(0, |k| k + 1),
        };
        let spare = words.len().saturating_sub(expected);
        let spare = words.iter().rev().take(spare).take_while(|word| word.is_empty()).count();
        let words = &words[..words.len() - spare];
        if self.columns.is_some() {
            return self.add(line, words);
        }
        self.check_width(line, words.len(), expected)?;
        self.pending.push((line, words.iter().map(|&word| word.into()).collect()));
        if self.pending.len() < MAX_PENDING { Ok(()) } else { self.flush() }
    }

    /// Returns all points.
    pub(super) fn finish(mut self) -> Result<Points, PointsError> {
        self.flush()?;
        take_radii(self.path, &mut self.points, self.radii)?;
        self.points.columns = self.others.into_iter().map(|(_, column)| column).collect();
        Ok(self.points)
    }

    /// Adds the pending lines.
    fn flush(&mut self) -> Result<(), PointsError> {
        let pending = std::mem::take(&mut self.pending);
        if pending.is_empty() {
            return Ok(());
        }
        let mut rows = Vec::new();
        for (line, words) in &pending {
            // The columns behind z have no names yet.
            let number = |(k, word): (usize, &String)| match COLUMNS[..3].get(k) {
                Some(name) => self.number(*line, name, word),
                None => self.number(*line, &(k + 1).to_string(), word),
            };
            rows.push(words.iter().enumerate().map(number).collect::<Result<Vec<_>, _>>()?);
        }
        let width = rows.first().map(Vec::len);
        if self.at_commas
            && width == Some(6)
            && rows.iter().flatten().all(|number| number.fract() == 0.0)
        {
            tracing::warn!(
                "{}: its six columns have whole numbers; the last three are taken for a normal or a colour, and are not read; if they are \
                 something else, or commas mark decimals, name the columns with `columns`",
                shown(self.path)
            );
        }
        let defaults = self.default_columns.take_if(|columns| width == Some(columns.len()));
        self.columns = Some(match defaults {
            Some(columns) => columns,
            None => Columns::guess(self.path, &rows).map_err(|reason| format(self.path, reason))?,
        });
        let mut pending = pending.into_iter();
        pending.try_for_each(|(line, words)| {
            self.add(line, &words.iter().map(String::as_str).collect::<Vec<_>>())
        })
    }

    fn add(&mut self, line: u64, words: &[&str]) -> Result<(), PointsError> {
        let Some(columns) = self.columns.take() else { return Ok(()) };
        self.check_width(line, words.len(), columns.len())?;
        self.add_others(line, words)?;
        let mut position = [0.0; 3];
        for (word, column) in words.iter().zip(&columns.places) {
            let Some(column) = *column else { continue };
            let number = self.number(line, COLUMNS[column], word)?;
            match column {
                3 => self.points.weights.get_or_insert_default().push(number),
                4 => self.points.values.get_or_insert_default().push(number),
                RADIUS => self.radii.get_or_insert_default().push(number),
                axis => position[axis] = number,
            }
        }
        self.points.positions.push(position);
        self.columns = Some(columns);
        Ok(())
    }

    /// Adds the words of a line to the other columns that are kept. Where all are kept, those with other words than numbers are
    /// not.
    fn add_others(&mut self, line: u64, words: &[&str]) -> Result<(), PointsError> {
        let mut others = std::mem::take(&mut self.others);
        let mut wrong = None;
        others.retain_mut(|(index, column)| {
            let word = words.get(*index).copied().unwrap_or_default();
            let number =
                if is_missing(word) { Ok(f64::NAN) } else { self.number(line, &column.name, word) };
            match number {
                Ok(number) => {
                    column.values.push(number);
                    true
                }
                Err(error) => {
                    wrong = Some(error);
                    false
                }
            }
        });
        self.others = others;
        wrong.filter(|_| *self.attributes != Attributes::All).map_or(Ok(()), Err)
    }

    fn check_width(&self, line: u64, found: usize, expected: usize) -> Result<(), PointsError> {
        if found == expected || found > expected && self.open_ended {
            return Ok(());
        }
        let reason = Reason::value(format!(
            "line {line} has {found} columns, but {expected} were named or are in earlier lines"
        ));
        Err(format(self.path, reason))
    }

    fn number(&self, line: u64, name: &str, word: &str) -> Result<f64, PointsError> {
        let finite = number(word, self.decimal_comma).filter(|number| number.is_finite());
        finite.ok_or_else(|| {
            let reason = if is_missing(word) {
                let what = format!("line {line}, column {name}: there is no number ({word:?})");
                Reason::content(what, "leave the line out, or put a number there")
            } else if let Some(without) = without_marks(word) {
                let what = format!(
                    "line {line}, column {name}: {word:?} is not a number, unless its marks group thousands \
                     ({without})"
                );
                Reason::content(what, PLAINLY)
            } else {
                Reason::value(format!(
                    "line {line}, column {name}: {word:?} is not a finite number"
                ))
            };
            format(self.path, reason)
        })
    }
}

/// Whether a word stands for a missing number.
pub(super) fn is_missing(word: &str) -> bool {
    ["", "nan", "na", "n/a", "null", "none", "-"]
        .iter()
        .any(|known| known.eq_ignore_ascii_case(word))
}
