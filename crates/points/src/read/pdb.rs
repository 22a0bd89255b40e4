//! PDB: molecules in lines of fixed columns (wwPDB, Atomic Coordinate Entry Format 3.3).

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;

use walpha_base::shown::shown;

use super::cell::UnitCell;
use super::text::text;
use super::{COLUMNS, Points, PointsError, format};
use crate::molecule::residues::is_polymer;
use crate::molecule::{Atom, Element, Found};
use crate::{Cell, ModelMetadata, PointOptions};
use walpha_volume::{OpenFile, Reason};

/// Columns, counted from 0.
mod columns {
    use std::ops::Range;

    pub(super) const NAME: Range<usize> = 12..16;
    pub(super) const ALTERNATE: usize = 16;
    /// Four, as simulations use the one behind the name, too.
    pub(super) const RESIDUE: Range<usize> = 17..21;
    pub(super) const CHAIN: usize = 21;
    pub(super) const NUMBER: Range<usize> = 22..26;
    pub(super) const INSERTION: usize = 26;
    /// Before x; a coordinate that is too wide for its columns begins here.
    pub(super) const GAP: Range<usize> = 27..30;
    pub(super) const AXES: [Range<usize>; 3] = [30..38, 38..46, 46..54];
    pub(super) const OCCUPANCY: Range<usize> = 54..60;
    pub(super) const ELEMENT: Range<usize> = 76..78;
    /// Up to the end of the line.
    pub(super) const MODEL: usize = 6;
    /// The least number of columns of an atom.
    pub(super) const LEAST: usize = 54;
}

/// What to do about a line that is wrong.
const NEXT: &str = "correct it, or write the file anew, with the fixed columns of PDB";

/// Reads atoms: those of records ATOM and HETATM, in models, in the unit cell of CRYST1. Numbers of atoms are passed by, so those
/// beyond 99 999 do not matter; numbers of residues may be decimal or hybrid-36.
///
/// # Errors
/// A line is too short, or has text in place of a number; a model has no end; there are no atoms.
pub(crate) fn read(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let text = text(file)?;
    let mut reader = Reader {
        path,
        found: Found::default(),
        cells: Vec::new(),
        model: Model::Before(1),
        models: BTreeSet::new(),
        has_end: false,
    };
    for (number, line) in (1..).zip(text.split_inclusive('\n')) {
        reader.line(number, line)?;
    }
    if let Model::Within(number) = reader.model {
        let what = format!("ends inside its model {number}, which has no ENDMDL: it is truncated");
        return Err(format(path, Reason::truncated(what)));
    }
    if reader.found.last().is_none() {
        let what = if text.trim_start().starts_with("data_") {
            "is mmCIF, not PDB"
        } else {
            "has no record ATOM or HETATM"
        };
        return Err(format(path, Reason::other(what)));
    }
    if !reader.has_end {
        tracing::warn!("{}: has no record END at its end: it may be truncated", shown(path));
    }
    let mut found = reader.found;
    found.cell = cell_of(&reader.cells, found.first_of(options.atoms.models));
    found.select(path, &options.atoms, options)
}

/// The cell of an atom: the last one before it, or the first of the file. Trajectories have one for each frame.
fn cell_of(cells: &[(usize, Option<Cell>)], atom: usize) -> Option<Cell> {
    let before = cells.partition_point(|&(atoms, _)| atoms <= atom);
    cells.get(before.saturating_sub(1))?.1
}

/// Where a line is.
enum Model {
    /// Before the first MODEL, if there is one, in the model of this number.
    Before(u32),
    /// In a model.
    Within(u32),
    /// Behind one.
    Behind,
}

struct Reader<'a> {
    path: &'a Path,
    found: Found,
    /// The cells that records CRYST1 state, each with the number of atoms before it.
    cells: Vec<(usize, Option<Cell>)>,
    model: Model,
    /// The numbers of models so far.
    models: BTreeSet<u32>,
    /// Whether its last record but remarks is one that ends it.
    has_end: bool,
}

impl Reader<'_> {
    fn line(&mut self, number: u64, line: &str) -> Result<(), PointsError> {
        let record = line.get(..6).unwrap_or(line).trim_end();
        match record {
            "HETATM" => self.atom(number, line, true),
            // A number of six digits may begin in the column behind.
            _ if record.starts_with("ATOM") && record[4..].trim().parse::<u8>().is_ok() => {
                self.atom(number, line, false)
            }
            "ATOM" => self.atom(number, line, false),
            "MODEL" => self.begin(number, line),
            "ENDMDL" => {
                self.has_end = true;
                if !matches!(self.model, Model::Within(_)) {
                    return Err(self.wrong(number, "has an ENDMDL without a MODEL"));
                }
                self.model = Model::Behind;
                Ok(())
            }
            "END" | "MASTER" => {
                self.has_end = true;
                // Trajectories of some programs have no MODEL, and an END behind each frame.
                if let (Model::Before(model), "END") = (&mut self.model, record) {
                    *model = self.found.last().map_or(1, |last| last.model.saturating_add(1));
                }
                Ok(())
            }
            "CRYST1" => {
                let cell = UnitCell::of_pdb(line).map_err(|what| self.wrong(number, &what))?;
                self.cells.push((self.found.len(), cell.and_then(UnitCell::repeating)));
                Ok(())
            }
            "SCALE1" | "SCALE2" | "SCALE3" => {
                self.check_scale(number, record, line);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Takes back a cell whose vectors do not lie as CRYST1 says without further records: a along x, b in the plane of x and y. SCALE
    /// has the rows of the matrix that turns coordinates into fractions.
    fn check_scale(&mut self, number: u64, record: &str, line: &str) {
        let Some((_, of_file)) = self.cells.last_mut() else { return };
        let Some(cell) = of_file else { return };
        let row = [10..20, 20..30, 30..40]
            .map(|columns| line.get(columns).and_then(|text| text.trim().parse::<f64>().ok()));
        let [Some(a), Some(b), Some(c)] = row else { return };
        let of_row = usize::from(record.as_bytes()[5] - b'1');
        let fraction = |[x, y, z]: [f64; 3]| a * x + b * y + c * z;
        let is_as_stated = cell.vectors.iter().enumerate().all(|(k, &vector)| {
            let expected = if k == of_row { 1.0 } else { 0.0 };
            (fraction(vector) - expected).abs() < 0.02
        });
        if !is_as_stated {
            tracing::warn!(
                "{}: line {number} has a {record} for axes of the cell other than those of CRYST1: the cell is not used",
                shown(self.path)
            );
            *of_file = None;
        }
    }

    fn begin(&mut self, number: u64, line: &str) -> Result<(), PointsError> {
        let text = line.get(columns::MODEL..).unwrap_or_default().trim();
        // Some programs do not number them.
        let next = || self.found.last().map_or(1, |last| last.model.saturating_add(1));
        let Some(model) = (if text.is_empty() { Some(next()) } else { text.parse().ok() }) else {
            return Err(self.wrong(number, &format!("has a MODEL {text:?}, which is not a number")));
        };
        match self.model {
            Model::Within(_) => return Err(self.wrong(number, "has a MODEL inside another one")),
            Model::Before(_) if self.found.last().is_some() => {
                return Err(self.wrong(number, "has a MODEL behind atoms that are in none"));
            }
            Model::Before(_) | Model::Behind => {}
        }
        let model = if self.models.contains(&model) {
            let next = self.models.last().map_or(1, |last| last.saturating_add(1));
            tracing::warn!(
                "{}: line {number} has another model {model}, which is read as model {next}",
                shown(self.path)
            );
            next
        } else {
            model
        };
        self.models.insert(model);
        (self.model, self.has_end) = (Model::Within(model), false);
        Ok(())
    }

    fn atom(&mut self, number: u64, line: &str, hetero: bool) -> Result<(), PointsError> {
        self.has_end = false;
        let (line, is_whole) = match line.strip_suffix('\n') {
            Some(line) => (line, true),
            None => (line, false),
        };
        let model = match self.model {
            Model::Before(model) | Model::Within(model) => model,
            Model::Behind => {
                return Err(self.wrong(number, "has an atom behind ENDMDL, in no model"));
            }
        };
        if let Some(other) = line.chars().find(|c| !c.is_ascii() || c.is_ascii_control()) {
            let what = match other {
                '\t' => "has a tab, and columns are counted in characters".to_owned(),
                other => format!("has a character that PDB does not have, {other:?}"),
            };
            return Err(self.wrong(number, &what));
        }
        if line.len() < columns::LEAST {
            let what = format!("ends inside line {number}: it is truncated");
            return Err(if is_whole {
                self.wrong(number, "ends before its coordinates do, in column 54")
            } else {
                format(self.path, Reason::truncated(what))
            });
        }
        if !line[columns::GAP].trim().is_empty() {
            let what = "is not blank in columns 28 to 30: columns are shifted, or x is too wide for its own";
            return Err(self.wrong(number, what));
        }
        let mut position = [0.0; 3];
        for (k, columns) in columns::AXES.into_iter().enumerate() {
            position[k] = self.number(number, line, COLUMNS[k], columns)?;
        }
        let columns = columns::OCCUPANCY.start..columns::OCCUPANCY.end.min(line.len());
        let occupancy = match line[columns.clone()].trim() {
            "" => None,
            _ => Some(self.number(number, line, "the occupancy", columns)?),
        };
        let (residue, chain) = residue_and_chain(line);
        let name = line[columns::NAME].trim();
        let stated = line.get(columns::ELEMENT).map(str::trim).unwrap_or_default();
        // Files of before 1996 have the numbers of their lines in these columns.
        let element = if stated.contains(|c: char| c.is_ascii_alphabetic()) {
            Element::named(stated)
        } else {
            Element::of_name(name, Some(!line[columns::NAME].starts_with(' ')), residue)
        };
        let residue_number = line[columns::NUMBER].trim();
        let Ok(residue_number) = (match residue_number {
            "" => Ok(None),
            text => text.parse().map(Some).or_else(|_| hybrid_36(text).map(Some).ok_or(())),
        }) else {
            let what = format!(
                "has {residue_number:?} as number of a residue, which is neither decimal nor hybrid-36"
            );
            return Err(self.wrong(number, &what));
        };
        let character = |at: usize| line[at..].chars().next().filter(|&c| c != ' ');
        let atom = Atom {
            name: self.found.name(name),
            element,
            residue: self.found.name(residue),
            number: residue_number,
            insertion: character(columns::INSERTION),
            chain: self.found.name(chain),
            model,
            alternate: character(columns::ALTERNATE),
            hetero,
            occupancy,
            charge: None,
        };
        Ok(self.found.push(position, atom)?)
    }

    /// The number in some columns.
    fn number(
        &self,
        number: u64,
        line: &str,
        what: &str,
        columns: Range<usize>,
    ) -> Result<f64, PointsError> {
        let text = &line[columns.clone()];
        text.trim().parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| {
            let Range { start, end } = columns;
            let what = format!(
                "has {text:?} as {what}, in columns {} to {end}, which is not a number",
                start + 1
            );
            self.wrong(number, &what)
        })
    }

    fn wrong(&self, number: u64, what: &str) -> PointsError {
        format(self.path, Reason::content(format!("line {number} {what}"), NEXT))
    }
}

/// The names of the residue and the chain. Names of residues have three letters, or four, which simulations use; where the
/// first three are a residue of a polymer, the fourth belongs to a chain of two.
fn residue_and_chain(line: &str) -> (&str, &str) {
    let Range { start, end } = columns::RESIDUE;
    let (three, fourth) = (&line[start..end - 1], &line[end - 1..end]);
    let chain = &line[columns::CHAIN..=columns::CHAIN];
    if fourth != " " && chain != " " && is_polymer(three.trim()) {
        return (three.trim(), &line[end - 1..=columns::CHAIN]);
    }
    (line[start..end].trim(), chain.trim())
}

/// A number of four digits in hybrid-36, as computational crystallography writes those from 10 000 on: `A000` is 10 000,
/// and `a000` comes after `ZZZZ`.
fn hybrid_36(text: &str) -> Option<i32> {
    const WIDTH: u32 = 4;
    let is_upper = text.starts_with(|c: char| c.is_ascii_uppercase());
    let digit = |c: char| match (c.is_ascii_digit(), is_upper) {
        (true, _) => true,
        (_, true) => c.is_ascii_uppercase(),
        (_, false) => c.is_ascii_lowercase(),
    };
    let begins = text.starts_with(|c: char| c.is_ascii_alphabetic());
    if text.len() != WIDTH as usize || !begins || !text.chars().all(digit) {
        return None;
    }
    let value =
        i32::from_str_radix(text, 36).ok()? - 10 * 36_i32.pow(WIDTH - 1) + 10_i32.pow(WIDTH);
    Some(if is_upper { value } else { value + 26 * 36_i32.pow(WIDTH - 1) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hybrid_36_goes_on_where_decimals_end() {
        for (text, number) in [
            ("A000", 10_000),
            ("A001", 10_001),
            ("ZZZZ", 1_223_055),
            ("a000", 1_223_056),
            ("zzzz", 2_436_111),
        ] {
            assert_eq!(hybrid_36(text), Some(number), "{text}");
        }
        for text in ["", "A00", "0A00", "Aa00", "A0 0", "****", "A0000"] {
            assert_eq!(hybrid_36(text), None, "{text}");
        }
    }
}
