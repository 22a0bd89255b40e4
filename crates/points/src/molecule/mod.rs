//! Atoms of molecules: what a file says of each, which of them become points, and their radii.
//!
//! The readers of PDB, mmCIF and PQR are ours, rather than those of a library. The one that is kept, pdbtbx 0.12, sorts atoms into
//! chains and residues, so that points would not have the order of the file; it does not read hybrid-36 numbers, which files of
//! more than 99 999 atoms have, and of mmCIF it loses names of HETATM atoms. The formats are simple: fixed columns, words, and
//! loops. What they leave open is refused here, never guessed.

mod element;
mod peptide;
mod radii;
pub(crate) mod residues;
mod selection;
mod summary;

use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;

use walpha_base::advice::{Setting, advice};
use walpha_base::keep;
use walpha_base::memory::{NoMemory, afford, try_reserve, try_with_capacity};
use walpha_base::shown::shown;

pub use element::Element;
pub(crate) use peptide::{PEPTIDE, peptide};
pub use radii::Radii;
use radii::Table;
pub use selection::{AtomSelection, Models};
pub use summary::LeftOut;

use crate::read::{format, take_radii};
use crate::{Cell, ModelMetadata, PointOptions, Points, PointsError};
use walpha_volume::{Coordinates, LengthUnit, Reason, Space};

/// What a file says of an atom, but its place and radius.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Atom {
    /// Its name in its residue, as in `CA`; of XYZ the element as the file has it.
    pub name: Arc<str>,
    /// Its element, if the file states it or its name leaves one reading.
    pub element: Option<Element>,
    /// The name of its residue, as in `ALA`; empty if there is none.
    pub residue: Arc<str>,
    /// The number of its residue, which the author gave it.
    pub number: Option<i32>,
    /// The insertion code behind this number.
    pub insertion: Option<char>,
    /// Its chain, as the author calls it; empty if there is none.
    pub chain: Arc<str>,
    /// Its model, as the file numbers them; 1 if it does not.
    pub model: u32,
    /// The label of its place, if it has several.
    pub alternate: Option<char>,
    /// Whether it is in no chain of a polymer, as ligands, ions and water (HETATM).
    pub hetero: bool,
    /// The share of cells that it is in.
    pub occupancy: Option<f64>,
    /// Its partial charge, of PQR, in elementary charges.
    pub charge: Option<f64>,
}

/// The atoms that points are, and those of their file that are left out.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Molecule {
    /// An atom for each point.
    pub atoms: Vec<Atom>,
    /// How many are left out, and why.
    pub left_out: LeftOut,
}

/// The atoms of a file, all of them.
#[derive(Default)]
pub(crate) struct Found {
    positions: Vec<[f64; 3]>,
    atoms: Vec<Atom>,
    /// Their radii, if the file states them.
    pub radii: Option<Vec<f64>>,
    /// The cell in which they repeat.
    pub cell: Option<Cell>,
    /// Whether their places have no unit that is known; otherwise they are in ångströms.
    pub is_unitless: bool,
    names: HashSet<Arc<str>>,
}

impl Found {
    pub(crate) fn push(&mut self, position: [f64; 3], atom: Atom) -> Result<(), NoMemory> {
        const WHAT: &str = "the atoms of a file";
        try_reserve(&mut self.positions, 1, || WHAT.into())?;
        try_reserve(&mut self.atoms, 1, || WHAT.into())?;
        self.positions.push(position);
        self.atoms.push(atom);
        Ok(())
    }

    /// A name, of which there is one copy for all atoms.
    pub(crate) fn name(&mut self, name: &str) -> Arc<str> {
        if let Some(known) = self.names.get(name) {
            return Arc::clone(known);
        }
        let name: Arc<str> = name.into();
        self.names.insert(Arc::clone(&name));
        name
    }

    /// The number of atoms so far.
    pub(crate) fn len(&self) -> usize {
        self.atoms.len()
    }

    /// The index of the first atom of the models that are asked for; 0 if there is none.
    pub(crate) fn first_of(&self, models: Option<Models>) -> usize {
        match models {
            None | Some(Models::All) => 0,
            Some(Models::One(number)) => {
                self.atoms.iter().position(|atom| atom.model == number).unwrap_or(0)
            }
        }
    }

    /// The last atom so far.
    pub(crate) fn last(&self) -> Option<&Atom> {
        self.atoms.last()
    }

    /// The points of the atoms that are asked for.
    ///
    /// # Errors
    /// None is left, a chain or model is not there, or a radius is not known.
    pub(crate) fn select(
        self,
        path: &Path,
        selection: &AtomSelection,
        options: &PointOptions,
    ) -> Result<(Points, ModelMetadata), PointsError> {
        let (kept, left_out) = selection.of(path, &self.atoms)?;
        let Self { positions, atoms, radii, cell, is_unitless, .. } = self;
        let molecule = Molecule { atoms, left_out };
        let mut points = Points { molecule: Some(molecule), ..Points::new(positions) };
        points.keep(&kept);
        let radii = radii.map(|mut radii| {
            keep(&mut radii, &kept);
            radii
        });
        points.look_up_radii(path, radii, options.radii.as_ref())?;
        match points.len() - points.count_places()? {
            0 => {}
            1 => tracing::warn!("{}: an atom lies exactly where another does", shown(path)),
            n => tracing::warn!("{}: {n} atoms lie exactly where others do", shown(path)),
        }
        let unit = if is_unitless { LengthUnit::Unstated } else { LengthUnit::Angstrom };
        let coordinates = Coordinates { unit, space: Space::default() };
        Ok((points, ModelMetadata::default().coordinates(coordinates).cell(cell)))
    }
}

impl Found {
    /// The points of all atoms. Names of which none is an element are labels, unless radii are asked for: the points are those of no
    /// molecule, and have the radii of the file, if it states any.
    ///
    /// # Errors
    /// A radius is not known.
    pub(crate) fn all(
        self,
        path: &Path,
        options: &PointOptions,
    ) -> Result<(Points, ModelMetadata), PointsError> {
        let are_labels = self.atoms.iter().all(|atom| atom.element.is_none());
        let asked = options.radii.as_ref();
        if !are_labels || asked.is_some_and(|radii| *radii != Radii::None) {
            return self.select(path, &AtomSelection::ALL, options);
        }
        let mut options = options.clone();
        if asked.is_none() && self.radii.is_none() {
            warn_of_labels(path, self.atoms.first());
            options.radii = Some(Radii::None);
        }
        let (mut points, metadata) = self.select(path, &AtomSelection::ALL, &options)?;
        points.molecule = None;
        Ok((points, metadata))
    }
}

/// Says that atoms have no radii, as their names are not elements.
pub(crate) fn warn_of_labels(path: &Path, first: Option<&Atom>) {
    if let Some(first) = first {
        tracing::warn!(
            "{}: its names of atoms are not elements ({:?}), so they have no radii; `radii` FILE gives them",
            shown(path),
            first.name
        );
    }
}

impl Points {
    /// The number of different places. O(n).
    fn count_places(&self) -> Result<usize, NoMemory> {
        // A set has room for up to twice as many.
        afford(2 * size_of_val(&self.positions[..]), || "the set of places of atoms".into())?;
        let bits = |place: &[f64; 3]| place.map(|x| (x + 0.0).to_bits());
        Ok(self.positions.iter().map(bits).collect::<HashSet<_>>().len())
    }

    /// Sets the weights to the squares of the atoms' radii: of those of the file, if there are any and no others are asked for.
    ///
    /// # Errors
    /// A radius is not known.
    pub(crate) fn look_up_radii(
        &mut self,
        path: &Path,
        own: Option<Vec<f64>>,
        asked: Option<&Radii>,
    ) -> Result<(), PointsError> {
        let of_file;
        let table = match (asked, own) {
            (Some(Radii::None), _) => return Ok(()),
            (Some(Radii::Column) | None, own @ Some(_)) => return take_radii(path, self, own),
            (Some(Radii::Column), None) => {
                let what = "states no radii";
                let next = advice!["give ", Setting::Radii, " bondi, protor or a table of radii"];
                return Err(format(path, Reason::choice(Setting::Radii, what, next)));
            }
            (Some(Radii::ProtOr), _) => Table::protor(),
            (Some(Radii::Bondi) | None, _) => Table::bondi(),
            (Some(Radii::File(path)), _) => {
                of_file = Table::open(path)?;
                &of_file
            }
        };
        let atoms = self.molecule.as_ref().map_or(&[][..], |molecule| &molecule.atoms);
        let mut radii = try_with_capacity(atoms.len(), || "the radii of atoms".into())?;
        radii.extend(atoms.iter().map_while(|atom| table.radius(atom)));
        if radii.len() < atoms.len() {
            let unknown: Vec<&Atom> =
                atoms.iter().filter(|atom| table.radius(atom).is_none()).collect();
            return Err(format(path, without_radius(&unknown, asked)));
        }
        self.weights = None;
        take_radii(path, self, Some(radii))
    }
}

/// The error for atoms whose radius is not known, which names them.
fn without_radius(atoms: &[&Atom], asked: Option<&Radii>) -> Reason {
    /// As many at most.
    const NAMED: usize = 8;
    let mut names: Vec<String> = Vec::new();
    for atom in atoms {
        let of =
            if atom.residue.is_empty() { String::new() } else { format!(" of {}", atom.residue) };
        let name = format!("{}{of}", atom.name);
        if !names.contains(&name) {
            names.push(name);
        }
        if names.len() > NAMED {
            break;
        }
    }
    if names.len() > NAMED {
        names[NAMED] = "others".into();
    }
    let set = asked.unwrap_or(&Radii::Bondi);
    let unread = atoms.iter().all(|atom| atom.element.is_none());
    let why = if unread && !matches!(set, Radii::ProtOr) {
        ", as the file does not say of which element they are"
    } else {
        ""
    };
    let what = format!(
        "has {} whose radius {set} does not tell{why}: {}",
        if atoms.len() == 1 { "an atom".into() } else { format!("{} atoms", atoms.len()) },
        names.join(", ")
    );
    let next = advice![
        "give a table with the radii of all atoms (",
        Setting::Radii,
        " FILE; docs/formats.md says how it looks), leave these out, or take points without radii (",
        Setting::Radii,
        " none)"
    ];
    Reason::choice(Setting::Radii, what, next)
}
