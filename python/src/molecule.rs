//! Molecules and crystals.

use std::path::PathBuf;

use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use walpha::points::{Atom, AtomSelection, Models, PointOptions, Radii, read_model};
use walpha::progress::Stage;

use crate::errors::wrong;
use crate::shape::json;
use crate::work::{Task, run};

/// Places, radii, and for each atom the symbol of its element, its name, the name and number of its residue, and its chain; the vectors of the
/// cell, and along which atoms repeat; the coordinates as JSON; and what was read and left out, in words.
#[derive(IntoPyObject)]
pub struct Read<'py> {
    positions: Bound<'py, PyArray2<f64>>,
    radii: Option<Bound<'py, PyArray1<f64>>>,
    elements: Vec<&'static str>,
    names: Vec<String>,
    residues: Vec<String>,
    numbers: Vec<Option<i32>>,
    chains: Vec<String>,
    cell: Option<([[f64; 3]; 3], [bool; 3])>,
    coordinates: String,
    summary: String,
}

/// Which atoms are read, and their radii.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Choice {
    radii: Option<String>,
    hydrogens: bool,
    waters: bool,
    hetero: bool,
    chains: Option<Vec<String>>,
    /// The number of a model; 0 for all.
    model: Option<u32>,
}

impl Choice {
    fn options(self) -> PointOptions {
        let models = self.model.map(|number| match number {
            0 => Models::All,
            number => Models::One(number),
        });
        let atoms = AtomSelection::default()
            .hydrogens(self.hydrogens)
            .waters(self.waters)
            .hetero(self.hetero)
            .chains(self.chains)
            .models(models);
        let radii = self.radii.map(|radii| {
            let Ok(radii) = radii.parse::<Radii>();
            radii
        });
        PointOptions::default().radii(radii).atoms(atoms)
    }
}

/// The atoms of a file.
#[pyfunction]
pub fn read_molecule(py: Python<'_>, path: PathBuf, choice: Choice) -> PyResult<Read<'_>> {
    let options = choice.options();
    let (points, facts) = run(py, &Task::default(), move || {
        let _ = Stage::Read.begin();
        read_model(&path, &options)
    })?;
    let Some(molecule) = points.molecule else {
        return Err(wrong("the file states no atoms: read it by walpha.read_points"));
    };
    let radii = points.weights.filter(|_| points.of_radii);
    let rows = points.positions.len();
    let text =
        |of: fn(&Atom) -> &str| molecule.atoms.iter().map(|atom| of(atom).to_owned()).collect();
    Ok(Read {
        positions: points.positions.into_flattened().into_pyarray(py).reshape([rows, 3])?,
        radii: radii
            .map(|radii| radii.into_iter().map(f64::sqrt).collect::<Vec<_>>().into_pyarray(py)),
        elements: molecule
            .atoms
            .iter()
            .map(|atom| atom.element.map_or("", |element| element.symbol()))
            .collect(),
        names: text(|atom| &atom.name),
        residues: text(|atom| &atom.residue),
        numbers: molecule.atoms.iter().map(|atom| atom.number).collect(),
        chains: text(|atom| &atom.chain),
        cell: facts.cell.map(|cell| (cell.vectors, cell.repeats)),
        coordinates: json(&facts.coordinates),
        // As the keywords of Python.
        summary: molecule.summary().with_names(|setting| format!("{}=True", setting.name())),
    })
}
