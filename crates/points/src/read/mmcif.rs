//! mmCIF, the archive's format of molecules: the category `atom_site` of PDBx/mmCIF (Bourne et al. 1997,
//! doi:10.1016/S0076-6879(97)77032-0).

use std::path::Path;

use super::cell::UnitCell;
use super::cif::{SyntaxError, Token, Tokens};
use super::text::text;
use super::{COLUMNS, Points, PointsError, format};
use crate::molecule::{Atom, Element, Found};
use crate::{ModelMetadata, PointOptions};
use walpha_volume::{OpenFile, Reason};

/// The category of atoms.
const ATOMS: &str = "_atom_site.";
/// The items that are read, without their category; of several in a row the first that is there.
const ITEMS: [&[&str]; COUNT] = [
    &["cartn_x"],
    &["cartn_y"],
    &["cartn_z"],
    &["group_pdb"],
    &["type_symbol"],
    &["label_atom_id", "auth_atom_id"],
    &["label_alt_id"],
    &["label_comp_id", "auth_comp_id"],
    &["auth_asym_id", "label_asym_id"],
    &["auth_seq_id", "label_seq_id"],
    &["pdbx_pdb_ins_code"],
    &["pdbx_pdb_model_num"],
    &["occupancy"],
];
const COUNT: usize = 13;
/// Tags of the unit cell and the space group.
const CELL: [&str; 6] = [
    "_cell.length_a",
    "_cell.length_b",
    "_cell.length_c",
    "_cell.angle_alpha",
    "_cell.angle_beta",
    "_cell.angle_gamma",
];
const GROUPS: [&str; 2] = ["_symmetry.space_group_name_h-m", "_space_group.name_h-m_alt"];

/// Reads atoms, with the author's names of chains and numbers of residues; without those, with the archive's.
///
/// # Errors
/// The text is not CIF, or ends too early; an item is missing, or has text in place of a number; there are no atoms, or those of
/// several blocks; coordinates are fractions of a unit cell.
pub(crate) fn read(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let text = text(file)?;
    let mut reader = Reader {
        path,
        tokens: Tokens::new(&text),
        found: Found::default(),
        single: Vec::new(),
        instead: Instead::default(),
    };
    let cell = reader.all()?;
    reader.found.cell = cell;
    if reader.found.last().is_none() {
        return Err(format(path, reader.instead.reason()));
    }
    reader.found.select(path, &options.atoms, options)
}

/// What is there in place of atoms.
#[derive(Clone, Copy, Default, PartialEq, PartialOrd)]
enum Instead {
    #[default]
    Nothing,
    /// Blocks of other things.
    Blocks,
    /// Tags of atoms without a category, as in CIF of small molecules.
    Uncategorised,
    /// Places as fractions of a unit cell.
    Fractions,
}

impl Instead {
    fn of(tag: &str) -> Self {
        let begins =
            |name: &str| tag.get(..name.len()).is_some_and(|own| own.eq_ignore_ascii_case(name));
        if begins("_atom_site_fract_x") || begins("_atom_site.fract_x") {
            Self::Fractions
        } else if begins("_atom_site_") && !tag.contains('.') {
            Self::Uncategorised
        } else {
            Self::Nothing
        }
    }

    /// Why a file without atoms is not read.
    fn reason(self) -> Reason {
        const CONVERT: &str = "convert it to coordinates in ångströms: mmCIF, PDB or extended XYZ";
        match self {
            Self::Fractions => {
                let what = "states places as fractions of a unit cell (_atom_site_fract_x), as CIF of crystals does";
                Reason::unsupported(what, CONVERT)
            }
            Self::Uncategorised => {
                let what =
                    "is CIF of small molecules, whose tags have no category (_atom_site_label)";
                Reason::unsupported(what, CONVERT)
            }
            Self::Blocks => {
                Reason::content("has no atoms (_atom_site)", "name a file of coordinates")
            }
            Self::Nothing => Reason::other("has no data_ block, with which CIF begins"),
        }
    }
}

struct Reader<'a> {
    path: &'a Path,
    tokens: Tokens<'a>,
    found: Found,
    /// Items of atoms outside of a loop: those of a single atom.
    single: Vec<(&'a str, Token<'a>)>,
    instead: Instead,
}

impl<'a> Reader<'a> {
    /// Reads all atoms; returns the cell in which they repeat.
    fn all(&mut self) -> Result<Option<crate::Cell>, PointsError> {
        let mut cell = [None; CELL.len()];
        let mut group = None;
        let mut ahead = self.token()?;
        while let Some(token) = ahead {
            ahead = match token {
                Token::Loop => self.looped()?,
                Token::Tag(tag) => {
                    let value = match self.token()? {
                        Some(value @ Token::Value(..)) => value,
                        Some(_) => {
                            return Err(self.wrong_here(&format!("has no value behind {tag}")));
                        }
                        None => {
                            let what = format!("ends behind the tag {tag}: it is truncated");
                            return Err(format(self.path, Reason::truncated(what)));
                        }
                    };
                    self.note(Instead::of(tag));
                    if of_atoms(tag).is_some() {
                        self.single.push((tag, value));
                    }
                    let is = |known: &&str| known.eq_ignore_ascii_case(tag);
                    if let Some(at) = CELL.iter().position(is) {
                        cell[at] = value.value();
                    } else if GROUPS.iter().any(is) {
                        group = value.value().or(group);
                    }
                    self.token()?
                }
                Token::Block => {
                    self.note(Instead::Blocks);
                    self.finish_single()?;
                    self.token()?
                }
                Token::Frame => self.token()?,
                Token::Value(text, _) => {
                    let text: String = text.chars().take(20).collect();
                    return Err(self.wrong_here(&format!("has a value without a tag, {text:?}")));
                }
            };
        }
        self.finish_single()?;
        let numbers = cell.map(|text| text.and_then(number));
        let [Some(a), Some(b), Some(c), Some(alpha), Some(beta), Some(gamma)] = numbers else {
            return Ok(None);
        };
        let group = group.unwrap_or_default().to_owned();
        let cell = UnitCell { lengths: [a, b, c], angles: [alpha, beta, gamma], group };
        Ok(cell.repeating())
    }

    /// Reads the tags and rows of a loop; returns the token behind it.
    fn looped(&mut self) -> Result<Option<Token<'a>>, PointsError> {
        let mut tags = Vec::new();
        let mut ahead = self.token()?;
        while let Some(Token::Tag(tag)) = ahead {
            self.note(Instead::of(tag));
            tags.push(tag);
            ahead = self.token()?;
        }
        if tags.is_empty() {
            return Err(self.wrong_here("has a loop_ without tags"));
        }
        let columns = match of_atoms(tags[0]) {
            Some(_) => {
                self.begin_atoms()?;
                Some(Columns::of(&tags).map_err(|what| self.wrong_here(&what))?)
            }
            None => None,
        };
        let mut row = Vec::new();
        while let Some(value @ Token::Value(..)) = ahead {
            row.push(value);
            if row.len() == tags.len() {
                if let Some(columns) = &columns {
                    self.atom(columns, &row)?;
                }
                row.clear();
            }
            ahead = self.token()?;
        }
        if !row.is_empty() {
            let what = format!(
                "{} of {} values in the last row of the loop of {}",
                row.len(),
                tags.len(),
                tags[0]
            );
            return Err(match ahead {
                None => format(
                    self.path,
                    Reason::truncated(format!("ends behind {what}: it is truncated")),
                ),
                Some(_) => self.wrong_here(&format!("comes behind {what}")),
            });
        }
        Ok(ahead)
    }

    /// Reads the atom whose items are outside of a loop.
    fn finish_single(&mut self) -> Result<(), PointsError> {
        let items = std::mem::take(&mut self.single);
        if items.is_empty() {
            return Ok(());
        }
        self.begin_atoms()?;
        let (tags, row): (Vec<&str>, Vec<Token<'_>>) = items.into_iter().unzip();
        let columns = Columns::of(&tags).map_err(|what| self.wrong_here(&what))?;
        self.atom(&columns, &row)
    }

    /// Refuses atoms in a second place.
    fn begin_atoms(&self) -> Result<(), PointsError> {
        if self.found.last().is_none() {
            return Ok(());
        }
        let what = "has atoms (_atom_site) in several blocks or loops";
        Err(format(self.path, Reason::content(what, "write each block to a file of its own")))
    }

    fn atom(&mut self, columns: &Columns, row: &[Token<'a>]) -> Result<(), PointsError> {
        let [
            x,
            y,
            z,
            group,
            symbol,
            name,
            alternate,
            residue,
            chain,
            sequence,
            insertion,
            model,
            occupancy,
        ] = columns.0.map(|column| row[column?].value());
        let mut position = [0.0; 3];
        for (k, text) in [x, y, z].into_iter().enumerate() {
            position[k] = text.and_then(number).ok_or_else(|| {
                let text = text.unwrap_or("none");
                self.wrong_here(&format!("has {text:?} as {}, which is not a number", COLUMNS[k]))
            })?;
        }
        let character = |text: Option<&str>, what: &str| {
            let mut characters = text.unwrap_or_default().chars();
            match (characters.next(), characters.next()) {
                (first, None) => Ok(first),
                _ => Err(self.wrong_here(&format!("has {what} of more than one character"))),
            }
        };
        let (alternate, insertion) =
            (character(alternate, "a label_alt_id")?, character(insertion, "an insertion code")?);
        let whole = |text: Option<&str>, what: &str| match text {
            None => Ok(None),
            Some(text) => text.parse::<i32>().map(Some).map_err(|_| {
                self.wrong_here(&format!("has {text:?} as {what}, which is not a whole number"))
            }),
        };
        let residue_number = whole(sequence, "the number of a residue")?;
        let model = match whole(model, "the number of a model")? {
            None => 1,
            Some(model) => u32::try_from(model)
                .map_err(|_| self.wrong_here(&format!("has a model of the number {model}")))?,
        };
        let occupancy = match occupancy {
            None => None,
            Some(text) => Some(number(text).ok_or_else(|| {
                self.wrong_here(&format!("has {text:?} as occupancy, which is not a number"))
            })?),
        };
        let (name, residue) = (name.unwrap_or_default(), residue.unwrap_or_default());
        let atom = Atom {
            element: match symbol {
                Some(symbol) => Element::named(without_charge(symbol)),
                None => Element::of_name(name, None, residue),
            },
            name: self.found.name(name),
            residue: self.found.name(residue),
            number: residue_number,
            insertion,
            chain: self.found.name(chain.unwrap_or_default()),
            model,
            alternate,
            hetero: group.is_some_and(|group| group.eq_ignore_ascii_case("HETATM")),
            occupancy,
            charge: None,
        };
        Ok(self.found.push(position, atom)?)
    }

    fn note(&mut self, found: Instead) {
        if found > self.instead {
            self.instead = found;
        }
    }

    fn token(&mut self) -> Result<Option<Token<'a>>, PointsError> {
        self.tokens.next().map_err(|SyntaxError { what, is_cut }| {
            let reason = if is_cut {
                Reason::truncated(format!("{what}: it is truncated"))
            } else {
                Reason::value(what)
            };
            format(self.path, reason)
        })
    }

    /// The error for what is in the line of the last token.
    fn wrong_here(&self, what: &str) -> PointsError {
        format(self.path, Reason::value(format!("line {} {what}", self.tokens.line())))
    }
}

/// The place of each item among the tags of a loop.
struct Columns([Option<usize>; COUNT]);

impl Columns {
    /// # Errors
    /// What is wrong with these tags.
    fn of(tags: &[&str]) -> Result<Self, String> {
        let items: Vec<String> =
            tags.iter().map(|tag| of_atoms(tag).unwrap_or_default().to_ascii_lowercase()).collect();
        let column = |names: &[&str]| {
            names.iter().find_map(|name| items.iter().position(|item| item == name))
        };
        let columns = ITEMS.map(column);
        for (k, names) in ITEMS.iter().enumerate() {
            if let Some(twice) =
                names.iter().find(|name| items.iter().filter(|item| item == name).count() > 1)
            {
                return Err(format!("comes behind {ATOMS}{twice} twice"));
            }
            if k < 3 && columns[k].is_none() {
                let is_fraction = items.iter().any(|item| item == "fract_x");
                let instead = if is_fraction {
                    ", but fractions of a unit cell, which are not read"
                } else {
                    ""
                };
                return Err(format!(
                    "comes behind tags of atoms without {ATOMS}Cartn_{}{instead}",
                    COLUMNS[k]
                ));
            }
        }
        Ok(Self(columns))
    }
}

/// The item of a tag of atoms.
fn of_atoms(tag: &str) -> Option<&str> {
    let (category, item) = tag.split_at_checked(ATOMS.len())?;
    category.eq_ignore_ascii_case(ATOMS).then_some(item)
}

/// A finite number, which may have its uncertainty in parentheses.
fn number(text: &str) -> Option<f64> {
    let text = match text.split_once('(') {
        Some((number, uncertainty)) => {
            let digits = uncertainty.strip_suffix(')')?;
            (!digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()))
                .then_some(number)?
        }
        None => text,
    };
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// A symbol without the charge behind it, as in `Fe3+`.
fn without_charge(symbol: &str) -> &str {
    match symbol.strip_suffix(['+', '-']) {
        Some(rest) => rest.trim_end_matches(|c: char| c.is_ascii_digit()),
        None => symbol,
    }
}
