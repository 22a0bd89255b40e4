//! The tables of `walpha balls`.

use std::io::{self, Write};
use std::path::Path;

use super::{Measured, Subject};
use crate::balls::{Bounded, Cavity, Pocket};
use crate::points::Atom;

/// What is written, by the end of a file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Table {
    /// A row for each ball, in the order of the input.
    Balls,
    /// A row for each residue of a molecule.
    Residues,
    /// A row for each pair of balls that meet in their power cells.
    Contacts,
    /// A row for each void.
    Voids,
    /// A row for each pocket, voids included.
    Pockets,
    /// The balls at each pocket, as atoms of a PDB file.
    PocketAtoms,
}

impl Table {
    /// The extensions of tables.
    pub(super) const EXTENSIONS: [&str; 2] = ["csv", "pdb"];

    /// The table that a name asks for, if it asks for one.
    pub(super) fn of(name: &Path) -> Option<Self> {
        let stem = name.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
        let extension = name.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match extension.as_str() {
            "csv" if stem.ends_with("residues") => Some(Self::Residues),
            "csv" if stem.ends_with("contacts") => Some(Self::Contacts),
            "csv" if stem.ends_with("voids") => Some(Self::Voids),
            "csv" if stem.ends_with("pockets") => Some(Self::Pockets),
            "csv" => Some(Self::Balls),
            "pdb" => Some(Self::PocketAtoms),
            _ => None,
        }
    }

    /// Whether it is of pockets.
    pub(super) fn needs_pockets(self) -> bool {
        matches!(self, Self::Pockets | Self::PocketAtoms)
    }

    /// Writes the table.
    ///
    /// # Errors
    /// Whatever `out` returns.
    pub(super) fn write(self, of: &Subject<'_>, out: &mut dyn Write) -> io::Result<()> {
        match self {
            Self::PocketAtoms => pocket_atoms(of, out),
            Self::Balls => balls(of, &mut csv::Writer::from_writer(out)),
            Self::Residues => residues(of, &mut csv::Writer::from_writer(out)),
            Self::Contacts => contacts(of, &mut csv::Writer::from_writer(out)),
            Self::Voids => voids(of, &mut csv::Writer::from_writer(out)),
            Self::Pockets => pockets(of, &mut csv::Writer::from_writer(out)),
        }
    }
}

type Csv<W> = csv::Writer<W>;

/// The names of what a molecule says of an atom.
const OF_ATOM: [&str; 7] = ["model", "chain", "number", "insertion", "residue", "name", "element"];

fn of_atom(atom: &Atom) -> [String; 7] {
    let text = |of: Option<String>| of.unwrap_or_default();
    [
        atom.model.to_string(),
        atom.chain.to_string(),
        text(atom.number.map(|number| number.to_string())),
        text(atom.insertion.map(String::from)),
        atom.residue.to_string(),
        atom.name.to_string(),
        text(atom.element.map(|element| element.to_string())),
    ]
}

/// A value and its bound.
fn pair(number: Bounded) -> [String; 2] {
    [number.value.to_string(), number.bound.to_string()]
}

fn balls(of: &Subject<'_>, csv: &mut Csv<impl Write>) -> io::Result<()> {
    let Measured { union, .. } = of.measured;
    let numbers = ["x", "y", "z", "radius", "volume", "volume_bound", "area", "area_bound"];
    let names = of.molecule.map_or(&[][..], |_| &OF_ATOM);
    csv.write_record(names.iter().chain(&numbers))?;
    let positions = &of.shape.points().positions()[..of.shape.own_points()];
    for (row, (place, radius)) in positions.iter().zip(of.radii).enumerate() {
        let atom = of.molecule.map(|molecule| of_atom(&molecule.atoms[row]));
        let place = place.iter().chain([radius]).map(ToString::to_string);
        let measures = [union.volumes().get(row), union.areas().get(row)].map(pair);
        csv.write_record(
            atom.into_iter().flatten().chain(place).chain(measures.into_iter().flatten()),
        )?;
    }
    csv.flush()
}

fn residues(of: &Subject<'_>, csv: &mut Csv<impl Write>) -> io::Result<()> {
    let Measured { union, .. } = of.measured;
    let atoms = of.molecule.map_or(&[][..], |molecule| &molecule.atoms);
    csv.write_record([
        "model",
        "chain",
        "number",
        "insertion",
        "residue",
        "atoms",
        "volume",
        "volume_bound",
        "area",
        "area_bound",
    ])?;
    // Atoms of a residue follow each other.
    let key = |atom: &Atom| {
        (atom.model, atom.chain.clone(), atom.number, atom.insertion, atom.residue.clone())
    };
    let mut first = 0;
    for residue in atoms.chunk_by(|a, b| key(a) == key(b)) {
        let rows = first..first + residue.len();
        first = rows.end;
        let [model, chain, number, insertion, name, ..] = of_atom(&residue[0]);
        let measures = [union.volumes().sum(rows.clone()), union.areas().sum(rows)].map(pair);
        let count = residue.len().to_string();
        csv.write_record(
            [model, chain, number, insertion, name, count]
                .into_iter()
                .chain(measures.into_iter().flatten()),
        )?;
    }
    csv.flush()
}

fn contacts(of: &Subject<'_>, csv: &mut Csv<impl Write>) -> io::Result<()> {
    let contacts = of.measured.union.contacts();
    csv.write_record(["first", "second", "area", "area_bound"])?;
    for (row, [a, b]) in contacts.pairs.iter().enumerate() {
        let [area, bound] = pair(contacts.sizes.get(row));
        csv.write_record([a.to_string(), b.to_string(), area, bound])?;
    }
    csv.flush()
}

const OF_CAVITY: [&str; 6] =
    ["volume", "volume_bound", "area", "area_bound", "cells", "filling_alpha"];

fn of_cavity(cavity: &Cavity) -> impl Iterator<Item = String> {
    let measures = [cavity.volume, cavity.area].map(pair);
    let rest = [cavity.cells.to_string(), cavity.filling_alpha.to_string()];
    measures.into_iter().flatten().chain(rest)
}

/// Indices of balls, counted from 0.
fn lining(cavity: &Cavity) -> String {
    cavity.lining.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
}

fn voids(of: &Subject<'_>, csv: &mut Csv<impl Write>) -> io::Result<()> {
    csv.write_record(["void"].iter().chain(&OF_CAVITY).chain(&["balls"]))?;
    for (number, void) in (1..).zip(&of.measured.voids) {
        let number: u32 = number;
        csv.write_record(
            [number.to_string()].into_iter().chain(of_cavity(void)).chain([lining(void)]),
        )?;
    }
    csv.flush()
}

fn pockets(of: &Subject<'_>, csv: &mut Csv<impl Write>) -> io::Result<()> {
    csv.write_record(
        ["pocket", "mouths"].iter().chain(&OF_CAVITY).chain(&["closing_alpha", "balls"]),
    )?;
    for (number, Pocket { cavity, mouths, closing_alpha, .. }) in (1..).zip(&of.measured.pockets) {
        let number: u32 = number;
        let closing = closing_alpha.map_or(String::new(), |alpha| alpha.to_string());
        csv.write_record(
            [number.to_string(), mouths.len().to_string()]
                .into_iter()
                .chain(of_cavity(cavity))
                .chain([closing, lining(cavity)]),
        )?;
    }
    csv.flush()
}

/// Atoms at pockets, with the number of the pocket as temperature factor, as programs that show pockets expect. An atom at several pockets is
/// listed for each.
fn pocket_atoms(of: &Subject<'_>, out: &mut dyn Write) -> io::Result<()> {
    let positions = of.shape.points().positions();
    writeln!(
        out,
        "REMARK   1 ATOMS AT POCKETS: THE TEMPERATURE FACTOR IS THE NUMBER OF THE POCKET"
    )?;
    let mut serial = 0;
    for (pocket, found) in (1..).zip(&of.measured.pockets) {
        let pocket: u32 = pocket;
        for &v in &found.cavity.lining {
            serial += 1;
            let unnamed = Atom::default();
            let atom = of.molecule.map_or(&unnamed, |molecule| &molecule.atoms[v as usize]);
            let line = pdb_line(serial, atom, positions[v as usize], pocket);
            let line = line.map_err(|what| {
                io::Error::other(format!(
                    "ball {v} has {what}, for which a PDB file has no columns: write pockets.csv"
                ))
            })?;
            writeln!(out, "{line}")?;
        }
    }
    writeln!(out, "END")
}

/// A line of a PDB file, in fixed columns.
///
/// # Errors
/// The field that is wider than its columns.
fn pdb_line(serial: u32, atom: &Atom, place: [f64; 3], pocket: u32) -> Result<String, String> {
    let record = if atom.hetero || atom.residue.is_empty() { "HETATM" } else { "ATOM" };
    let symbol = atom.element.map(|element| element.to_string()).unwrap_or_default();
    let name = if atom.name.is_empty() { "X" } else { &atom.name };
    // A symbol of one letter stands in the second column.
    let name =
        if name.len() < 4 && symbol.len() < 2 { format!(" {name}") } else { name.to_owned() };
    let residue = if atom.residue.is_empty() { "UNK" } else { &atom.residue };
    let chain = &*atom.chain;
    // Names of four letters and chains of two share a column.
    let owner = match (residue.chars().count(), chain.chars().count()) {
        (..=3, ..=2) => format!("{residue:>3}{chain:>2}"),
        (4, ..=1) => format!("{residue}{chain:>1}"),
        _ => return Err(format!("the residue {residue} of the chain {chain}")),
    };
    let number = atom.number.unwrap_or(1);
    let insertion = atom.insertion.unwrap_or(' ');
    let factor = match pocket {
        ..1_000 => format!("{pocket}.00"),
        1_000..10_000 => format!("{pocket}.0"),
        _ => pocket.to_string(),
    };
    let [x, y, z] = place.map(|x| format!("{x:8.3}"));
    for (what, text, width) in [
        ("the name", &name, 4),
        ("the residue number", &number.to_string(), 4),
        ("the coordinate", &x, 8),
        ("the coordinate", &y, 8),
        ("the coordinate", &z, 8),
        ("the pocket", &factor, 6),
    ] {
        if text.chars().count() > width {
            return Err(format!("{what} {text}"));
        }
    }
    Ok(format!(
        "{record:<6}{:>5} {name:<4} {owner}{number:>4}{insertion}   {x}{y}{z}{:>6.2}{factor:>6}          {symbol:>2}",
        serial % 100_000,
        1.0,
    ))
}
