//! Dumps of LAMMPS: frames of atoms with named columns (LAMMPS documentation, "dump command").

use std::path::Path;

use super::lammps::{Bounds, Row, Units, atoms, miscount, number, warn_of_masses, wrong};
use super::text::text;
use super::{COLUMNS, Points, PointsError, first_frame, format};
use crate::molecule::Element;
use crate::{Cell, ModelMetadata, PointOptions};
use walpha_volume::{OpenFile, Reason};

/// The beginning of a line that says what follows.
const ITEM: &str = "ITEM:";
/// Names of the columns of places, in the order in which they are taken: those in the box before those of paths, which leave it.
/// Those that end with s are parts of the box.
const PLACES: [[&str; 3]; 4] =
    [["x", "y", "z"], ["xs", "ys", "zs"], ["xu", "yu", "zu"], ["xsu", "ysu", "zsu"]];

/// Reads the atoms of a frame, in the order of the file.
///
/// # Errors
/// There is no frame; an item is missing, or has text in place of a number; rows are missing.
pub(crate) fn read(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let text = text(file)?;
    let count = text.lines().filter(|line| item(line) == Some("TIMESTEP")).count();
    if count == 0 {
        return Err(format(path, Reason::other("has no ITEM: TIMESTEP, as a dump of LAMMPS has")));
    }
    let wanted = first_frame(path, count, options.frame)?;
    let mut frame = Frame::default();
    let (mut steps, mut part) = (0, Part::Other);
    for (line, content) in (1..).zip(text.lines()) {
        let Some(name) = item(content) else {
            frame.line(path, line, content, &part)?;
            continue;
        };
        part = Part::Other;
        if name == "TIMESTEP" {
            steps += 1;
        } else if name == "UNITS" {
            part = Part::Units;
        } else if steps == wanted + 1 {
            part = Part::of(path, line, name)?;
        }
        if steps > wanted + 1 {
            break;
        }
    }
    frame.finish(path, options)
}

/// What a line announces.
fn item(line: &str) -> Option<&str> {
    line.strip_prefix(ITEM).map(str::trim)
}

/// What lines hold.
enum Part<'a> {
    Other,
    Units,
    Count,
    Bounds(Sides),
    Atoms(Columns<'a>),
}

/// How bounds are written.
#[derive(Clone, Copy, PartialEq)]
enum Layout {
    Straight,
    Tilted,
    /// Three vectors and the origin.
    Vectors,
}

#[derive(Clone, Copy)]
struct Sides {
    layout: Layout,
    repeats: [bool; 3],
}

impl<'a> Part<'a> {
    fn of(path: &Path, line: u64, name: &'a str) -> Result<Self, PointsError> {
        if name == "NUMBER OF ATOMS" {
            return Ok(Self::Count);
        }
        if let Some(words) = name.strip_prefix("BOX BOUNDS") {
            let words: Vec<&str> = words.split_whitespace().collect();
            let (layout, flags) = match &words[..] {
                ["xy", "xz", "yz", flags @ ..] => (Layout::Tilted, flags),
                ["abc", "origin", flags @ ..] => (Layout::Vectors, flags),
                flags => (Layout::Straight, flags),
            };
            // Old versions state no boundaries.
            let repeats = match flags {
                [] => [true; 3],
                &[x, y, z] => [x, y, z].map(|flag| flag == "pp"),
                _ => return Err(wrong(path, line, "has no boundary for each of three axes")),
            };
            return Ok(Self::Bounds(Sides { layout, repeats }));
        }
        match name.strip_prefix("ATOMS") {
            Some(names) => Ok(Self::Atoms(Columns::of(path, line, names)?)),
            None => Ok(Self::Other),
        }
    }
}

/// The places of columns.
struct Columns<'a> {
    names: Vec<&'a str>,
    places: [usize; 3],
    /// Whether places are parts of the box.
    are_parts: bool,
}

impl<'a> Columns<'a> {
    fn of(path: &Path, line: u64, names: &'a str) -> Result<Self, PointsError> {
        let names: Vec<&str> = names.split_whitespace().collect();
        let column = |name: &str| names.iter().position(|own| *own == name);
        let places = PLACES.iter().find_map(|axes| {
            let [Some(x), Some(y), Some(z)] = axes.map(column) else { return None };
            Some(([x, y, z], axes[0].starts_with("xs")))
        });
        let Some((places, are_parts)) = places else {
            return Err(wrong(
                path,
                line,
                "has no columns x y z, xs ys zs, xu yu zu or xsu ysu zsu",
            ));
        };
        Ok(Self { names, places, are_parts })
    }

    /// The word of a column.
    fn word<'b>(&self, name: &str, words: &[&'b str]) -> Option<&'b str> {
        self.names.iter().position(|own| *own == name).map(|column| words[column])
    }
}

/// What is known of a frame.
#[derive(Default)]
struct Frame<'a> {
    units: Option<&'a str>,
    count: Option<u64>,
    sides: Vec<Vec<f64>>,
    stated: Option<Sides>,
    rows: Vec<Row<'a>>,
    /// Those of atoms whose element is not stated.
    masses: Vec<f64>,
    /// Whether places are parts of the box.
    are_parts: bool,
    has_atoms: bool,
}

impl<'a> Frame<'a> {
    fn line(
        &mut self,
        path: &Path,
        line: u64,
        content: &'a str,
        part: &Part<'_>,
    ) -> Result<(), PointsError> {
        let text = content.trim();
        match part {
            Part::Other => {}
            _ if text.is_empty() => {}
            Part::Units => self.units = Some(text),
            Part::Count => {
                let what = format!("has {text:?} as the number of atoms");
                self.count = Some(text.parse().map_err(|_| wrong(path, line, &what))?);
            }
            Part::Bounds(sides) => {
                let numbers = text
                    .split_whitespace()
                    .map(|word| number(path, line, word, "a bound of the box"))
                    .collect::<Result<Vec<_>, _>>()?;
                let width = match sides.layout {
                    Layout::Straight => 2,
                    Layout::Tilted => 3,
                    Layout::Vectors => 4,
                };
                if numbers.len() != width || self.sides.len() == 3 {
                    let what = format!("is not one of three lines of {width} bounds of the box");
                    return Err(wrong(path, line, &what));
                }
                self.stated = Some(*sides);
                self.sides.push(numbers);
            }
            Part::Atoms(columns) => {
                self.has_atoms = true;
                self.are_parts = columns.are_parts;
                let words: Vec<&str> = text.split_whitespace().collect();
                if words.len() != columns.names.len() {
                    let what = format!(
                        "has {} fields, not {} as its columns",
                        words.len(),
                        columns.names.len()
                    );
                    return Err(wrong(path, line, &what));
                }
                let mut position = [0.0; 3];
                for (k, x) in position.iter_mut().enumerate() {
                    *x = number(path, line, words[columns.places[k]], COLUMNS[k])?;
                }
                let optional = |name: &str| {
                    columns
                        .word(name, &words)
                        .map(|word| number(path, line, word, name))
                        .transpose()
                };
                let element = columns.word("element", &words);
                let mass = optional("mass")?;
                if element.is_none() {
                    self.masses.extend(mass);
                }
                let row = Row {
                    name: element.or_else(|| columns.word("type", &words)).unwrap_or_default(),
                    element: match element.and_then(Element::named) {
                        Some(element) => Some(element),
                        None => mass.filter(|mass| *mass > 1.0).and_then(Element::of_mass),
                    },
                    position,
                    charge: optional("q")?,
                    radius: match optional("radius")? {
                        Some(radius) => Some(radius),
                        None => optional("diameter")?.map(|diameter| diameter / 2.0),
                    },
                };
                self.rows.push(row);
            }
        }
        Ok(())
    }

    fn finish(
        mut self,
        path: &Path,
        options: &PointOptions,
    ) -> Result<(Points, ModelMetadata), PointsError> {
        let lacks = |what: &str| {
            let what = format!("has no {ITEM} {what} in its frame: it is truncated, or not a dump");
            format(path, Reason::truncated(what))
        };
        let claimed = self.count.ok_or_else(|| lacks("NUMBER OF ATOMS"))?;
        let bounds = self.bounds(path)?;
        if claimed != self.rows.len() as u64 {
            return Err(miscount(path, claimed, self.rows.len() as u64));
        }
        if !self.has_atoms {
            return Err(lacks("ATOMS"));
        }
        let (bounds, repeats) = bounds.ok_or_else(|| lacks("BOX BOUNDS"))?;
        if self.are_parts {
            for row in &mut self.rows {
                row.position = bounds.place(row.position);
            }
        }
        let cell = Cell { repeats, ..bounds.cell };
        let cell = Some(cell).filter(|_| repeats != [false; 3]);
        if self.units.is_none() && self.masses.iter().any(|&mass| mass > 1.0) {
            warn_of_masses(path, self.masses);
        }
        let units = self.units.map(|name| {
            Units::named(name).ok_or_else(|| {
                let what = format!("has units {name:?}, which LAMMPS does not have");
                format(path, Reason::content(what, "correct them"))
            })
        });
        atoms(path, self.rows, units.transpose()?, cell, options)
    }

    /// The box, and along which of its vectors atoms repeat.
    fn bounds(&self, path: &Path) -> Result<Option<(Bounds, [bool; 3])>, PointsError> {
        let (Some(Sides { layout, repeats }), [x, y, z]) = (self.stated, &self.sides[..]) else {
            return Ok(None);
        };
        let column = |k: usize| [x[k], y[k], z[k]];
        let bounds = match layout {
            Layout::Straight => Bounds::of(column(0), column(1), [0.0; 3]),
            Layout::Tilted => Bounds::spanning(column(0), column(1), column(2)),
            Layout::Vectors => {
                let vectors = [x, y, z].map(|row| [row[0], row[1], row[2]]);
                Bounds { origin: column(3), cell: Cell { vectors, repeats } }.checked()
            }
        };
        let bounds = bounds.ok_or_else(|| {
            let what = "has bounds of a box without volume";
            format(path, Reason::content(what, "correct its ITEM: BOX BOUNDS"))
        })?;
        Ok(Some((bounds, repeats)))
    }
}
