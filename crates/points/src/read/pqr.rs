//! PQR: atoms with a charge and a radius each, in words (Dolinsky et al. 2004, doi:10.1093/nar/gkh381).

use std::path::Path;

use super::text::text;
use super::{COLUMNS, Points, PointsError, format};
use crate::molecule::{Atom, AtomSelection, Element, Found};
use crate::{ModelMetadata, PointOptions};
use walpha_volume::{OpenFile, Reason};

/// What to do about a line that is wrong.
const NEXT: &str = "write it with blanks between all fields, as pdb2pqr --whitespace does";

/// Reads atoms with their radii: all of them, as a program has made the file for what it is used for; of several models, which are
/// numbered in order, the first unless others are asked for.
///
/// A line has blanks between its fields: ATOM or HETATM, a number, the names of atom and residue, the chain, if there is one, the
/// number of the residue, x, y, z, charge and radius. Where a chain stands right before the number of its residue, as in `A1000`, it
/// is told from it by its letter.
///
/// # Errors
/// A line has other fields, or text in place of a number; there are no atoms.
pub(crate) fn read(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let text = text(file)?;
    let mut found = Found::default();
    let mut model = 1;
    for (number, line) in (1..).zip(text.split_inclusive('\n')) {
        let line = line.trim_start_matches([' ', '\t']);
        if line.split_whitespace().next() == Some("MODEL") {
            model = found.last().map_or(1, |last| last.model + 1);
        }
        let Some((hetero, line)) = fields(line) else { continue };
        atom(path, number, line, (hetero, model), &mut found)?;
    }
    if found.last().is_none() {
        return Err(format(path, Reason::other("has no record ATOM or HETATM")));
    }
    let AtomSelection { chains, models, .. } = options.atoms.clone();
    let selection = AtomSelection::ALL.chains(chains).models(models);
    found.select(path, &selection, options)
}

/// Whether a line has an atom of a record HETATM, and what follows the name of its record.
fn fields(line: &str) -> Option<(bool, &str)> {
    [(true, "HETATM"), (false, "ATOM")].into_iter().find_map(|(hetero, record)| {
        let rest = line.strip_prefix(record)?;
        rest.starts_with(|c: char| c.is_whitespace() || c.is_ascii_digit())
            .then_some((hetero, rest))
    })
}

fn atom(
    path: &Path,
    number: u64,
    line: &str,
    (hetero, model): (bool, u32),
    found: &mut Found,
) -> Result<(), PointsError> {
    let wrong = |what: &str| format(path, Reason::content(format!("line {number} {what}"), NEXT));
    let words: Vec<&str> = line.split_whitespace().collect();
    let (chain, of_residue, numbers) = match words[..] {
        [_, _, _, chain, of_residue, x, y, z, charge, radius] => {
            (Some(chain), of_residue, [x, y, z, charge, radius])
        }
        [_, _, _, of_residue, x, y, z, charge, radius] => {
            (None, of_residue, [x, y, z, charge, radius])
        }
        _ if words.len() < 9 && !line.ends_with('\n') => {
            let what = format!("ends inside line {number}: it is truncated");
            return Err(format(path, Reason::truncated(what)));
        }
        _ => {
            let what = format!(
                "has {} fields behind the name of its record, not 9, or 10 with a chain",
                words.len()
            );
            return Err(wrong(&what));
        }
    };
    let names = [COLUMNS[0], COLUMNS[1], COLUMNS[2], "charge", "radius"];
    let mut values = [0.0; 5];
    for ((value, name), text) in values.iter_mut().zip(names).zip(numbers) {
        let parsed = text.parse().ok().filter(|number: &f64| number.is_finite());
        *value = parsed
            .ok_or_else(|| wrong(&format!("has {text:?} as {name}, which is not a number")))?;
    }
    let [x, y, z, charge, radius] = values;
    let (chain, of_residue) = match chain {
        Some(chain) => (chain, of_residue),
        None => of_residue.split_at(
            of_residue.chars().next().filter(|c| c.is_alphabetic()).map_or(0, char::len_utf8),
        ),
    };
    let insertion = of_residue.chars().next_back().filter(|c| c.is_alphabetic());
    let digits = &of_residue[..of_residue.len() - insertion.map_or(0, char::len_utf8)];
    let Ok(of_residue) = digits.parse() else {
        return Err(wrong(&format!("has {of_residue:?} as the number of a residue")));
    };
    let atom = Atom {
        name: found.name(words[1]),
        element: Element::of_name(words[1], None, words[2]),
        residue: found.name(words[2]),
        number: Some(of_residue),
        insertion,
        chain: found.name(chain),
        model,
        hetero,
        charge: Some(charge),
        ..Atom::default()
    };
    found.radii.get_or_insert_default().push(radius);
    Ok(found.push([x, y, z], atom)?)
}
