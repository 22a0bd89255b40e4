use std::path::Path;
use std::str::FromStr;

use super::{COLUMNS, Points, PointsError, format};

/// What the columns of a table of points hold, in their order: of the names `x`, `y`, `z`, `weight` and
/// `value` each at most once, in any case; columns of other names are passed over. Where all names are
/// among these, and there is no `z`, the points lie in the plane z = 0.
///
/// ```
/// use walpha::points::Columns;
///
/// let columns: Columns = "x,y,z,nx,ny,nz".parse()?;
/// assert_eq!(columns.len(), 6);
/// assert!("x,y,nx,ny,nz".parse::<Columns>().is_err(), "z is missing");
/// assert!("x,y,value".parse::<Columns>().is_ok(), "points of a plane");
/// # Ok::<(), walpha::points::UnknownColumns>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Columns(Vec<Option<usize>>);

/// Names that do not say where x, y and z are.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "columns {names:?} {what}; name each column of the file, x, y and z once each, perhaps weight and \
     value, and others as you like, as in x,y,z,nx,ny,nz"
)]
pub struct UnknownColumns {
    names: String,
    what: String,
}

#[expect(clippy::len_without_is_empty, reason = "there are two at least")]
impl Columns {
    /// The number of columns.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// By their names.
    ///
    /// # Errors
    /// x or y is missing, or z among names that say more than these; or one of the names that are read
    /// stands twice.
    pub fn named(names: &[&str]) -> Result<Self, UnknownColumns> {
        let known = |name: &&str| COLUMNS.iter().position(|c| c.eq_ignore_ascii_case(name.trim()));
        let columns: Vec<Option<usize>> = names.iter().map(known).collect();
        let of_plane = columns.iter().all(Option::is_some);
        for (place, name) in COLUMNS.iter().enumerate() {
            let count = columns.iter().filter(|&&column| column == Some(place)).count();
            let what = match count {
                0 if place == 2 && of_plane => continue,
                0 if place < 3 => format!("do not name {name}"),
                0 | 1 => continue,
                _ => format!("name {name} twice"),
            };
            return Err(UnknownColumns { names: names.join(","), what });
        }
        Ok(Self(columns))
    }

    /// By the numbers in them: x y z, perhaps with a value, with a normal (of length 1 or 0) or with a
    /// colour (whole numbers up to 255).
    fn guessed(rows: &[Vec<f64>]) -> Result<Self, String> {
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
                return Err(format!(
                    "has {count} columns, and nothing says what they are: name them in a first line, or \
                     with --columns {example}"
                ));
            }
        };
        let column = |place: usize| known.get(place).copied();
        Ok(Self((0..count).map(column).collect()))
    }
}

impl FromStr for Columns {
    type Err = UnknownColumns;

    fn from_str(text: &str) -> Result<Self, UnknownColumns> {
        Self::named(&text.split(',').collect::<Vec<_>>())
    }
}

/// Rows that are looked at before anything is said about columns without names.
const LOOKED_AT: usize = 100;

/// Makes points of rows of text.
pub(super) struct Rows<'a> {
    path: &'a Path,
    columns: Option<Columns>,
    /// The first lines, while their columns are not known.
    waiting: Vec<(u64, Vec<String>)>,
    /// Whether 0,5 is a half.
    pub decimal_comma: bool,
    points: Points,
}

impl<'a> Rows<'a> {
    pub fn new(path: &'a Path, columns: Option<Columns>) -> Self {
        Self { path, columns, waiting: Vec::new(), decimal_comma: false, points: Points::default() }
    }

    /// Says what the columns are, unless the user has.
    pub fn are(&mut self, columns: Columns) {
        self.columns.get_or_insert(columns);
    }

    /// Adds the words of a line.
    pub fn push(&mut self, line: u64, words: &[&str]) -> Result<(), PointsError> {
        if self.columns.is_some() {
            return self.add(line, words);
        }
        let first = self.waiting.first().map_or(words.len(), |(_, words)| words.len());
        self.same(line, words.len(), first)?;
        self.waiting.push((line, words.iter().map(|&word| word.into()).collect()));
        if self.waiting.len() < LOOKED_AT { Ok(()) } else { self.look() }
    }

    /// The points.
    pub fn finish(mut self) -> Result<Points, PointsError> {
        self.look()?;
        Ok(self.points)
    }

    /// Adds the lines that wait.
    fn look(&mut self) -> Result<(), PointsError> {
        let waiting = std::mem::take(&mut self.waiting);
        if waiting.is_empty() {
            return Ok(());
        }
        let mut rows = Vec::new();
        for (line, words) in &waiting {
            let number = |(k, word): (usize, &String)| {
                self.number(*line, COLUMNS.get(k).copied().unwrap_or("behind"), word)
            };
            rows.push(words.iter().enumerate().map(number).collect::<Result<Vec<_>, _>>()?);
        }
        let guessed = Columns::guessed(&rows);
        self.columns = Some(guessed.map_err(|what| format(self.path, what))?);
        let mut waiting = waiting.into_iter();
        waiting.try_for_each(|(line, words)| {
            self.add(line, &words.iter().map(String::as_str).collect::<Vec<_>>())
        })
    }

    fn add(&mut self, line: u64, words: &[&str]) -> Result<(), PointsError> {
        let Some(Columns(columns)) = self.columns.take() else { return Ok(()) };
        self.same(line, words.len(), columns.len())?;
        let mut position = [0.0; 3];
        for (word, column) in words.iter().zip(&columns) {
            let Some(column) = *column else { continue };
            let number = self.number(line, COLUMNS[column], word)?;
            match column {
                3 => self.points.weights.get_or_insert_default().push(number),
                4 => self.points.values.get_or_insert_default().push(number),
                axis => position[axis] = number,
            }
        }
        self.points.positions.push(position);
        self.columns = Some(Columns(columns));
        Ok(())
    }

    fn same(&self, line: u64, found: usize, expected: usize) -> Result<(), PointsError> {
        if found == expected {
            return Ok(());
        }
        let what =
            format!("line {line} has {found} columns, but there are {expected} before or named");
        Err(format(self.path, what))
    }

    fn number(&self, line: u64, name: &str, word: &str) -> Result<f64, PointsError> {
        let comma = self.decimal_comma && !word.contains('.');
        let number = if comma { word.replace(',', ".").parse() } else { word.parse() };
        number.ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| {
            format(self.path, format!("line {line}, column {name}: {word:?} is no finite number"))
        })
    }
}
