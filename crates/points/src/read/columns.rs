use std::path::Path;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use walpha_base::advice::{Advice, Advise, Setting, advice};
use walpha_base::shown::shown;

use walpha_volume::{LengthUnit, Reason};

/// The names of the columns that are read.
pub(crate) const COLUMNS: [&str; 6] = ["x", "y", "z", "weight", "value", "radius"];
/// The index in [`COLUMNS`] of the weight.
pub(super) const WEIGHT: usize = 3;
/// The index in [`COLUMNS`] of the value.
pub(super) const VALUE: usize = 4;
/// The index in [`COLUMNS`] of the radius, whose square is a weight.
pub(super) const RADIUS: usize = 5;

/// The columns of a table of points, in order. The names `x`, `y`, `z`, `weight`, `value` and `radius` may occur once each, in
/// any letter case, followed by a unit in brackets, or preceded by `CloudCompare`'s `scalar_`. Columns with other names are
/// skipped. If there are no other names and no `z`, the points lie in the plane z = 0. If x, y or z is not named, the surveying
/// names `easting`, `northing`, and `height`, `elevation` or `altitude` replace it, or `ParaView`'s `Points:0` and so on; if
/// there is no `value`, `intensity` or `reflectance` is the value.
///
/// ```
/// use walpha_points::Columns;
///
/// let columns: Columns = "x,y,z,nx,ny,nz".parse()?;
/// assert_eq!(columns.len(), 6);
/// assert!("x,y,nx,ny,nz".parse::<Columns>().is_err(), "z is missing");
/// assert!("x,y,value".parse::<Columns>().is_ok(), "points of a plane");
/// # Ok::<(), walpha_points::UnknownColumns>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Columns {
    /// The index in [`COLUMNS`] of each; `None` for others.
    pub(super) places: Vec<Option<usize>>,
    /// The names of all; empty if they have none.
    pub(super) names: Vec<String>,
}

/// The error for names that do not identify x, y and z.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("columns {names:?} {what}")]
pub struct UnknownColumns {
    names: String,
    what: String,
    pub(super) next: &'static str,
}

impl Advise for UnknownColumns {
    fn advice(&self) -> Option<Advice> {
        Some(self.next.into())
    }
}

/// The advice for names without an x, y or z.
const NAME_THEM: &str = "name each column of the file, x, y and z once each, perhaps weight (or radius) and \
                         value, and others as you like, as in x,y,z,nx,ny,nz";

/// Synonyms of x, y, z and the value, each with the index of its column in [`COLUMNS`]. They are used if a file has no column
/// with the name itself.
const SYNONYMS: [(usize, &[&str]); 5] = [
    (0, &["easting", "points:0", "points_0"]),
    (1, &["northing", "points:1", "points_1"]),
    (2, &["height", "elevation", "altitude", "points:2", "points_2"]),
    (VALUE, &["intensity"]),
    (VALUE, &["reflectance"]),
];

/// The least number of rows whose first column may number the points; fewer may count by chance.
const LEAST_COUNTED: usize = 4;

/// Names of angles, which cannot be coordinates.
const ANGLES: [&str; 5] = ["lon", "lat", "lng", "longitude", "latitude"];

/// Units of angles.
const DEGREES: [&str; 5] = ["deg", "degree", "degrees", "°", "rad"];

/// Whether a name or its unit denotes an angle.
fn is_angle(name: &str) -> bool {
    let (name, unit) = name_and_unit(name);
    is_among(name, &ANGLES) || unit.is_some_and(|unit| is_among(unit, &DEGREES))
}

/// Whether a word among others shows that they are names of columns: a part of it is x, y or z, or an angle, as in `X-coord` and
/// `lon_deg`.
pub(super) fn is_of_coordinate(word: &str) -> bool {
    const PLANE: [&str; 2] = ["easting", "northing"];
    is_angle(word)
        || word
            .split(|c: char| !c.is_alphanumeric())
            .any(|part| [&COLUMNS[..3], &PLANE, &ANGLES].iter().any(|known| is_among(part, known)))
}

/// Whether a name is one of these, in any letter case.
fn is_among(name: &str, known: &[&str]) -> bool {
    known.iter().any(|known| known.eq_ignore_ascii_case(name))
}

/// The unit of which another one is the square, as mm is of mm2, mm^2 and mm².
fn root(unit: &str) -> Option<&str> {
    let length = unit.strip_suffix('²').or_else(|| unit.strip_suffix('2'))?;
    Some(length.trim_end_matches(['^', '*', ' '])).filter(|length| !length.is_empty())
}

/// Whether a word in a line below the names is a unit that is known, of a column that is read, or stands in brackets.
pub(super) fn is_unit(word: &str) -> bool {
    let bare = word.trim_matches(['[', ']', '(', ')', ' ']);
    let is_length = |unit: &str| LengthUnit::named(unit).is_known();
    word.starts_with(['[', '('])
        || is_length(bare)
        || is_among(bare, &DEGREES)
        || root(bare).is_some_and(is_length)
}

/// Separates a name, without white space and quotes, from a unit in brackets.
pub(super) fn name_and_unit(text: &str) -> (&str, Option<&str>) {
    let text = text.trim_matches(|c: char| c.is_whitespace() || c == '"' || c == '\'');
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, unit)) = text.strip_suffix(close).and_then(|text| text.rsplit_once(open))
            && !name.trim().is_empty()
        {
            return (name.trim(), Some(unit.trim()).filter(|unit| !unit.is_empty()));
        }
    }
    (text, None)
}

/// The name of a scalar field written by `CloudCompare`, without its prefix.
fn scalar(name: &str) -> Option<&str> {
    let (prefix, name) = name.split_at_checked(7)?;
    prefix.eq_ignore_ascii_case("scalar_").then_some(name)
}

/// The column of each name, as its index in [`COLUMNS`]; `None` for other names.
pub(super) fn places(names: &[&str]) -> Vec<Option<usize>> {
    let names: Vec<&str> = names.iter().map(|name| name_and_unit(name).0).collect();
    let place = |name: &str| COLUMNS.iter().position(|known| known.eq_ignore_ascii_case(name));
    let mut places: Vec<Option<usize>> = names.iter().map(|name| place(name)).collect();
    let mut stand_in = |column: usize, is_it: &dyn Fn(&str) -> bool| {
        if !places.contains(&Some(column)) {
            let others = places.iter_mut().zip(&names).filter(|(place, _)| place.is_none());
            others.filter(|(_, name)| is_it(name)).for_each(|(place, _)| *place = Some(column));
        }
    };
    for column in 3..COLUMNS.len() {
        stand_in(column, &|name| scalar(name).is_some_and(|name| place(name) == Some(column)));
    }
    for (column, known) in SYNONYMS {
        stand_in(column, &|name| is_among(scalar(name).unwrap_or(name), known));
    }
    places
}

#[expect(clippy::len_without_is_empty, reason = "there are at least two")]
impl Columns {
    /// The number of columns.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// The meaning of each column: x, y, z, weight, value or radius, or nothing that is read.
    pub fn meanings(&self) -> Vec<Option<&'static str>> {
        self.places.iter().map(|place| place.map(|place| COLUMNS[place])).collect()
    }

    /// Columns of which only these places are known.
    pub(super) fn without_names(places: Vec<Option<usize>>) -> Self {
        Self { places, names: Vec::new() }
    }

    /// The columns that are none of the known ones: their indices and names.
    pub(super) fn others(&self) -> impl Iterator<Item = (usize, &str)> {
        let others = self.places.iter().zip(&self.names).enumerate();
        others
            .filter(|(_, (place, name))| place.is_none() && !["", "-"].contains(&name.as_str()))
            .map(|(index, (_, name))| (index, name.as_str()))
    }

    /// The columns with these names.
    ///
    /// # Errors
    /// x or y is missing; z is missing and other columns than the known ones are named; or a known name occurs twice.
    pub fn named(names: &[&str]) -> Result<Self, UnknownColumns> {
        let columns = places(names);
        let is_planar = columns.iter().all(Option::is_some);
        for (place, name) in COLUMNS.iter().enumerate() {
            let count = columns.iter().filter(|&&column| column == Some(place)).count();
            let (what, next) = match count {
                0 if place == 2 && is_planar => continue,
                0 if place < 3 && names.iter().any(|name| is_angle(name)) => (
                    "name longitude and latitude, which are angles, not lengths".to_owned(),
                    "project them to a plane first, as UTM does",
                ),
                0 if place < 3 => (format!("do not name {name}"), NAME_THEM),
                0 | 1 => continue,
                _ => {
                    let these =
                        names.iter().zip(&columns).filter(|(_, column)| **column == Some(place));
                    let these: Vec<&str> = these.map(|(name, _)| *name).collect();
                    (format!("name {name} twice: {}", these.join(", ")), NAME_THEM)
                }
            };
            return Err(UnknownColumns { names: names.join(","), what, next });
        }
        let names = names.iter().map(|name| name_and_unit(name).0.replace("\"\"", "\"")).collect();
        Ok(Self { places: columns, names })
    }
}

impl Columns {
    /// Guesses columns from their numbers: x y z, perhaps followed by a value, a normal (of length 1 or 0) or a colour (whole
    /// numbers up to 255). Reports which other columns are possible.
    pub(super) fn guess(path: &Path, rows: &[Vec<f64>]) -> Result<Self, Reason> {
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
                    0..=2 => "x,y".to_owned(),
                    5 => "x,y,z,weight,value".to_owned(),
                    6 => "x,y,z,nx,ny,nz".to_owned(),
                    _ if rows.len() <= 4 && count > 12 => {
                        let what = format!("has {} rows of {count} numbers", rows.len());
                        let next = "save one row for each point: in NumPy, the transpose a.T";
                        return Err(Reason::content(what, next));
                    }
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
        if known.contains(&VALUE) {
            tracing::warn!(
                "{}: the fourth column is taken for values; if it has weights, name the columns x,y,z,weight",
                shown(path)
            );
        }
        if rows.len() >= LEAST_COUNTED && rows.windows(2).all(|pair| pair[1][0] == pair[0][0] + 1.0)
        {
            tracing::warn!(
                "{}: the first column counts from {} up, and is taken for x; if it numbers the points, name the columns, as \
                 in -,x,y,z",
                shown(path),
                rows[0][0]
            );
        }
        let column = |place: usize| known.get(place).copied();
        Ok(Self::without_names((0..count).map(column).collect()))
    }
}

impl Columns {
    /// The unit of length that the names state for x, y, z and the radius, and squared for the weight; if several agree, the first
    /// one.
    ///
    /// # Errors
    /// Two units differ, or are those of angles; or that of the weight is not a square.
    pub(super) fn unit<'a>(
        &self,
        names: &[&'a str],
        units: &[Option<&'a str>],
    ) -> Result<Option<&'a str>, UnknownColumns> {
        let error = |what: String, next| Err(UnknownColumns { names: names.join(","), what, next });
        let mut stated = Vec::new();
        for (place, unit) in self.places.iter().zip(units) {
            let Some(unit) = *unit else { continue };
            match *place {
                Some(0..3 | RADIUS) => stated.push(unit),
                Some(WEIGHT) => match root(unit) {
                    Some(length) => stated.push(length),
                    None => {
                        return error(
                            format!(
                                "state the unit {unit} of the weight, which is not a squared length"
                            ),
                            "write weights in the square of the unit of coordinates, such as mm2 for mm",
                        );
                    }
                },
                _ => {}
            }
        }
        match stated.iter().find(|unit| **unit != stated[0]) {
            _ if stated.iter().any(|unit| is_among(unit, &DEGREES)) => error(
                format!("state the unit {}, which is one of angles and no length", stated[0]),
                "project them to a plane first, as UTM does",
            ),
            Some(other) => error(
                format!("state different units, {} and {other}", stated[0]),
                "write all coordinates and radii in one unit, and weights in its square",
            ),
            None => Ok(stated.first().copied()),
        }
    }
}

/// Lists the names, with `-` for a column without one.
impl From<Columns> for String {
    fn from(Columns { places, names }: Columns) -> Self {
        let name = |(index, place): (usize, &Option<usize>)| match place {
            Some(place) => COLUMNS[*place],
            None => {
                names.get(index).map(Self::as_str).filter(|name| !name.is_empty()).unwrap_or("-")
            }
        };
        places.iter().enumerate().map(name).collect::<Vec<_>>().join(",")
    }
}

impl TryFrom<String> for Columns {
    type Error = UnknownColumns;

    fn try_from(names: String) -> Result<Self, UnknownColumns> {
        names.parse()
    }
}

impl FromStr for Columns {
    type Err = UnknownColumns;

    fn from_str(text: &str) -> Result<Self, UnknownColumns> {
        Self::named(&text.split(',').collect::<Vec<_>>())
    }
}
