use std::str::FromStr;

use serde::{Deserialize, Serialize};
use walpha_base::advice::Advice;

/// The names of the columns that are read.
pub(in crate::points) const COLUMNS: [&str; 6] = ["x", "y", "z", "weight", "value", "radius"];
/// Index in [`COLUMNS`] of the radius, whose square is a weight.
#[cfg(feature = "formats")]
pub(super) const RADIUS: usize = 5;

/// The columns of a table of points, in order. The names `x`, `y`, `z`, `weight`, `value` and `radius` may occur
/// once each, in any letter case; columns of other names are skipped. If there are no other names and no `z`, the
/// points lie in the plane z = 0. The surveying names `easting`, `northing`, and `height`, `elevation` or
/// `altitude`, stand for x, y and z if these are not named.
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
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Columns(pub(super) Vec<Option<usize>>);

/// The error for names that do not identify x, y and z.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("columns {names:?} {what}")]
pub struct UnknownColumns {
    names: String,
    what: String,
    next: &'static str,
}

impl UnknownColumns {
    /// What to do about it.
    pub fn advice(&self) -> Advice {
        self.next.into()
    }
}

/// The advice for names without an x, y or z.
const NAME_THEM: &str = "name each column of the file, x, y and z once each, perhaps weight (or radius) and \
                         value, and others as you like, as in x,y,z,nx,ny,nz";

/// Surveying names of x, y and z.
const SURVEY_NAMES: [&[&str]; 3] =
    [&["easting"], &["northing"], &["height", "elevation", "altitude"]];

/// Names of angles, which cannot be coordinates.
const ANGLES: [&str; 5] = ["lon", "lat", "lng", "longitude", "latitude"];

/// Whether a name is one of these, in any letter case.
fn is_among(name: &str, known: &[&str]) -> bool {
    known.iter().any(|known| known.eq_ignore_ascii_case(name.trim()))
}

#[expect(clippy::len_without_is_empty, reason = "there are at least two")]
impl Columns {
    /// The number of columns.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// The columns with these names.
    ///
    /// # Errors
    /// x or y is missing; z is missing and other columns than those read are named; or a name that is read occurs
    /// twice.
    pub fn named(names: &[&str]) -> Result<Self, UnknownColumns> {
        let known = |name: &&str| COLUMNS.iter().position(|c| c.eq_ignore_ascii_case(name.trim()));
        let mut columns: Vec<Option<usize>> = names.iter().map(known).collect();
        for (axis, survey_names) in SURVEY_NAMES.iter().enumerate() {
            if !columns.contains(&Some(axis)) {
                let others = columns.iter_mut().zip(names).filter(|(column, _)| column.is_none());
                let synonyms = others.filter(|(_, name)| is_among(name, survey_names));
                synonyms.for_each(|(column, _)| *column = Some(axis));
            }
        }
        let is_planar = columns.iter().all(Option::is_some);
        for (place, name) in COLUMNS.iter().enumerate() {
            let count = columns.iter().filter(|&&column| column == Some(place)).count();
            let (what, next) = match count {
                0 if place == 2 && is_planar => continue,
                0 if place < 3 && names.iter().any(|name| is_among(name, &ANGLES)) => (
                    "name longitude and latitude, which are angles and no lengths".to_owned(),
                    "project them to a plane first, as UTM does",
                ),
                0 if place < 3 => (format!("do not name {name}"), NAME_THEM),
                0 | 1 => continue,
                _ => (format!("name {name} twice"), NAME_THEM),
            };
            return Err(UnknownColumns { names: names.join(","), what, next });
        }
        Ok(Self(columns))
    }
}

/// The names, with `-` for a skipped column.
impl From<Columns> for String {
    fn from(columns: Columns) -> Self {
        let name = |column: &Option<usize>| column.map_or("-", |column| COLUMNS[column]);
        columns.0.iter().map(name).collect::<Vec<_>>().join(",")
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
