//! Which atoms of a file become points.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use serde::{Deserialize, Serialize};
use walpha_base::advice::{Advice, Setting, advice};
use walpha_base::memory::try_with_capacity;

use super::residues::{is_virtual_site, is_water};
use super::summary::{LeftOut, Runs, listed};
use super::{Atom, Element};
use crate::PointsError;
use crate::read::format;
use walpha_volume::Reason;

/// Which atoms of a molecule become points. By default the heavy atoms of the polymers in the first model, as in
/// `FreeSASA` (Mitternacht 2016, [doi:10.12688/f1000research.7931.1]).
///
/// An atom with alternate places has the one without a label; without it, the one whose label comes first in its residue, or else its
/// first.
///
/// [doi:10.12688/f1000research.7931.1]: https://doi.org/10.12688/f1000research.7931.1
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct AtomSelection {
    /// Whether hydrogens are taken.
    pub hydrogens: bool,
    /// Whether water is taken.
    pub waters: bool,
    /// Whether other atoms that are in no chain of a polymer are taken (HETATM): ligands, ions, modified residues.
    pub hetero: bool,
    /// The chains to take, as the author calls them; `None` takes all.
    pub chains: Option<Vec<String>>,
    /// The models to take; `None` takes the first.
    pub models: Option<Models>,
}

/// Models of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Models {
    /// All of them together, as those of a biological assembly.
    All,
    /// The one of this number.
    One(u32),
}

/// A residue, in which an atom has alternate places.
type Residue<'a> = (u32, &'a str, Option<i32>, Option<char>);

impl AtomSelection {
    /// All atoms of all models.
    pub(crate) const ALL: Self = Self {
        hydrogens: true,
        waters: true,
        hetero: true,
        chains: None,
        models: Some(Models::All),
    };

    walpha_base::setters! {
        hydrogens: bool,
        waters: bool,
        hetero: bool,
        chains: Option<Vec<String>>,
        models: Option<Models>,
    }

    /// Whether each atom is kept, and how many are not.
    ///
    /// # Errors
    /// A chain or model is not there, or no atom is left.
    pub(super) fn of(
        &self,
        path: &Path,
        atoms: &[Atom],
    ) -> Result<(Vec<bool>, LeftOut), PointsError> {
        self.check(atoms).map_err(|reason| format(path, reason))?;
        let first = atoms.first().map_or(1, |atom| atom.model);
        let mut left_out = LeftOut::default();
        let (mut waters, mut ligands) = (Runs::default(), Runs::default());
        let mut kept = try_with_capacity(atoms.len(), || "the choice of atoms".into())?;
        for atom in atoms {
            let of_model = match self.models {
                None => atom.model == first,
                Some(Models::One(number)) => atom.model == number,
                Some(Models::All) => true,
            };
            let of_chain = || match &self.chains {
                None => true,
                Some(chains) => chains.iter().any(|chain| **chain == *atom.chain),
            };
            let is_water = is_water(&atom.residue);
            let mut is_kept = false;
            if !of_model {
                left_out.models += 1;
            } else if !of_chain() {
                left_out.chains += 1;
            } else if is_water && !self.waters {
                waters.add(atom);
            } else if atom.hetero && !is_water && !self.hetero {
                ligands.add(atom);
            } else if is_water && is_virtual_site(&atom.name) {
                left_out.virtual_sites += 1;
            } else if atom.element == Some(Element::HYDROGEN) && !self.hydrogens {
                left_out.hydrogens += 1;
            } else {
                is_kept = true;
            }
            kept.push(is_kept);
        }
        let places = Places::of(atoms.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(a, _)| a));
        for (atom, kept) in atoms.iter().zip(&mut kept).filter(|(_, kept)| **kept) {
            *kept = places.has(atom);
            left_out.alternates += usize::from(!*kept);
        }
        left_out.waters = waters.count();
        left_out.ligands = ligands.finish();
        if !atoms.is_empty() && !kept.contains(&true) {
            return Err(format(path, none_left(atoms.len(), &left_out)));
        }
        Ok((kept, left_out))
    }

    /// Refuses chains and models that are not there.
    fn check(&self, atoms: &[Atom]) -> Result<(), Reason> {
        if let Some(chains) = &self.chains {
            let known: BTreeSet<&str> = atoms.iter().map(|atom| &*atom.chain).collect();
            if let Some(missing) = chains.iter().find(|chain| !known.contains(chain.as_str())) {
                let named: Vec<&str> = known.into_iter().filter(|name| !name.is_empty()).collect();
                let next = match &named[..] {
                    [] => advice!["omit ", Setting::Chains, ": its chains have no names"],
                    named => {
                        advice!["give ", Setting::Chains, format!(" some of {}", listed(named))]
                    }
                };
                let what = format!("has no chain {missing:?}");
                return Err(Reason::choice(Setting::Chains, what, next));
            }
        }
        if let Some(Models::One(number)) = self.models {
            let known: BTreeSet<u32> = atoms.iter().map(|atom| atom.model).collect();
            if !known.contains(&number) {
                let numbers: Vec<String> = known.iter().map(u32::to_string).collect();
                let next = advice![
                    "give ",
                    Setting::Models,
                    format!(" all, or one of {}", listed(&numbers))
                ];
                let what = format!("has no model {number}");
                return Err(Reason::choice(Setting::Models, what, next));
            }
        }
        Ok(())
    }
}

/// The alternate place that each atom has: the one without a label; without it, the one whose label comes first in the residue;
/// without that, the first.
struct Places<'a> {
    /// The first label in each residue that has one, and the name of the residue there: others are other molecules in its place.
    first: HashMap<Residue<'a>, (char, &'a str)>,
    /// The label of each atom of these residues, by its name.
    of_atoms: HashMap<(Residue<'a>, &'a str), Option<char>>,
}

impl<'a> Places<'a> {
    fn of(atoms: impl Iterator<Item = &'a Atom> + Clone) -> Self {
        let mut first = HashMap::new();
        for atom in atoms.clone() {
            if let Some(label) = atom.alternate {
                first.entry(residue(atom)).or_insert((label, &*atom.residue));
            }
        }
        let mut of_atoms = HashMap::new();
        if !first.is_empty() {
            for atom in atoms {
                let Some(&(label, _)) = first.get(&residue(atom)) else { continue };
                let place = of_atoms.entry((residue(atom), &*atom.name)).or_insert(atom.alternate);
                let is_first = atom.alternate == Some(label) && place.is_some();
                if atom.alternate.is_none() || is_first {
                    *place = atom.alternate;
                }
            }
        }
        Self { first, of_atoms }
    }

    /// Whether an atom is at its place.
    fn has(&self, atom: &Atom) -> bool {
        let Some(label) = atom.alternate else { return true };
        let (first, name) = self.first[&residue(atom)];
        (label == first || *atom.residue == *name)
            && self.of_atoms[&(residue(atom), &*atom.name)] == Some(label)
    }
}

fn residue(atom: &Atom) -> Residue<'_> {
    (atom.model, &atom.chain, atom.number, atom.insertion)
}

/// The error for a file of which no atom is left.
fn none_left(atoms: usize, left_out: &LeftOut) -> Reason {
    let reasons = left_out.reasons();
    let all: Vec<&str> = reasons.iter().map(|(what, _)| what.as_str()).collect();
    let what = format!("holds {atoms} atoms, and none is left: {}", all.join(", "));
    let settings: Vec<Setting> = reasons.iter().filter_map(|(_, setting)| *setting).collect();
    let mut next = advice!["give "];
    for (k, setting) in settings.iter().enumerate() {
        let before = if k > 0 { " or " } else { "" };
        next = next.and(advice![before, *setting]);
    }
    let next: Advice = next.and(advice![" to take them"]);
    Reason::choice(settings.first().copied().unwrap_or(Setting::Hetero), what, next)
}

impl LeftOut {
    /// How many are left out for each reason, and the setting that takes them, if there is one.
    pub(super) fn reasons(&self) -> Vec<(String, Option<Setting>)> {
        let count = |n: usize, one: &str, many: &str| match n {
            1 => format!("1 {one}"),
            n => format!("{n} {many}"),
        };
        let ligands = || {
            let names: Vec<String> = self.ligands.iter().map(named).collect();
            let total = self.ligands.iter().map(|(_, count)| count).sum();
            format!("{} ({})", count(total, "ligand", "ligands"), listed(&names))
        };
        let mut reasons = Vec::new();
        if self.waters > 0 {
            reasons.push((count(self.waters, "water", "waters"), Some(Setting::Waters)));
        }
        if !self.ligands.is_empty() {
            reasons.push((ligands(), Some(Setting::Hetero)));
        }
        if self.hydrogens > 0 {
            reasons
                .push((count(self.hydrogens, "hydrogen", "hydrogens"), Some(Setting::Hydrogens)));
        }
        if self.virtual_sites > 0 {
            let what = count(self.virtual_sites, "virtual site of water", "virtual sites of water");
            reasons.push((what, None));
        }
        if self.alternates > 0 {
            reasons.push((count(self.alternates, "alternate place", "alternate places"), None));
        }
        if self.models > 0 {
            let what = count(self.models, "atom of other models", "atoms of other models");
            reasons.push((what, Some(Setting::Models)));
        }
        if self.chains > 0 {
            let what = count(self.chains, "atom of other chains", "atoms of other chains");
            reasons.push((what, Some(Setting::Chains)));
        }
        reasons
    }
}

/// The name of residues, and how many there are if there are several.
pub(super) fn named((name, count): &(String, usize)) -> String {
    if *count == 1 { name.clone() } else { format!("{count} {name}") }
}
