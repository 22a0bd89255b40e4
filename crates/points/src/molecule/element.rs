//! Chemical elements, and how names of atoms tell them.

use std::fmt;

use super::residues::is_polymer;

/// A chemical element.
///
/// ```
/// use walpha_points::Element;
///
/// let calcium = Element::named("CA").expect("an element");
/// assert_eq!((calcium.symbol(), calcium.number()), ("Ca", 20));
/// assert_eq!(Element::named("D").map(Element::symbol), Some("H"), "deuterium");
/// assert_eq!(Element::named("X"), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Element(u8);

/// By atomic number, from 1.
const SYMBOLS: [&str; 118] = [
    "H", "He", "Li", "Be", "B", "C", "N", "O", "F", "Ne", "Na", "Mg", "Al", "Si", "P", "S", "Cl",
    "Ar", "K", "Ca", "Sc", "Ti", "V", "Cr", "Mn", "Fe", "Co", "Ni", "Cu", "Zn", "Ga", "Ge", "As",
    "Se", "Br", "Kr", "Rb", "Sr", "Y", "Zr", "Nb", "Mo", "Tc", "Ru", "Rh", "Pd", "Ag", "Cd", "In",
    "Sn", "Sb", "Te", "I", "Xe", "Cs", "Ba", "La", "Ce", "Pr", "Nd", "Pm", "Sm", "Eu", "Gd", "Tb",
    "Dy", "Ho", "Er", "Tm", "Yb", "Lu", "Hf", "Ta", "W", "Re", "Os", "Ir", "Pt", "Au", "Hg", "Tl",
    "Pb", "Bi", "Po", "At", "Rn", "Fr", "Ra", "Ac", "Th", "Pa", "U", "Np", "Pu", "Am", "Cm", "Bk",
    "Cf", "Es", "Fm", "Md", "No", "Lr", "Rf", "Db", "Sg", "Bh", "Hs", "Mt", "Ds", "Rg", "Cn", "Nh",
    "Fl", "Mc", "Lv", "Ts", "Og",
];

impl Element {
    /// Hydrogen, of any mass.
    pub const HYDROGEN: Self = Self(1);

    /// The element of a symbol, in any letter case. D and T are hydrogen.
    pub fn named(symbol: &str) -> Option<Self> {
        if ["D", "T"].iter().any(|isotope| isotope.eq_ignore_ascii_case(symbol)) {
            return Some(Self::HYDROGEN);
        }
        let at = SYMBOLS.iter().position(|known| known.eq_ignore_ascii_case(symbol))?;
        Self::numbered(at as u64 + 1)
    }

    /// The element of an atomic number.
    pub fn numbered(number: u64) -> Option<Self> {
        u8::try_from(number).ok().filter(|n| (1..=SYMBOLS.len()).contains(&(*n).into())).map(Self)
    }

    /// Its symbol, as in `Ca`.
    pub fn symbol(self) -> &'static str {
        SYMBOLS[usize::from(self.0) - 1]
    }

    /// Its atomic number.
    pub fn number(self) -> u8 {
        self.0
    }

    /// Its colour in pictures, red, green and blue: those of Corey, Pauling and Koltun (CPK), as molecular viewers have them for the
    /// elements that are common in molecules, and pink for the others.
    pub fn colour(self) -> [u8; 3] {
        match self.symbol() {
            "H" => [255, 255, 255],
            "C" => [144, 144, 144],
            "N" => [48, 80, 248],
            "O" => [255, 13, 13],
            "F" | "Cl" => [31, 220, 31],
            "Na" | "K" | "Li" => [143, 64, 212],
            "Mg" | "Ca" => [61, 190, 0],
            "Si" => [240, 200, 160],
            "P" => [255, 128, 0],
            "S" => [255, 230, 48],
            "Fe" => [224, 102, 51],
            "Cu" => [200, 128, 51],
            "Zn" => [125, 128, 176],
            "Se" => [255, 161, 0],
            "Br" => [166, 41, 41],
            "I" => [148, 0, 148],
            _ => [221, 119, 180],
        }
    }

    /// The element of an atom whose file states none, from its name and its residue; `None` where two readings differ.
    /// `begins` says whether the name begins in the first of its four columns in a PDB file, where that is known: there
    /// the symbol of the element ends in the second column (wwPDB, Atomic Coordinate Entry Format 3.3, ATOM), so `CA` in
    /// the first two is calcium, and in the second and third a carbon called α. Names of four characters fill all
    /// columns.
    pub(crate) fn of_name(name: &str, begins: Option<bool>, residue: &str) -> Option<Self> {
        let bare = name.trim_start_matches(|c: char| c.is_ascii_digit());
        let end = bare.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(bare.len());
        let letters = &bare[..end];
        let one = Self::named(letters.get(..1)?);
        // Polymers hold no other elements whose symbols have two letters: selenium is in residues that are not listed.
        if is_polymer(residue) {
            return one;
        }
        let two = letters.get(..2).and_then(Self::named);
        let is_ion = residue
            .trim_end_matches(|c: char| c.is_ascii_digit() || "+-".contains(c))
            .eq_ignore_ascii_case(letters);
        let full = name.len() > 3 || bare.len() < name.len();
        match begins {
            Some(false) => one,
            // Names of hydrogens are long: those of four characters have no column to spare.
            _ if one == Some(Self::HYDROGEN) && !is_ion => one,
            Some(true) if !full => two.or(one),
            _ if two.is_none() => one,
            _ if one.is_none() || is_ion => two,
            _ => None,
        }
    }
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.symbol())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_have_their_numbers() {
        let numbers = [("H", 1), ("c", 6), ("FE", 26), ("Zn", 30), ("u", 92), ("Og", 118)];
        for (symbol, number) in numbers {
            assert_eq!(Element::named(symbol).map(Element::number), Some(number), "{symbol}");
            assert_eq!(Element::numbered(number.into()), Element::named(symbol));
        }
        for symbol in ["", "X", "CA1", "1"] {
            assert_eq!(Element::named(symbol), None, "{symbol}");
        }
        assert_eq!([0, 119, 257].map(Element::numbered), [None; 3]);
    }

    #[test]
    fn names_of_atoms_tell_elements() {
        let of = |name, begins, residue| {
            Element::of_name(name, begins, residue).map_or("-", Element::symbol)
        };
        for (name, begins, residue, element) in [
            ("CA", Some(false), "ALA", "C"),
            // Left-aligned, as some programs write.
            ("CA", Some(true), "ALA", "C"),
            ("CA", Some(true), "CA", "Ca"),
            ("CA", None, "CA", "Ca"),
            ("CA", None, "LIG", "-"),
            ("HG11", Some(true), "VAL", "H"),
            ("1HB", Some(true), "LIG", "H"),
            ("HG", Some(true), "HG", "Hg"),
            ("HG", Some(true), "LIG", "H"),
            ("HO", None, "HO3", "Ho"),
            ("FE", Some(true), "HEM", "Fe"),
            ("SE", Some(true), "MSE", "Se"),
            ("C12", Some(false), "LIG", "C"),
            ("C12", None, "LIG", "C"),
            ("C10A", Some(true), "LIG", "C"),
            // Carbon δ, or cadmium.
            ("CD11", Some(true), "LIG", "-"),
            ("NA", Some(true), "NA", "Na"),
            ("NA+", None, "NA+", "Na"),
            ("ZN", None, "ZN2", "Zn"),
            ("O5'", Some(false), "DA", "O"),
            ("H5''", Some(true), "DA", "H"),
            ("", Some(false), "LIG", "-"),
            ("1", Some(true), "LIG", "-"),
        ] {
            assert_eq!(of(name, begins, residue), element, "{name} {begins:?} {residue}");
        }
    }
}
