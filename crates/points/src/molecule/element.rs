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

/// Standard atomic weights up to uranium, or the mass number of an isotope where there is none (Meija et al. 2016,
/// doi:10.1515/pac-2015-0305).
const WEIGHTS: [f64; 92] = [
    1.008,
    4.002602,
    6.94,
    9.0121831,
    10.81,
    12.011,
    14.007,
    15.999,
    18.99840316,
    20.1797,
    22.98976928,
    24.305,
    26.9815385,
    28.085,
    30.973762,
    32.06,
    35.45,
    39.948,
    39.0983,
    40.078,
    44.955908,
    47.867,
    50.9415,
    51.9961,
    54.938044,
    55.845,
    58.933194,
    58.6934,
    63.546,
    65.38,
    69.723,
    72.63,
    74.921595,
    78.971,
    79.904,
    83.798,
    85.4678,
    87.62,
    88.90584,
    91.224,
    92.90637,
    95.95,
    97.90721,
    101.07,
    102.9055,
    106.42,
    107.8682,
    112.414,
    114.818,
    118.71,
    121.76,
    127.6,
    126.90447,
    131.293,
    132.905452,
    137.327,
    138.90547,
    140.116,
    140.90766,
    144.242,
    144.91276,
    150.36,
    151.964,
    157.25,
    158.92535,
    162.5,
    164.93033,
    167.259,
    168.93422,
    173.054,
    174.9668,
    178.49,
    180.94788,
    183.84,
    186.207,
    190.23,
    192.217,
    195.084,
    196.966569,
    200.592,
    204.38,
    207.2,
    208.9804,
    208.98243,
    209.98715,
    222.01758,
    223.01974,
    226.02541,
    227.02775,
    232.0377,
    231.03588,
    238.02891,
];

/// The elements of amino acids and nucleotides.
const OF_POLYMERS: [&str; 6] = ["H", "C", "N", "O", "P", "S"];

/// Ions as CHARMM calls them, residues of one atom.
const IONS: [(&str, &str); 9] = [
    ("BAR", "Ba"),
    ("CAD", "Cd"),
    ("CAL", "Ca"),
    ("CES", "Cs"),
    ("CLA", "Cl"),
    ("LIT", "Li"),
    ("POT", "K"),
    ("RUB", "Rb"),
    ("SOD", "Na"),
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

    /// The element of an atom of this mass, in units of atomic mass: a file rounds it to a few digits, so a thousandth may be missing,
    /// or 0.01. Groups of atoms that are one particle (CH2 of 14.027) are further from elements.
    pub(crate) fn of_mass(mass: f64) -> Option<Self> {
        let off = |at: &usize| (WEIGHTS[*at] - mass).abs();
        let nearest = (0..WEIGHTS.len()).min_by(|one, other| off(one).total_cmp(&off(other)))?;
        let most = f64::max(0.0101, 1e-3 * WEIGHTS[nearest]);
        if off(&nearest) <= most { Self::numbered(nearest as u64 + 1) } else { None }
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
        // Selenium is in residues that are not listed. Beads of coarse models have other letters.
        if is_polymer(residue) {
            return one.filter(|element| OF_POLYMERS.contains(&element.symbol()));
        }
        let two = letters.get(..2).and_then(Self::named);
        // A residue of one atom, whose name it has.
        let is_ion = residue
            .trim_end_matches(|c: char| c.is_ascii_digit() || "+-".contains(c))
            .eq_ignore_ascii_case(letters);
        let of_charmm = IONS.iter().find(|(name, _)| name.eq_ignore_ascii_case(letters));
        if let Some((_, symbol)) = of_charmm.filter(|_| is_ion) {
            return Self::named(symbol);
        }
        let full = name.len() > 3 || bare.len() < name.len();
        match begins {
            Some(false) if !is_ion => one,
            // Names of hydrogens are long: those of four characters have no column to spare.
            _ if one == Some(Self::HYDROGEN) && !is_ion => one,
            Some(true) if !full => two.or(one),
            _ if two.is_none() => one,
            _ if one.is_none() || is_ion => two,
            _ => None,
        }
    }

    /// The element of a label of a crystal's atom: the letters it begins with, of which the second is small in symbols of two, as in
    /// `Si1`, `Ow` and `CA1`. `None` where two readings differ (`CL1`), and for T, which is a tetrahedral site of a zeolite.
    pub(crate) fn of_label(label: &str) -> Option<Self> {
        let end = label.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(label.len());
        let letters = &label[..end];
        if letters.eq_ignore_ascii_case("T") {
            return None;
        }
        let one = Self::named(letters.get(..1)?);
        match letters.get(..2) {
            None => one,
            Some(two) if two.as_bytes()[1].is_ascii_lowercase() => Self::named(two).or(one),
            Some(two) => match (Self::named(two), one) {
                (Some(_), Some(Self::HYDROGEN)) => one,
                (Some(_), Some(_)) => None,
                (two, one) => two.or(one),
            },
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
    fn masses_tell_elements() {
        for (mass, element) in [
            (1.0, "H"),
            (1.00794, "H"),
            (12.0, "C"),
            (12.0112, "C"),
            (14.0, "N"),
            (15.9994, "O"),
            (28.0855, "Si"),
            (35.453, "Cl"),
            (58.93, "Co"),
            (58.69, "Ni"),
            (65.409, "Zn"),
            (238.03, "U"),
            // Hydrocarbons, water, kilograms per mole, and no number.
            (13.019, "-"),
            (14.027, "-"),
            (15.035, "-"),
            (16.043, "-"),
            (18.015, "-"),
            (0.012, "-"),
            (0.0, "-"),
            (f64::NAN, "-"),
        ] {
            assert_eq!(Element::of_mass(mass).map_or("-", Element::symbol), element, "{mass}");
        }
    }

    #[test]
    fn labels_of_crystals_tell_elements() {
        let labels = [
            ("Si1", "Si"),
            ("O2", "O"),
            ("Zn1", "Zn"),
            ("Ow", "O"),
            ("Ca1", "Ca"),
            ("C1A", "C"),
            ("C", "C"),
            ("ZN1", "Zn"),
            ("HA", "H"),
            ("OH2", "O"),
            // Calcium, or a carbon called A; chlorine, or a carbon called L.
            ("CA1", "-"),
            ("CL1", "-"),
            ("T1", "-"),
            ("D1", "H"),
            ("1", "-"),
            ("", "-"),
        ];
        for (label, element) in labels {
            assert_eq!(Element::of_label(label).map_or("-", Element::symbol), element, "{label}");
        }
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
            // Ions whose names are not left-aligned, or are CHARMM's.
            ("NA", Some(false), "NA", "Na"),
            ("Cl-", Some(false), "Cl-", "Cl"),
            ("K", Some(false), "K", "K"),
            ("SOD", None, "SOD", "Na"),
            ("SOD", Some(false), "SOD", "Na"),
            ("POT", Some(true), "POT", "K"),
            ("CLA", Some(false), "CLA", "Cl"),
            ("CLA", Some(false), "LIG", "C"),
            // Beads of Martini.
            ("BB", None, "ALA", "-"),
            ("O5'", Some(false), "DA", "O"),
            ("H5''", Some(true), "DA", "H"),
            ("", Some(false), "LIG", "-"),
            ("1", Some(true), "LIG", "-"),
        ] {
            assert_eq!(of(name, begins, residue), element, "{name} {begins:?} {residue}");
        }
    }
}
