//! POSCAR and CONTCAR: crystals of VASP (VASP wiki, "POSCAR").

use std::iter::Zip;
use std::ops::RangeFrom;
use std::path::Path;
use std::str::Lines;

use super::lammps::{Bounds, Row, atoms, number, wrong};
use super::text::text;
use super::{Points, PointsError, format};
use crate::molecule::Element;
use crate::{Cell, ModelMetadata, PointOptions};
use walpha_volume::{OpenFile, Reason};

/// Reads the atoms and their cell. Without a line of names (VASP 4) atoms have no elements. What follows them is passed by.
///
/// # Errors
/// A line has text in place of a number; there are fewer lines than atoms.
pub(crate) fn read(
    file: &OpenFile,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let path = file.path();
    let text = text(file)?;
    let mut reader = Reader { path, lines: (1..).zip(text.lines()), line: 0 };
    reader.words()?;
    let scale = reader.words()?;
    let scale =
        scale.iter().map(|word| reader.number(word, "a scale")).collect::<Result<Vec<_>, _>>()?;
    let mut vectors = [[0.0; 3]; 3];
    for vector in &mut vectors {
        *vector = reader.three("a vector")?;
    }
    let factors = factors(&scale, vectors);
    let stretched = |place: [f64; 3]| [0, 1, 2].map(|k| factors[k] * place[k]);
    let cell = Cell { vectors: vectors.map(stretched), repeats: [true; 3] };
    let bounds = Bounds { origin: [0.0; 3], cell }.checked().ok_or_else(|| {
        let next = "correct its lines 2 to 5: a scale, and the vectors of the cell";
        format(path, Reason::content("states a cell without volume", next))
    })?;
    let mut counts = reader.words()?;
    let mut names = Vec::new();
    if counts.iter().any(|word| word.parse::<u64>().is_err()) {
        names = std::mem::replace(&mut counts, reader.words()?);
    }
    let counts =
        counts.iter().map(|word| reader.count(word)).collect::<Result<Vec<u64>, PointsError>>()?;
    if counts.is_empty() || !names.is_empty() && names.len() != counts.len() {
        let what = format!("has {} numbers of atoms for {} names", counts.len(), names.len());
        return Err(reader.wrong(&what));
    }
    let begins = |words: &[&str], letters: &[char]| {
        words.first().is_some_and(|word| word.starts_with(letters))
    };
    let mut mode = reader.words()?;
    // Some coordinates are fixed, which words behind them state.
    if begins(&mode, &['s', 'S']) {
        mode = reader.words()?;
    }
    let are_places = begins(&mode, &['c', 'C', 'k', 'K']);
    let mut rows = Vec::new();
    for (kind, count) in counts.into_iter().enumerate() {
        // Names of potentials have suffixes, as in Ti_pv.
        let name = names.get(kind).and_then(|name| name.split(['_', '/']).next());
        let (name, element) = (name.unwrap_or_default(), name.and_then(Element::named));
        for _ in 0..count {
            let place = reader.three("a coordinate")?;
            let position = if are_places { stretched(place) } else { bounds.place(place) };
            rows.push(Row { name, element, position, charge: None, radius: None });
        }
    }
    if rows.is_empty() {
        return Err(reader.wrong("has no number of atoms above 0"));
    }
    atoms(path, rows, None, Some(bounds.cell), options)
}

/// The factors of x, y and z: one for all, three, or minus the volume of the cell.
fn factors(scale: &[f64], [a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    match *scale {
        [x, y, z] => [x, y, z],
        [volume, ..] if volume < 0.0 => {
            let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
            let own = a[0] * minor(1, 2) - a[1] * minor(0, 2) + a[2] * minor(0, 1);
            [(volume / own).abs().cbrt(); 3]
        }
        [factor, ..] => [factor; 3],
        [] => [1.0; 3],
    }
}

struct Reader<'a> {
    path: &'a Path,
    lines: Zip<RangeFrom<u64>, Lines<'a>>,
    /// The number of the last line.
    line: u64,
}

impl<'a> Reader<'a> {
    /// The words of the next line.
    fn words(&mut self) -> Result<Vec<&'a str>, PointsError> {
        let Some((line, text)) = self.lines.next() else {
            let what = format!("ends behind line {}: it is truncated", self.line);
            return Err(format(self.path, Reason::truncated(what)));
        };
        self.line = line;
        Ok(text.split_whitespace().take_while(|word| !word.starts_with(['!', '#'])).collect())
    }

    /// Three numbers of the next line.
    fn three(&mut self, what: &str) -> Result<[f64; 3], PointsError> {
        let words = self.words()?;
        let [x, y, z, ..] = words[..] else {
            return Err(self.wrong(&format!("has {} words, not three numbers", words.len())));
        };
        Ok([self.number(x, what)?, self.number(y, what)?, self.number(z, what)?])
    }

    fn number(&self, text: &str, what: &str) -> Result<f64, PointsError> {
        number(self.path, self.line, text, what)
    }

    fn count(&self, word: &str) -> Result<u64, PointsError> {
        word.parse().map_err(|_| self.wrong(&format!("has {word:?} as a number of atoms")))
    }

    fn wrong(&self, what: &str) -> PointsError {
        wrong(self.path, self.line, what)
    }
}
