//! Radii of atoms, by element or by residue and name.

use std::collections::HashMap;
use std::convert::Infallible;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};
use walpha_base::advice::{Setting, advice};

use super::{Atom, Element};
use crate::PointsError;
use crate::read::format;
use crate::read::text::text;
use walpha_volume::{OpenFile, Reason};

/// Where the radii of atoms come from, in ångströms.
///
/// ```
/// use walpha_points::Radii;
///
/// assert_eq!("protor".parse(), Ok(Radii::ProtOr));
/// assert_eq!("mine.txt".parse(), Ok(Radii::File("mine.txt".into())));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "String", from = "String")]
#[non_exhaustive]
pub enum Radii {
    /// The van der Waals radius of each element: Bondi's (1964, [doi:10.1021/j100785a001]), and for elements of the main
    /// groups that he leaves out those of Mantina et al. (2009, [doi:10.1021/jp8111556]).
    ///
    /// [doi:10.1021/j100785a001]: https://doi.org/10.1021/j100785a001
    /// [doi:10.1021/jp8111556]: https://doi.org/10.1021/jp8111556
    Bondi,
    /// The radius of each atom of an amino acid with its hydrogens: `ProtOr` (Tsai et al. 1999,
    /// [doi:10.1006/jmbi.1999.2829]).
    ///
    /// [doi:10.1006/jmbi.1999.2829]: https://doi.org/10.1006/jmbi.1999.2829
    ProtOr,
    /// Those that the file states.
    Column,
    /// None: atoms are points without weights.
    None,
    /// A table: each line has an element and a radius, as in `C 1.70`, or a residue, an atom and a radius, as in `ALA CB
    /// 1.88`, separated by blanks. `*` stands for any residue. A line for a residue goes before one for any, and that before
    /// one for an element. `#` begins a comment.
    File(PathBuf),
}

/// The names of those that are not files.
const NAMES: [(Radii, &str); 4] = [
    (Radii::Bondi, "bondi"),
    (Radii::ProtOr, "protor"),
    (Radii::Column, "column"),
    (Radii::None, "none"),
];

impl FromStr for Radii {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        let named = NAMES.into_iter().find(|(_, name)| *name == text);
        Ok(named.map_or_else(|| Self::File(text.into()), |(radii, _)| radii))
    }
}

impl From<String> for Radii {
    fn from(text: String) -> Self {
        let Ok(radii) = text.parse();
        radii
    }
}

impl From<Radii> for String {
    fn from(radii: Radii) -> Self {
        radii.to_string()
    }
}

impl fmt::Display for Radii {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => path.display().fmt(f),
            named => {
                let name = NAMES.iter().find(|(known, _)| known == named);
                f.write_str(name.expect("each has a name").1)
            }
        }
    }
}

/// Radii by element, and by residue and atom.
#[derive(Debug, Default)]
pub(super) struct Table {
    elements: HashMap<Element, f64>,
    /// By residue, [`ANY`] among them, and then by the name of the atom.
    atoms: HashMap<String, HashMap<String, f64>>,
}

/// The residue that stands for all.
const ANY: &str = "*";

impl Table {
    /// Bondi's radii.
    pub(super) fn bondi() -> &'static Self {
        static TABLE: OnceLock<Table> = OnceLock::new();
        TABLE.get_or_init(|| Self::parse(include_str!("bondi.txt")).expect("a table of ours"))
    }

    /// The radii of `ProtOr`.
    pub(super) fn protor() -> &'static Self {
        static TABLE: OnceLock<Table> = OnceLock::new();
        TABLE.get_or_init(|| Self::parse(include_str!("protor.txt")).expect("a table of ours"))
    }

    /// Reads a file.
    ///
    /// # Errors
    /// It cannot be read, or is not such a table.
    pub(super) fn open(path: &Path) -> Result<Self, PointsError> {
        let file = OpenFile::open(path).map_err(|error| {
            let what = format!("cannot be read as a table of radii: {error}");
            let next = advice![
                "give ",
                Setting::Radii,
                " bondi, protor, column, none or the path of a table"
            ];
            format(path, Reason::choice(Setting::Radii, what, next))
        })?;
        Self::parse(&text(&file)?).map_err(|what| {
            let next = "write an element and a radius in each line, as in C 1.70, or a residue, an atom and a radius, as \
                        in ALA CB 1.88";
            format(path, Reason::content(what, next))
        })
    }

    fn parse(text: &str) -> Result<Self, String> {
        let mut table = Self::default();
        for (number, line) in (1..).zip(text.lines()) {
            let content = line.split_once('#').map_or(line, |(content, _)| content);
            let words: Vec<&str> = content.split_whitespace().collect();
            let Some((&radius, of)) = words.split_last() else { continue };
            let valid = |radius: &f64| *radius >= 0.0 && (radius * radius).is_finite();
            let Some(radius) = radius.parse().ok().filter(valid) else {
                return Err(format!("line {number}: {radius:?} is not a radius"));
            };
            let before = match *of {
                [symbol] => {
                    let Some(element) = Element::named(symbol) else {
                        return Err(format!("line {number}: {symbol:?} is not an element"));
                    };
                    table.elements.insert(element, radius)
                }
                [residue, atom] => {
                    let of_residue = table.atoms.entry(residue.into()).or_default();
                    of_residue.insert(atom.into(), radius)
                }
                _ => return Err(format!("line {number} has {} words, not 2 or 3", words.len())),
            };
            if before.is_some() {
                return Err(format!(
                    "line {number}: {} has a radius in an earlier line",
                    of.join(" ")
                ));
            }
        }
        Ok(table)
    }

    /// The radius of an atom, if it is known.
    pub(super) fn radius(&self, atom: &Atom) -> Option<f64> {
        let of = |residue: &str| self.atoms.get(residue)?.get(&*atom.name);
        let of_element = || self.elements.get(&atom.element?);
        of(&atom.residue).or_else(|| of(ANY)).or_else(of_element).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn atom(name: &str, element: &str, residue: &str) -> Atom {
        Atom {
            name: name.into(),
            element: Element::named(element),
            residue: residue.into(),
            ..Atom::default()
        }
    }

    #[test]
    fn the_closest_line_of_a_table_holds() {
        let table = "# in Å\nC 1.7 # carbon\n* CA 1.8\nALA CA 1.9\n\nfe 0\n";
        let table = Table::parse(table).unwrap();
        let of = |name, element, residue| table.radius(&atom(name, element, residue));
        assert_eq!(of("CA", "C", "ALA"), Some(1.9));
        assert_eq!(of("CA", "C", "GLY"), Some(1.8));
        assert_eq!(of("CB", "C", "ALA"), Some(1.7));
        assert_eq!(of("FE", "FE", "HEM"), Some(0.0));
        assert_eq!((of("N", "N", "ALA"), of("CB", "", "ALA")), (None, None));
    }

    #[test]
    fn lines_that_say_nothing_clear_are_refused() {
        for (text, what) in [
            ("C", "line 1: \"C\" is not a radius"),
            ("C 1.7\n\nC 1.8\n", "line 3: C has a radius in an earlier line"),
            ("C -1", "\"-1\" is not a radius"),
            ("C nan", "\"nan\" is not a radius"),
            ("C 1e200", "\"1e200\" is not a radius"),
            ("Xx 1", "\"Xx\" is not an element"),
            ("A B C 1", "has 4 words"),
        ] {
            let error = Table::parse(text).unwrap_err();
            assert!(error.contains(what), "{text}: {error}");
        }
    }

    #[test]
    fn the_sets_are_those_of_the_papers() {
        let (bondi, protor) = (Table::bondi(), Table::protor());
        let of = |element| bondi.radius(&atom("", element, ""));
        assert_eq!(["H", "C", "N", "O", "S"].map(of), [1.2, 1.7, 1.55, 1.52, 1.8].map(Some));
        // Mantina's, and an element of neither.
        assert_eq!((of("Ca"), of("Fe")), (Some(2.31), None));
        assert_eq!(bondi.elements.len(), 54);
        let of = |name, residue| protor.radius(&atom(name, "C", residue));
        assert_eq!((of("CA", "GLY"), of("CZ", "TYR")), (Some(1.88), Some(1.61)));
        assert_eq!((of("CB", "GLY"), of("CA", "MSE")), (None, None));
        assert_eq!(protor.atoms.len(), 20);
        // The twenty have 167 atoms, and each may be the last.
        assert_eq!(protor.atoms.values().map(HashMap::len).sum::<usize>(), 167 + 20);
    }

    #[test]
    fn names_survive() {
        for (text, radii) in [
            ("bondi", Radii::Bondi),
            ("protor", Radii::ProtOr),
            ("column", Radii::Column),
            ("none", Radii::None),
            ("a/b.txt", Radii::File("a/b.txt".into())),
        ] {
            assert_eq!(Radii::from(text.to_owned()), radii);
            assert_eq!(radii.to_string(), text);
        }
    }
}
