use std::str::FromStr;

use super::COLUMNS;
use crate::advice::Advice;

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
pub struct Columns(pub(super) Vec<Option<usize>>);

/// Names that do not say where x, y and z are.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("columns {names:?} {what}")]
pub struct UnknownColumns {
    names: String,
    what: String,
}

impl UnknownColumns {
    /// What to do about it.
    pub fn advice(&self) -> Advice {
        "name each column of the file, x, y and z once each, perhaps weight and value, and others as \
         you like, as in x,y,z,nx,ny,nz"
            .into()
    }
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
    /// occurs twice.
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
}

impl FromStr for Columns {
    type Err = UnknownColumns;

    fn from_str(text: &str) -> Result<Self, UnknownColumns> {
        Self::named(&text.split(',').collect::<Vec<_>>())
    }
}
