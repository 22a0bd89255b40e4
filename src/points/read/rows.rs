use std::path::Path;

use walpha_base::advice::{Setting, advice};

use super::{COLUMNS, Columns, Points, PointsError, RADIUS, format, take_radii};
use crate::volume::Reason;

impl Columns {
    /// Guesses columns from their numbers: x y z, perhaps followed by a value, a normal (of length 1 or 0) or a
    /// colour (whole numbers up to 255).
    fn guess(rows: &[Vec<f64>]) -> Result<Self, Reason> {
        let count = rows.first().map_or(0, Vec::len);
        let vectors = || rows.iter().map(|row| &row[3..]);
        let unit = |v: &[f64]| {
            let square: f64 = v.iter().map(|c| c * c).sum();
            square == 0.0 || (square - 1.0).abs() < 0.02
        };
        let colour = |v: &[f64]| v.iter().all(|c| c.fract() == 0.0 && (0.0..=255.0).contains(c));
        let known = match count {
            3 => vec![0, 1, 2],
            4 => vec![0, 1, 2, 4],
            6 if vectors().all(unit) || vectors().all(colour) => vec![0, 1, 2],
            _ => {
                let example = match count {
                    5 => "x,y,z,weight,value".to_owned(),
                    6 => "x,y,z,nx,ny,nz".to_owned(),
                    _ => "x,y,z".to_owned() + &",-".repeat(count.saturating_sub(3)),
                };
                return Err(Reason::choice(
                    Setting::Columns,
                    format!("has {count} columns, and nothing says what they are"),
                    advice![
                        "name them in a first line, or with ",
                        Setting::Columns,
                        format!(" {example}")
                    ],
                ));
            }
        };
        let column = |place: usize| known.get(place).copied();
        Ok(Self((0..count).map(column).collect()))
    }
}

/// Number of rows from which columns without names are guessed.
const MAX_PENDING: usize = 100;

/// Turns rows of text into points.
pub(super) struct TextRows<'a> {
    path: &'a Path,
    columns: Option<Columns>,
    /// The first lines, while their columns are not known.
    pending: Vec<(u64, Vec<String>)>,
    /// Whether the decimal mark is a comma.
    pub decimal_comma: bool,
    /// The columns without names, if their number matches.
    pub default_columns: Option<Columns>,
    points: Points,
    radii: Option<Vec<f64>>,
}

impl<'a> TextRows<'a> {
    pub(super) fn new(path: &'a Path, columns: Option<Columns>) -> Self {
        let (pending, points) = (Vec::new(), Points::default());
        Self {
            path,
            columns,
            pending,
            decimal_comma: false,
            default_columns: None,
            points,
            radii: None,
        }
    }

    /// Sets the columns, unless they are known.
    pub(super) fn set_columns(&mut self, columns: Columns) {
        self.columns.get_or_insert(columns);
    }

    /// Adds the words of a line.
    pub(super) fn push(&mut self, line: u64, words: &[&str]) -> Result<(), PointsError> {
        if self.columns.is_some() {
            return self.add(line, words);
        }
        let first = self.pending.first().map_or(words.len(), |(_, words)| words.len());
        self.check_width(line, words.len(), first)?;
        self.pending.push((line, words.iter().map(|&word| word.into()).collect()));
        if self.pending.len() < MAX_PENDING { Ok(()) } else { self.flush() }
    }

    /// All points.
    pub(super) fn finish(mut self) -> Result<Points, PointsError> {
        self.flush()?;
        take_radii(self.path, &mut self.points, self.radii)?;
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
            let number = |(k, word): (usize, &String)| {
                self.number(*line, COLUMNS.get(k).copied().unwrap_or("behind"), word)
            };
            rows.push(words.iter().enumerate().map(number).collect::<Result<Vec<_>, _>>()?);
        }
        let width = rows.first().map(Vec::len);
        let defaults = self.default_columns.take_if(|columns| width == Some(columns.len()));
        self.columns = Some(match defaults {
            Some(columns) => columns,
            None => Columns::guess(&rows).map_err(|reason| format(self.path, reason))?,
        });
        let mut pending = pending.into_iter();
        pending.try_for_each(|(line, words)| {
            self.add(line, &words.iter().map(String::as_str).collect::<Vec<_>>())
        })
    }

    fn add(&mut self, line: u64, words: &[&str]) -> Result<(), PointsError> {
        let Some(Columns(columns)) = self.columns.take() else { return Ok(()) };
        self.check_width(line, words.len(), columns.len())?;
        let mut position = [0.0; 3];
        for (word, column) in words.iter().zip(&columns) {
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
        self.columns = Some(Columns(columns));
        Ok(())
    }

    fn check_width(&self, line: u64, found: usize, expected: usize) -> Result<(), PointsError> {
        if found == expected {
            return Ok(());
        }
        let reason = Reason::value(format!(
            "line {line} has {found} columns, but {expected} were named or are in earlier lines"
        ));
        Err(format(self.path, reason))
    }

    fn number(&self, line: u64, name: &str, word: &str) -> Result<f64, PointsError> {
        let comma = self.decimal_comma && !word.contains('.');
        let number = if comma { word.replace(',', ".").parse() } else { word.parse() };
        number.ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| {
            format(
                self.path,
                Reason::value(format!(
                    "line {line}, column {name}: {word:?} is not a finite number"
                )),
            )
        })
    }
}
