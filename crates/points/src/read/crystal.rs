//! CIF of crystals: the core dictionary's fractions of a unit cell, and symmetry operations, which give all atoms of the cell (Hall,
//! Allen & Brown 1991, doi:10.1107/S010876739101067X).

use std::path::Path;

use walpha_base::advice::Setting;
use walpha_base::memory::afford;
use walpha_base::shown::shown;

use super::cif::{Token, Words, number, without_charge};
use super::symmetry::{Content, Operation};
use super::{COLUMNS, Points, PointsError, format};
use crate::molecule::{Atom, AtomSelection, Element, Found};
use crate::{Cell, ModelMetadata, PointOptions};
use walpha_volume::Reason;

/// The beginning of all tags of atoms.
const ATOMS: &str = "_atom_site";
/// The items of atoms that are read.
const ITEMS: [&str; 8] = [
    "_atom_site_fract_x",
    "_atom_site_fract_y",
    "_atom_site_fract_z",
    "_atom_site_label",
    "_atom_site_type_symbol",
    "_atom_site_occupancy",
    "_atom_site_disorder_group",
    "_atom_site_calc_flag",
];
const CELL: [&str; 6] = [
    "_cell_length_a",
    "_cell_length_b",
    "_cell_length_c",
    "_cell_angle_alpha",
    "_cell_angle_beta",
    "_cell_angle_gamma",
];
/// Tags of operations: of the newer dictionary, and of the older.
const OPERATIONS: [&str; 2] = ["_space_group_symop_operation_xyz", "_symmetry_equiv_pos_as_xyz"];
/// What tags of the space group have in common: of its names, and of its number in the International Tables. Those of magnetic and
/// modulated structures are among them.
const GROUPS: [&str; 6] =
    ["name_h-m", "name_hall", "it_number", "int_tables_number", "ssg_name", "name_bns"];
/// The most operations: those of the largest group, 192 with its centrings, in a cell of 2 × 2 × 2.
const MOST_OPERATIONS: usize = 8 * 192;

/// Whether the tags of atoms are those of the core dictionary, without a category: decided by the first.
pub(super) fn is_one(text: &str) -> bool {
    let mut words = Words::new(Path::new(""), text);
    // What is wrong with it, its reader says.
    while let Ok(Some(token)) = words.next() {
        if let Token::Tag(tag) = token
            && tag.get(..ATOMS.len()).is_some_and(|own| own.eq_ignore_ascii_case(ATOMS))
        {
            return !tag.contains('.');
        }
    }
    false
}

/// A tag in small letters, with the point of the newer dictionaries as an underscore.
fn plain(tag: &str) -> String {
    tag.to_ascii_lowercase().replace('.', "_")
}

/// Whether a tag is one of the space group.
pub(super) fn is_group(tag: &str) -> bool {
    let tag = plain(tag);
    (tag.starts_with("_space_group") || tag.starts_with("_symmetry") || tag.starts_with("_parent"))
        && GROUPS.iter().any(|part| tag.contains(part))
}

/// Whether a space group, by a name or number, has no symmetries but translations.
pub(super) fn is_p1(group: &str) -> bool {
    let bare: String = group.chars().filter(|c| !" _'\"".contains(*c)).collect();
    bare.eq_ignore_ascii_case("P1") || bare == "1"
}

/// What a tag lists.
#[derive(Clone, Copy, PartialEq)]
enum Listed {
    /// Symmetry operations.
    Operations,
    /// Those of a magnetic or modulated structure, which are not read.
    OtherOperations,
    Nothing,
}

impl Listed {
    fn of(tag: &str) -> Self {
        let tag = plain(tag);
        let is_other = || {
            tag.starts_with("_space_group_symop")
                && ["operation", "centering"].iter().any(|part| tag.contains(part))
        };
        if OPERATIONS.contains(&&*tag) {
            Self::Operations
        } else if is_other() {
            Self::OtherOperations
        } else {
            Self::Nothing
        }
    }
}

/// Reads all atoms of a cell: those that are listed, and their images by the operations that are listed, moved into the cell. Of
/// several blocks the first that has atoms is read.
///
/// # Errors
/// The text is not CIF, or ends too early; there is no cell, or no atom; a number or an operation is wrong; a space group is stated
/// without its operations; atoms are to be chosen.
pub(super) fn read(
    path: &Path,
    text: &str,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    refuse_choices(path, &options.atoms)?;
    let mut reader = Reader { path, words: Words::new(path, text), found: Found::default() };
    let block = reader.all()?;
    let mut found = reader.found;
    block.fill(path, &mut found)?;
    found.select(path, &AtomSelection::ALL, options)
}

/// Refuses settings that choose atoms.
fn refuse_choices(path: &Path, atoms: &AtomSelection) -> Result<(), PointsError> {
    for (setting, given) in [
        (Setting::Hydrogens, atoms.hydrogens),
        (Setting::Waters, atoms.waters),
        (Setting::Hetero, atoms.hetero),
        (Setting::Chains, atoms.chains.is_some()),
        (Setting::Models, atoms.models.is_some()),
    ] {
        if given {
            let what = "is CIF of a crystal, of which all atoms are read";
            return Err(format(path, Reason::needless(setting, what)));
        }
    }
    Ok(())
}

/// An atom that is listed.
struct Site {
    /// Its place in fractions of the cell.
    place: [f64; 3],
    atom: Atom,
}

/// What a block states.
#[derive(Default)]
struct Block<'a> {
    cell: [Option<f64>; CELL.len()],
    groups: Vec<&'a str>,
    operations: Vec<Operation>,
    /// A tag of operations that are not read.
    other_operations: Option<&'a str>,
    sites: Vec<Site>,
    has_atoms: bool,
    /// The numbers of sites without coordinates, of dummies, of those in disorder.
    without_place: usize,
    dummies: usize,
    disordered: usize,
}

struct Reader<'a> {
    path: &'a Path,
    words: Words<'a>,
    found: Found,
}

impl<'a> Reader<'a> {
    /// Reads all blocks, and returns the first with atoms.
    fn all(&mut self) -> Result<Block<'a>, PointsError> {
        let mut first: Option<Block<'a>> = None;
        let mut several = 0;
        let mut block = Block::default();
        let mut single = Vec::new();
        let mut ahead = self.words.next()?;
        loop {
            ahead = match ahead {
                Some(Token::Loop) => self.looped(&mut block)?,
                Some(Token::Tag(tag)) => {
                    let value = self.words.value_of(tag)?;
                    if item(tag).is_some() {
                        single.push((tag, value));
                    } else {
                        self.single(&mut block, tag, value)?;
                    }
                    self.words.next()?
                }
                Some(Token::Block) | None => {
                    let (tags, row): (Vec<&str>, Vec<Token<'_>>) =
                        std::mem::take(&mut single).into_iter().unzip();
                    if let Some(columns) = self.columns(&tags)? {
                        block.has_atoms = true;
                        self.site(&mut block, columns, &row)?;
                    }
                    let done = std::mem::take(&mut block);
                    several += usize::from(done.has_atoms);
                    if done.has_atoms && first.is_none() {
                        first = Some(done);
                    }
                    if ahead.is_none() {
                        break;
                    }
                    self.words.next()?
                }
                Some(Token::Frame) => self.words.next()?,
                Some(Token::Value(text, _)) => return Err(self.words.without_tag(text)),
            };
        }
        if several > 1 {
            tracing::warn!(
                "{}: {several} of its blocks have atoms: the first of these is read",
                shown(self.path)
            );
        }
        first.ok_or_else(|| {
            let what =
                "is CIF of small molecules without fractions of a unit cell (_atom_site_fract_x)";
            let next = "write these, or convert it to mmCIF, PDB or extended XYZ";
            format(self.path, Reason::unsupported(what, next))
        })
    }

    /// Takes a value that is not in a loop.
    fn single(
        &self,
        block: &mut Block<'a>,
        tag: &'a str,
        value: Token<'a>,
    ) -> Result<(), PointsError> {
        let at = |tags: &[&str]| tags.iter().position(|known| known.eq_ignore_ascii_case(tag));
        let Some(text) = value.value() else { return Ok(()) };
        if let Some(at) = at(&CELL) {
            let value = number(text).ok_or_else(|| {
                self.words.wrong_here(&format!("has {text:?} as {tag}, which is not a number"))
            })?;
            block.cell[at] = Some(value);
        } else if is_group(tag) {
            block.groups.push(text);
        } else {
            match Listed::of(tag) {
                Listed::Operations => self.operation(block, text)?,
                Listed::OtherOperations => block.other_operations = Some(tag),
                Listed::Nothing => {}
            }
        }
        Ok(())
    }

    /// Reads the tags and rows of a loop; returns the word behind it.
    fn looped(&mut self, block: &mut Block<'a>) -> Result<Option<Token<'a>>, PointsError> {
        let (tags, mut ahead) = self.words.tags()?;
        let columns = self.columns(&tags)?;
        // Both tags in one loop name the same operations.
        let listed = |what| tags.iter().position(|tag| Listed::of(tag) == what);
        let operation = listed(Listed::Operations);
        let groups: Vec<usize> = (0..tags.len()).filter(|&at| is_group(tags[at])).collect();
        if let Some(other) = listed(Listed::OtherOperations) {
            block.other_operations = Some(tags[other]);
        }
        if columns.is_some() && std::mem::replace(&mut block.has_atoms, true) {
            return Err(self.words.wrong_here("comes behind a second loop of atoms in one block"));
        }
        let mut row = Vec::new();
        while self.words.row(&tags, &mut row, &mut ahead)? {
            if let Some(columns) = columns {
                self.site(block, columns, &row)?;
            } else if let Some(text) = operation.and_then(|column| row[column].value()) {
                self.operation(block, text)?;
            }
            block.groups.extend(groups.iter().filter_map(|&column| row[column].value()));
        }
        Ok(ahead)
    }

    fn operation(&self, block: &mut Block<'a>, text: &str) -> Result<(), PointsError> {
        let Some(operation) = Operation::read(text) else {
            let text: String = text.chars().take(60).collect();
            let what = format!(
                "has {text:?} as a symmetry operation, which is not three sums of x, y, z and numbers, as in '-y,x-y,z+1/3'"
            );
            return Err(self.words.wrong_here(&what));
        };
        if !block.operations.contains(&operation) {
            block.operations.push(operation);
        }
        if block.operations.len() > MOST_OPERATIONS {
            let what = format!("has more than {MOST_OPERATIONS} symmetry operations");
            return Err(self.words.wrong_here(&what));
        }
        Ok(())
    }

    /// The place of each item among tags; `None` if they are not those of atoms with fractions.
    fn columns(&self, tags: &[&str]) -> Result<Option<Columns>, PointsError> {
        let mut columns = [None; ITEMS.len()];
        for (column, tag) in tags.iter().enumerate() {
            if let Some(item) = item(tag)
                && columns[item].replace(column).is_some()
            {
                return Err(self.words.wrong_here(&format!("comes behind {tag} twice")));
            }
        }
        if columns[..3] == [None; 3] {
            return Ok(None);
        }
        match columns[..3].iter().position(Option::is_none) {
            Some(k) => {
                let what = format!("comes behind tags of atoms without {}", ITEMS[k]);
                Err(self.words.wrong_here(&what))
            }
            None => Ok(Some(columns)),
        }
    }

    /// Reads a row of atoms.
    fn site(
        &mut self,
        block: &mut Block<'a>,
        columns: Columns,
        row: &[Token<'a>],
    ) -> Result<(), PointsError> {
        let [x, y, z, label, symbol, occupancy, disorder, flag] =
            columns.map(|column| row[column?].value());
        let number = |text: &str, what: &str| {
            number(text).ok_or_else(|| {
                self.words.wrong_here(&format!("has {text:?} as {what}, which is not a number"))
            })
        };
        let occupancy = occupancy.map(|text| number(text, "occupancy")).transpose()?;
        let mut place = [0.0; 3];
        for (k, text) in [x, y, z].into_iter().enumerate() {
            let Some(text) = text else {
                block.without_place += 1;
                return Ok(());
            };
            place[k] = number(text, COLUMNS[k])?;
        }
        if flag.is_some_and(|flag| flag.eq_ignore_ascii_case("dum")) {
            block.dummies += 1;
            return Ok(());
        }
        let is_partial = occupancy.is_some_and(|share| share < 1.0);
        // The dictionary's 0 is no group.
        let is_in_group = disorder.is_some_and(|group| group != "0");
        block.disordered += usize::from(is_partial || is_in_group);
        let label = label.or(symbol).unwrap_or_default();
        let element = match symbol {
            Some(symbol) => Element::named(without_charge(symbol)),
            None => Element::of_label(label),
        };
        let name = self.found.name(label);
        let atom = Atom { name, element, model: 1, occupancy, ..Atom::default() };
        block.sites.push(Site { place, atom });
        Ok(())
    }
}

/// The place of each item among the tags of a loop.
type Columns = [Option<usize>; ITEMS.len()];

/// The item of a tag.
fn item(tag: &str) -> Option<usize> {
    ITEMS.iter().position(|known| known.eq_ignore_ascii_case(tag))
}

impl Block<'_> {
    /// Makes the atoms of the cell.
    fn fill(self, path: &Path, found: &mut Found) -> Result<(), PointsError> {
        let cell = self.cell(path)?;
        self.check_group(path)?;
        self.tell(path);
        if self.sites.is_empty() {
            let what = "has no atom with coordinates";
            return Err(format(path, Reason::content(what, "name another file")));
        }
        // Few sites are on symmetry elements, so that most have as many images as there are operations.
        let most = self.sites.len() * self.operations.len().max(1);
        let bytes = size_of::<Atom>() + size_of::<([f64; 3], usize)>() + size_of::<[f64; 3]>();
        afford(most.saturating_mul(bytes), || "the atoms of a cell".into())?;
        let mut content = Content::new(&cell);
        for (index, site) in self.sites.iter().enumerate() {
            content.add(index, site.place, &self.operations)?;
        }
        for (place, site) in content.atoms {
            found.push(cell.place(place), self.sites[site].atom.clone())?;
        }
        found.cell = Some(cell);
        Ok(())
    }

    fn cell(&self, path: &Path) -> Result<Cell, PointsError> {
        let wrong = |what: String| format(path, Reason::content(what, "correct its unit cell"));
        let [lengths, angles] = [&self.cell[..3], &self.cell[3..]];
        if let Some(k) = lengths.iter().position(Option::is_none) {
            let what = format!("has fractions of a unit cell without its {}", CELL[k]);
            return Err(wrong(what));
        }
        let lengths = [0, 1, 2].map(|k| lengths[k].unwrap_or_default());
        // The dictionary has this default.
        let angles = [0, 1, 2].map(|k| angles[k].unwrap_or(90.0));
        let cell = Cell::of_angles(lengths, angles);
        cell.filter(|_| lengths.iter().all(|&length| length > 0.0)).ok_or_else(|| {
            wrong(format!("has a unit cell of lengths {lengths:?} and angles {angles:?}, which no three vectors have"))
        })
    }

    /// Refuses a space group with symmetries whose operations are not listed.
    fn check_group(&self, path: &Path) -> Result<(), PointsError> {
        let next = "list them, or write all atoms of the cell in P 1, as `ase convert` does";
        let group = self.groups.iter().find(|group| !is_p1(group));
        if self.operations.is_empty() {
            if let Some(tag) = self.other_operations {
                let what = format!(
                    "lists symmetry operations of a magnetic or modulated structure ({tag}), which are not read, and no others ({})",
                    OPERATIONS[0]
                );
                return Err(format(path, Reason::unsupported(what, next)));
            }
            if let Some(group) = group {
                let what = format!(
                    "states the space group {group:?}, and does not list its symmetry operations ({})",
                    OPERATIONS[0]
                );
                return Err(format(path, Reason::unsupported(what, next)));
            }
            if self.groups.is_empty() {
                tracing::warn!(
                    "{}: it states neither a space group nor symmetry operations: the atoms are taken for all of the cell",
                    shown(path)
                );
            }
        }
        let Some(group) = group else { return Ok(()) };
        if self.operations == [Operation::IDENTITY] {
            tracing::warn!(
                "{}: its space group is {group:?}, and it lists x,y,z as the only operation: the atoms are taken for all of the cell",
                shown(path)
            );
        }
        Ok(())
    }

    /// Says what is left out, and what is in several places.
    fn tell(&self, path: &Path) {
        let sites = |n: usize| if n == 1 { "1 site".to_owned() } else { format!("{n} sites") };
        if self.without_place > 0 {
            let n = sites(self.without_place);
            tracing::warn!("{}: {n} without coordinates are left out", shown(path));
        }
        if self.dummies > 0 {
            tracing::warn!("{}: {} of dummies are left out", shown(path), sites(self.dummies));
        }
        if self.disordered > 0 {
            tracing::warn!(
                "{}: {} of {} are occupied in part, or in a group of disorder: all are taken",
                shown(path),
                self.disordered,
                sites(self.sites.len())
            );
        }
    }
}
