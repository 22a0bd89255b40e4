//! A molecule in one line.

use std::collections::{BTreeSet, HashMap, HashSet};

use serde::Serialize;
use walpha_base::advice::{Advice, advice};

use super::residues::{is_amino_acid, is_nucleotide, is_water};
use super::selection::named;
use super::{Atom, Molecule};

/// How many atoms of a file are left out, each for the first reason of these that holds.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct LeftOut {
    /// Atoms of other models.
    pub models: usize,
    /// Atoms of other chains.
    pub chains: usize,
    /// Molecules of water.
    pub waters: usize,
    /// Ligands, ions and modified residues (HETATM): their names, and how many there are of each.
    pub ligands: Vec<(String, usize)>,
    /// Hydrogens.
    pub hydrogens: usize,
    /// Sites of water that hold charge, and are not atoms: MW of TIP4P, say. Nothing takes them.
    pub virtual_sites: usize,
    /// Further places of atoms that have several.
    pub alternates: usize,
}

impl Molecule {
    /// What the atoms are, and what is left out, with the settings that take it: `1514 atoms: protein of chains A, B; left out:
    /// 127 waters (`waters`), 1 ligand (XK2) (`hetero`)`.
    pub fn summary(&self) -> Advice {
        let what = match self.contents() {
            contents if contents.is_empty() => String::new(),
            contents => format!(": {contents}"),
        };
        let atoms = if self.atoms.len() == 1 { "atom" } else { "atoms" };
        let mut summary = advice![format!("{} {atoms}{what}", self.atoms.len())];
        for (k, (what, setting)) in self.left_out.reasons().into_iter().enumerate() {
            let before = if k > 0 { ", " } else { "; left out: " };
            summary = summary.and(advice![before, what]);
            if let Some(setting) = setting {
                summary = summary.and(advice![" (", setting, ")"]);
            }
        }
        summary
    }

    /// Whether atoms of the file are left out.
    pub fn is_part(&self) -> bool {
        self.left_out != LeftOut::default()
    }

    fn contents(&self) -> String {
        let mut polymers = BTreeSet::new();
        let (mut chains, mut known) = (Vec::new(), HashSet::new());
        let (mut waters, mut ligands, mut others) =
            (Runs::default(), Runs::default(), Runs::default());
        let mut elements = BTreeSet::new();
        for atom in &self.atoms {
            if atom.residue.is_empty() {
                elements.extend(atom.element);
            } else if is_water(&atom.residue) {
                waters.add(atom);
            } else if atom.hetero {
                ligands.add(atom);
            } else if is_amino_acid(&atom.residue) || is_nucleotide(&atom.residue) {
                // Proteins come first.
                polymers.insert(!is_amino_acid(&atom.residue));
                if !atom.chain.is_empty() && known.insert(&*atom.chain) {
                    chains.push(&*atom.chain);
                }
            } else {
                others.add(atom);
            }
        }
        let mut parts = Vec::new();
        if !polymers.is_empty() {
            let kinds: Vec<&str> = polymers
                .iter()
                .map(|nucleic| if *nucleic { "nucleic acid" } else { "protein" })
                .collect();
            let of = match chains.len() {
                0 => String::new(),
                1 => format!(" of chain {}", chains[0]),
                _ => format!(" of chains {}", listed(&chains)),
            };
            parts.push(format!("{}{of}", kinds.join(" and ")));
        }
        for (runs, one, many) in
            [(others, "other residue", "other residues"), (ligands, "ligand", "ligands")]
        {
            let runs = runs.finish();
            let names: Vec<String> = runs.iter().map(named).collect();
            match runs.iter().map(|(_, count)| count).sum() {
                0 => {}
                1 => parts.push(format!("1 {one} ({})", listed(&names))),
                n => parts.push(format!("{n} {many} ({})", listed(&names))),
            }
        }
        match waters.count() {
            0 => {}
            1 => parts.push("1 water".into()),
            n => parts.push(format!("{n} waters")),
        }
        if !elements.is_empty() {
            let symbols: Vec<&str> = elements.into_iter().map(super::Element::symbol).collect();
            parts.push(listed(&symbols));
        }
        parts.join(", ")
    }
}

/// Residues among atoms: those of one residue are in a row.
#[derive(Default)]
pub(super) struct Runs<'a> {
    last: Option<&'a Atom>,
    names: Vec<(&'a str, usize)>,
    /// The place of each name.
    known: HashMap<&'a str, usize>,
}

impl<'a> Runs<'a> {
    pub(super) fn add(&mut self, atom: &'a Atom) {
        let key = |atom: &'a Atom| {
            (atom.model, &*atom.chain, atom.number, atom.insertion, &*atom.residue)
        };
        if self.last.replace(atom).is_some_and(|last| key(last) == key(atom)) {
            return;
        }
        let at = *self.known.entry(&atom.residue).or_insert(self.names.len());
        if at == self.names.len() {
            self.names.push((&atom.residue, 0));
        }
        self.names[at].1 += 1;
    }

    pub(super) fn count(&self) -> usize {
        self.names.iter().map(|(_, count)| count).sum()
    }

    /// The names of the residues, and how many there are of each, in the order of their first ones.
    pub(super) fn finish(self) -> Vec<(String, usize)> {
        self.names.into_iter().map(|(name, count)| (name.into(), count)).collect()
    }
}

/// Names as a list, of which the first are written.
pub(super) fn listed(names: &[impl AsRef<str>]) -> String {
    /// As many at most.
    const SHOWN: usize = 8;
    let shown: Vec<&str> = names.iter().take(SHOWN).map(AsRef::as_ref).collect();
    match names.len().saturating_sub(SHOWN) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}
