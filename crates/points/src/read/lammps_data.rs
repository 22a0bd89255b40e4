//! Data files of LAMMPS: a header with the box, and sections (LAMMPS documentation, "`read_data` command").

use std::collections::HashMap;
use std::path::Path;

use walpha_base::shown::shown;

use super::lammps::{Bounds, Row, Units, atoms, miscount, number, warn_of_masses, wrong};
use super::text::text;
use super::{COLUMNS, Points, PointsError, format};
use crate::molecule::Element;
use crate::{Cell, ModelMetadata, PointOptions};
use walpha_volume::{OpenFile, Reason};

/// The columns of a style of atoms.
#[derive(Clone, Copy, PartialEq)]
struct Style {
    name: &'static str,
    kind: usize,
    charge: Option<usize>,
    diameter: Option<usize>,
    /// The column of x; y and z follow, and behind these perhaps three counts of passages through the sides of the box.
    place: usize,
}

const ATOMIC: Style = Style { name: "atomic", kind: 1, charge: None, diameter: None, place: 2 };
const CHARGE: Style = Style { name: "charge", charge: Some(2), place: 3, ..ATOMIC };
const MOLECULAR: Style = Style { name: "molecular", kind: 2, place: 3, ..ATOMIC };
const FULL: Style = Style { name: "full", kind: 2, charge: Some(3), place: 4, ..ATOMIC };
const SPHERE: Style = Style { name: "sphere", diameter: Some(2), place: 4, ..ATOMIC };
/// The styles that are read. Those of bonds and angles have the columns of molecules.
const STYLES: [Style; 7] = [
    ATOMIC,
    CHARGE,
    MOLECULAR,
    Style { name: "bond", ..MOLECULAR },
    Style { name: "angle", ..MOLECULAR },
    FULL,
    SPHERE,
];
/// The others, which have other columns.
const OTHERS: [&str; 18] = [
    "amoeba",
    "body",
    "bpm/sphere",
    "dielectric",
    "dipole",
    "dpd",
    "edpd",
    "electron",
    "ellipsoid",
    "hybrid",
    "line",
    "mdpd",
    "peri",
    "rheo",
    "smd",
    "sph",
    "spin",
    "tri",
];

/// Reads the atoms and the box. Elements are those of masses, or of the comments behind them.
///
/// # Errors
/// The header lacks the number of atoms or the box; a line has text in place of a number; the style of atoms is another one.
pub(crate) fn read(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let text = text(file)?;
    let units = text.lines().next().and_then(stated_units);
    let mut data = Data::new(path);
    let mut part = Part::Header;
    // The first line is a title.
    for (line, content) in (1..).zip(text.lines()).skip(1) {
        let (words, comment) = match content.split_once('#') {
            Some((words, comment)) => (words, Some(comment.trim())),
            None => (content, None),
        };
        let words: Vec<&str> = words.split_whitespace().collect();
        // A section ends with an empty line, and another one is before its first row.
        if words.is_empty() {
            part = match part {
                Part::Announced(section) => Part::Within(section),
                Part::Within(_) if data.is_begun => Part::Between,
                other => other,
            };
            continue;
        }
        match part {
            Part::Within(section) => {
                data.is_begun = true;
                match section {
                    Section::Atoms => data.atoms.push((line, content)),
                    _ => data.row(line, section, &words, comment)?,
                }
            }
            Part::Announced(_) => {
                return Err(wrong(path, line, "comes right behind the name of a section"));
            }
            Part::Header | Part::Between => match section(&words) {
                Some(section) => {
                    if let Section::Atoms = section {
                        data.begin_atoms(line, comment)?;
                    }
                    (part, data.is_begun) = (Part::Announced(section), false);
                }
                None => data.header(line, &words)?,
            },
        }
    }
    data.finish(units, options)
}

/// The words of a row before a comment.
fn words(row: &str) -> impl Iterator<Item = &str> {
    row.split('#').next().unwrap_or_default().split_whitespace()
}

/// The units that a title states, as `write_data` does.
fn stated_units(title: &str) -> Option<Units> {
    let (_, behind) = title.split_once("units =")?;
    Units::named(behind.trim().split([',', ' ']).next()?)
}

/// Where a line is.
#[derive(Clone, Copy)]
enum Part {
    Header,
    Announced(Section),
    Within(Section),
    Between,
}

#[derive(Clone, Copy)]
enum Section {
    Masses,
    Labels,
    Atoms,
    Other,
}

/// The section of a line with its name.
fn section(words: &[&str]) -> Option<Section> {
    if !words[0].starts_with(|c: char| c.is_ascii_uppercase()) {
        return None;
    }
    Some(match words {
        ["Masses"] => Section::Masses,
        ["Atom", "Type", "Labels"] => Section::Labels,
        ["Atoms"] => Section::Atoms,
        _ => Section::Other,
    })
}

/// What the file says of a type of atoms.
struct Kind<'a> {
    mass: f64,
    comment: Option<&'a str>,
}

struct Data<'a> {
    path: &'a Path,
    count: Option<u64>,
    types: u64,
    bounds: [Option<[f64; 2]>; 3],
    tilt: [f64; 3],
    vectors: [Option<[f64; 3]>; 3],
    origin: [f64; 3],
    /// Whether the section has a row.
    is_begun: bool,
    /// By the number or label of a type.
    kinds: HashMap<&'a str, Kind<'a>>,
    /// The label of each number of a type, and the number of each label.
    labels: HashMap<&'a str, &'a str>,
    style: Option<Style>,
    /// The rows of atoms, with the numbers of their lines.
    atoms: Vec<(u64, &'a str)>,
}

impl<'a> Data<'a> {
    fn new(path: &'a Path) -> Self {
        Self {
            path,
            count: None,
            types: 0,
            bounds: [None; 3],
            tilt: [0.0; 3],
            vectors: [None; 3],
            origin: [0.0; 3],
            is_begun: false,
            kinds: HashMap::new(),
            labels: HashMap::new(),
            style: None,
            atoms: Vec::new(),
        }
    }

    /// Takes a line of the header. Counts of other things are passed by.
    fn header(&mut self, line: u64, words: &[&str]) -> Result<(), PointsError> {
        let path = self.path;
        let three = |words: [&str; 3], what: &str| -> Result<[f64; 3], PointsError> {
            let mut numbers = [0.0; 3];
            for (x, word) in numbers.iter_mut().zip(words) {
                *x = number(path, line, word, what)?;
            }
            Ok(numbers)
        };
        match *words {
            [count, "atoms"] => {
                let what = format!("has {count:?} as the number of atoms");
                self.count = Some(count.parse().map_err(|_| wrong(path, line, &what))?);
            }
            [count, "atom", "types"] => {
                let what = format!("has {count:?} as the number of types");
                self.types = count.parse().map_err(|_| wrong(path, line, &what))?;
            }
            [low, high, "xlo", "xhi"] => self.bounds[0] = Some(self.pair(line, low, high)?),
            [low, high, "ylo", "yhi"] => self.bounds[1] = Some(self.pair(line, low, high)?),
            [low, high, "zlo", "zhi"] => self.bounds[2] = Some(self.pair(line, low, high)?),
            [xy, xz, yz, "xy", "xz", "yz"] => self.tilt = three([xy, xz, yz], "a tilt")?,
            [x, y, z, "avec"] => self.vectors[0] = Some(three([x, y, z], "a vector")?),
            [x, y, z, "bvec"] => self.vectors[1] = Some(three([x, y, z], "a vector")?),
            [x, y, z, "cvec"] => self.vectors[2] = Some(three([x, y, z], "a vector")?),
            [x, y, z, "abc", "origin"] => self.origin = three([x, y, z], "the origin")?,
            _ => {}
        }
        Ok(())
    }

    fn pair(&self, line: u64, low: &str, high: &str) -> Result<[f64; 2], PointsError> {
        let of = |word| number(self.path, line, word, "a bound of the box");
        Ok([of(low)?, of(high)?])
    }

    /// Begins the atoms, behind whose name a comment may name their style.
    fn begin_atoms(&mut self, line: u64, comment: Option<&str>) -> Result<(), PointsError> {
        if !self.atoms.is_empty() {
            return Err(wrong(self.path, line, "begins a second section of atoms"));
        }
        let name = comment.and_then(|comment| comment.split_whitespace().next());
        if let Some(name) = name.filter(|name| OTHERS.contains(name)) {
            let known: Vec<&str> = STYLES.iter().map(|style| style.name).collect();
            let what = format!("has atoms of the style {name}, of which the columns are not read");
            let next = format!("write them in one of these: {}", known.join(", "));
            return Err(format(self.path, Reason::unsupported(what, next)));
        }
        self.style = STYLES.into_iter().find(|style| Some(style.name) == name);
        Ok(())
    }

    fn row(
        &mut self,
        line: u64,
        section: Section,
        words: &[&'a str],
        comment: Option<&'a str>,
    ) -> Result<(), PointsError> {
        match (section, words) {
            (Section::Masses, &[kind, mass, ..]) => {
                let mass = number(self.path, line, mass, "a mass")?;
                self.kinds.insert(kind, Kind { mass, comment });
            }
            (Section::Labels, &[kind, label, ..]) => {
                self.labels.insert(kind, label);
                self.labels.insert(label, kind);
            }
            (Section::Masses | Section::Labels, _) => {
                return Err(wrong(self.path, line, "has one word, not a type and what it is"));
            }
            (Section::Atoms | Section::Other, _) => {}
        }
        Ok(())
    }

    fn atom(&self, style: Style, line: u64, words: &[&'a str]) -> Result<Row<'a>, PointsError> {
        if ![style.place + 3, style.place + 6].contains(&words.len()) {
            let what = format!(
                "has {} fields, not {} as atoms of the style {}",
                words.len(),
                style.place + 3,
                style.name
            );
            return Err(wrong(self.path, line, &what));
        }
        let mut position = [0.0; 3];
        for (k, x) in position.iter_mut().enumerate() {
            *x = number(self.path, line, words[style.place + k], COLUMNS[k])?;
        }
        let of = |column: Option<usize>, what: &str| {
            column.map(|column| number(self.path, line, words[column], what)).transpose()
        };
        Ok(Row {
            name: words[style.kind],
            element: None,
            position,
            charge: of(style.charge, "charge")?,
            radius: of(style.diameter, "diameter")?.map(|diameter| diameter / 2.0),
        })
    }

    /// The style of the atoms: the one that the file names, or the one that all rows fit.
    fn style(&self) -> Result<Style, PointsError> {
        if let Some(style) = self.style {
            return Ok(style);
        }
        let Some(&(line, first)) = self.atoms.first() else { return Ok(ATOMIC) };
        let fields = words(first).count();
        let styles = match fields {
            5 | 8 => [ATOMIC, ATOMIC],
            6 | 9 => [MOLECULAR, CHARGE],
            7 | 10 => [FULL, SPHERE],
            _ => {
                let what = format!(
                    "has {fields} fields, and the file does not name the style of its atoms (Atoms # full)"
                );
                return Err(wrong(self.path, line, &what));
            }
        };
        let fits = |style: &Style| self.atoms.iter().all(|&(_, row)| self.fits(*style, row));
        let style = styles.into_iter().find(fits).unwrap_or(styles[0]);
        if style != FULL || fits(&styles[1]) {
            tracing::warn!(
                "{}: it does not name the style of its atoms (Atoms # …): their columns are taken for those of {}",
                shown(self.path),
                style.name
            );
        }
        Ok(style)
    }

    /// Whether a row has a type where atoms of a style have theirs: a charge or a diameter is not one in every row.
    fn fits(&self, style: Style, row: &str) -> bool {
        words(row).nth(style.kind).is_some_and(|kind| {
            self.labels.contains_key(kind)
                || kind.parse().is_ok_and(|kind: u64| (1..=self.types).contains(&kind))
        })
    }

    fn finish(
        self,
        units: Option<Units>,
        options: &PointOptions,
    ) -> Result<(Points, ModelMetadata), PointsError> {
        let path = self.path;
        let Some(claimed) = self.count else {
            let what =
                "has no line with the number of atoms (2004 atoms), as a data file of LAMMPS has";
            return Err(format(path, Reason::other(what)));
        };
        let style = self.style()?;
        let atom =
            |&(line, row): &(u64, &'a str)| self.atom(style, line, &words(row).collect::<Vec<_>>());
        let mut rows = self.atoms.iter().map(atom).collect::<Result<Vec<_>, _>>()?;
        if claimed != rows.len() as u64 {
            return Err(miscount(path, claimed, rows.len() as u64));
        }
        let cell = self.cell()?;
        // Masses are those of a potential (lj), not of elements, if none is above 1.
        let is_molar = units.is_none_or(|units| units.molar)
            && self.kinds.values().any(|kind| kind.mass > 1.0);
        if units.is_none() && is_molar {
            warn_of_masses(path, self.kinds.values().map(|kind| kind.mass));
        }
        let mut known: HashMap<&str, Option<Element>> = HashMap::new();
        for row in &mut rows {
            let element =
                *known.entry(row.name).or_insert_with_key(|kind| self.element(kind, is_molar));
            let label = self.labels.get(row.name).filter(|_| row.name.parse::<u64>().is_ok());
            row.element = element;
            row.name = match (element, label) {
                (_, Some(label)) => label,
                (Some(element), None) => element.symbol(),
                (None, None) => row.name,
            };
        }
        atoms(path, rows, units, Some(cell), options)
    }

    /// The element of a type.
    fn element(&self, kind: &str, is_molar: bool) -> Option<Element> {
        let other = self.labels.get(kind).copied();
        let known = self.kinds.get(kind).or_else(|| self.kinds.get(other?));
        let of_mass = || Element::of_mass(known?.mass).filter(|_| is_molar);
        let of_comment = || Element::named(known?.comment?.split_whitespace().next()?);
        let of_label = || [Some(kind), other].into_iter().flatten().find_map(Element::named);
        of_mass().or_else(of_comment).or_else(of_label)
    }

    fn cell(&self) -> Result<Cell, PointsError> {
        let wrong = |what: &str| {
            let next = "write its header with xlo xhi, ylo yhi and zlo zhi";
            format(self.path, Reason::content(what, next))
        };
        let bounds = match (self.bounds, self.vectors) {
            ([Some(x), Some(y), Some(z)], _) => {
                let end = |k: usize| [x[k], y[k], z[k]];
                Bounds::of(end(0), end(1), self.tilt)
            }
            (_, [Some(a), Some(b), Some(c)]) => {
                let cell = Cell { vectors: [a, b, c], repeats: [true; 3] };
                Bounds { origin: self.origin, cell }.checked()
            }
            _ => return Err(wrong("states no box")),
        };
        Ok(bounds.ok_or_else(|| wrong("states a box without volume"))?.cell)
    }
}
