//! Residues by their names.

/// Amino acids: the twenty, and those of the same atoms that simulations call by the protons that they have.
const AMINO_ACIDS: &[&str] = &[
    "ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU", "GLY", "HIS", "ILE", "LEU", "LYS", "MET",
    "PHE", "PRO", "SER", "THR", "TRP", "TYR", "VAL", "ASH", "ASX", "CYM", "CYX", "GLH", "GLX",
    "HID", "HIE", "HIP", "HSD", "HSE", "HSP", "LYN", "PYL", "UNK",
];

/// Nucleotides.
const NUCLEOTIDES: &[&str] = &[
    "A", "C", "G", "I", "N", "U", "DA", "DC", "DG", "DI", "DN", "DT", "DU", "ADE", "CYT", "GUA",
    "THY", "URA",
];

/// Water: as the Protein Data Bank calls it, and as simulations do.
const WATERS: &[&str] =
    &["HOH", "DOD", "H2O", "SOL", "SOLV", "TIP", "TIP2", "TIP3", "TIP4", "TIP5", "WAT"];

/// Sites of models of water with four and five sites, by the names of GROMACS, Amber and CHARMM: they hold charge, and are not atoms.
const VIRTUAL_SITES: &[&str] = &["MW", "MW1", "MW2", "EPW", "EP1", "EP2", "OM", "LP1", "LP2"];

/// Whether a residue is an amino acid.
pub(super) fn is_amino_acid(name: &str) -> bool {
    AMINO_ACIDS.contains(&name)
}

/// Whether a residue is a nucleotide.
pub(super) fn is_nucleotide(name: &str) -> bool {
    NUCLEOTIDES.contains(&name)
}

/// Whether a residue is a part of a protein or nucleic acid that has no other elements than H, C, N, O, P and S.
pub(crate) fn is_polymer(name: &str) -> bool {
    is_amino_acid(name) || is_nucleotide(name)
}

/// Whether a residue is water.
pub(super) fn is_water(name: &str) -> bool {
    WATERS.contains(&name)
}

/// Whether what a residue of water calls so is not an atom.
pub(super) fn is_virtual_site(name: &str) -> bool {
    VIRTUAL_SITES.contains(&name)
}
