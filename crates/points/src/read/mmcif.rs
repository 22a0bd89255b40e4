//! mmCIF, the archive's format of molecules: the category `atom_site` of PDBx/mmCIF (Bourne et al. 1997,
//! doi:10.1016/S0076-6879(97)77032-0).

use std::path::Path;

use super::cell::UnitCell;
use super::cif::{Token, Words, number, without_charge};
use super::text::text;
use super::{COLUMNS, Points, PointsError, crystal, format};
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
    if crystal::is_one(&text) {
        return crystal::read(path, &text, options);
    }
    let mut reader = Reader {
        path,
        words: Words::new(path, &text),
        found: Found::default(),
        single: Vec::new(),
        groups: Vec::new(),
        has_block: false,
    };
    let cell = reader.all()?;
    reader.found.cell = cell;
    if reader.found.last().is_none() {
        let reason = if reader.has_block {
            Reason::content("has no atoms (_atom_site)", "name a file of coordinates")
        } else {
            Reason::other("has no data_ block, with which CIF begins")
        };
        return Err(format(path, reason));
    }
    reader.found.select(path, &options.atoms, options)
}

struct Reader<'a> {
    path: &'a Path,
    words: Words<'a>,
    found: Found,
    /// Items of atoms outside of a loop: those of a single atom.
    single: Vec<(&'a str, Token<'a>)>,
    /// The names and numbers of the space group.
    groups: Vec<&'a str>,
    has_block: bool,
}

impl<'a> Reader<'a> {
    /// Reads all atoms; returns the cell in which they repeat.
    fn all(&mut self) -> Result<Option<crate::Cell>, PointsError> {
        let mut cell = [None; CELL.len()];
        // Another block than that of the atoms states another cell.
        let mut of_atoms_block = None;
        let mut ahead = self.words.next()?;
        while let Some(token) = ahead {
            ahead = match token {
                Token::Loop => self.looped()?,
                Token::Tag(tag) => {
                    let value = self.words.value_of(tag)?;
                    if of_atoms(tag).is_some() {
                        self.single.push((tag, value));
                    }
                    let is = |known: &&str| known.eq_ignore_ascii_case(tag);
                    if let Some(at) = CELL.iter().position(is) {
                        cell[at] = value.value();
                    } else if crystal::is_group(tag) {
                        self.groups.extend(value.value());
                    }
                    self.words.next()?
                }
                Token::Block => {
                    self.has_block = true;
                    self.finish_single()?;
                    let stated = (std::mem::take(&mut cell), std::mem::take(&mut self.groups));
                    if of_atoms_block.is_none() && self.found.last().is_some() {
                        of_atoms_block = Some(stated);
                    }
                    self.words.next()?
                }
                Token::Frame => self.words.next()?,
                Token::Value(text, _) => return Err(self.words.without_tag(text)),
            };
        }
        self.finish_single()?;
        let (cell, groups) = of_atoms_block.unwrap_or((cell, std::mem::take(&mut self.groups)));
        let numbers = cell.map(|text| text.and_then(number));
        let [Some(a), Some(b), Some(c), Some(alpha), Some(beta), Some(gamma)] = numbers else {
            return Ok(None);
        };
        let group = groups.iter().find(|group| !crystal::is_p1(group));
        let group = group.copied().unwrap_or_default().to_owned();
        let cell = UnitCell { lengths: [a, b, c], angles: [alpha, beta, gamma], group };
        Ok(cell.repeating())
    }

    /// Reads the tags and rows of a loop; returns the token behind it.
    fn looped(&mut self) -> Result<Option<Token<'a>>, PointsError> {
        let (tags, mut ahead) = self.words.tags()?;
        let columns = match of_atoms(tags[0]) {
            Some(_) => {
                self.begin_atoms()?;
                Some(Columns::of(&tags).map_err(|what| self.words.wrong_here(&what))?)
            }
            None => None,
        };
        let groups: Vec<usize> =
            (0..tags.len()).filter(|&at| crystal::is_group(tags[at])).collect();
        let mut row = Vec::new();
        while self.words.row(&tags, &mut row, &mut ahead)? {
            if let Some(columns) = &columns {
                self.atom(columns, &row)?;
            }
            self.groups.extend(groups.iter().filter_map(|&column| row[column].value()));
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
        let columns = Columns::of(&tags).map_err(|what| self.words.wrong_here(&what))?;
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
                self.words
                    .wrong_here(&format!("has {text:?} as {}, which is not a number", COLUMNS[k]))
            })?;
        }
        let character = |text: Option<&str>, what: &str| {
            let mut characters = text.unwrap_or_default().chars();
            match (characters.next(), characters.next()) {
                (first, None) => Ok(first),
                _ => Err(self.words.wrong_here(&format!("has {what} of more than one character"))),
            }
        };
        let (alternate, insertion) =
            (character(alternate, "a label_alt_id")?, character(insertion, "an insertion code")?);
        let whole = |text: Option<&str>, what: &str| match text {
            None => Ok(None),
            Some(text) => text.parse::<i32>().map(Some).map_err(|_| {
                self.words
                    .wrong_here(&format!("has {text:?} as {what}, which is not a whole number"))
            }),
        };
        let residue_number = whole(sequence, "the number of a residue")?;
        let model = match whole(model, "the number of a model")? {
            None => 1,
            Some(model) => u32::try_from(model).map_err(|_| {
                self.words.wrong_here(&format!("has a model of the number {model}"))
            })?,
        };
        let occupancy = match occupancy {
            None => None,
            Some(text) => Some(number(text).ok_or_else(|| {
                self.words.wrong_here(&format!("has {text:?} as occupancy, which is not a number"))
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
                    ", but fractions of a unit cell, which are read of CIF of crystals (_atom_site_fract_x)"
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
