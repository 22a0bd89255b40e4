//! What the formats of simulations have in common: the box, units, and atoms that may have types in place of elements (LAMMPS
//! documentation, "Triclinic simulation boxes", "units").

use std::path::Path;

use super::{Points, PointsError, format};
use crate::molecule::{Atom, Element, Found};
use crate::{Cell, ModelMetadata, PointOptions};
use walpha_base::shown::shown;
use walpha_volume::Reason;

/// What to do about a line that is wrong.
const NEXT: &str = "correct it, or write the file anew";

/// The units of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Units {
    /// As many ångströms are the unit of length; `None` for that of the potential (`lj`).
    pub length: Option<f64>,
    /// Whether masses are grams per mole.
    pub molar: bool,
}

/// Warns where masses of a file without units are taken for those of elements, and are more likely those of a potential: small whole numbers.
pub(super) fn warn_of_masses(path: &Path, masses: impl IntoIterator<Item = f64>) {
    let mut masses = masses.into_iter().peekable();
    if masses.peek().is_some() && masses.all(|mass| mass.fract() == 0.0 && mass < 5.0) {
        tracing::warn!(
            "{}: it does not state its units, and its masses are small whole numbers: they are taken for those of elements, as 1 for \
             H. If they are those of a potential, `radii` none leaves out the radii",
            shown(path)
        );
    }
}

impl Units {
    /// Those of a name.
    pub(super) fn named(name: &str) -> Option<Self> {
        let (length, molar) = match name {
            "real" | "metal" => (Some(1.0), true),
            // A bohr (CODATA 2018).
            "electron" => (Some(0.529_177_210_903), true),
            "nano" => (Some(10.0), false),
            "micro" => (Some(1e4), false),
            "cgs" => (Some(1e8), false),
            "si" => (Some(1e10), false),
            "lj" => (None, false),
            _ => return None,
        };
        Some(Self { length, molar })
    }
}

/// A box, of which a corner is `origin`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    pub origin: [f64; 3],
    pub cell: Cell,
}

impl Bounds {
    /// The box from the least to the largest coordinates, tilted: `xy`, `xz` and `yz`. `None` if a side is not positive.
    pub(super) fn of(low: [f64; 3], high: [f64; 3], [xy, xz, yz]: [f64; 3]) -> Option<Self> {
        let [x, y, z] = [0, 1, 2].map(|k| high[k] - low[k]);
        let vectors = [[x, 0.0, 0.0], [xy, y, 0.0], [xz, yz, z]];
        let bounds = Self { origin: low, cell: Cell { vectors, repeats: [true; 3] } };
        bounds.checked().filter(|_| [x, y, z].iter().all(|&side| side > 0.0))
    }

    /// The tilted box that spans these coordinates, as dumps have them.
    pub(super) fn spanning(low: [f64; 3], high: [f64; 3], tilt: [f64; 3]) -> Option<Self> {
        let [xy, xz, yz] = tilt;
        let of_x = [0.0, xy, xz, xy + xz];
        let least = |of: &[f64]| of.iter().copied().fold(f64::INFINITY, f64::min);
        let most = |of: &[f64]| of.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let low = [low[0] - least(&of_x), low[1] - least(&[0.0, yz]), low[2]];
        let high = [high[0] - most(&of_x), high[1] - most(&[0.0, yz]), high[2]];
        Self::of(low, high, tilt)
    }

    /// The box, if its vectors are finite and span a volume.
    pub(super) fn checked(self) -> Option<Self> {
        let [a, b, c] = self.cell.vectors;
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        let volume = a[0] * minor(1, 2) - a[1] * minor(0, 2) + a[2] * minor(0, 1);
        let numbers = self.cell.vectors.as_flattened().iter().chain(&self.origin);
        (volume != 0.0 && volume.is_finite() && numbers.copied().all(f64::is_finite))
            .then_some(self)
    }

    /// A place by its parts of the vectors.
    pub(super) fn place(&self, parts: [f64; 3]) -> [f64; 3] {
        let way = self.cell.place(parts);
        [0, 1, 2].map(|k| self.origin[k] + way[k])
    }
}

/// An atom of a row.
pub(super) struct Row<'a> {
    /// Its type, or its element where the file states it.
    pub name: &'a str,
    pub element: Option<Element>,
    pub position: [f64; 3],
    pub charge: Option<f64>,
    /// In the unit of length.
    pub radius: Option<f64>,
}

/// The atoms of rows, in ångströms where the unit of length is known, or there are elements.
pub(super) fn atoms(
    path: &Path,
    rows: Vec<Row<'_>>,
    units: Option<Units>,
    cell: Option<Cell>,
    options: &PointOptions,
) -> Result<(Points, ModelMetadata), PointsError> {
    let is_known = match units {
        Some(units) => units.length.is_some(),
        None => rows.iter().any(|row| row.element.is_some()),
    };
    let scale = units.and_then(|units| units.length).unwrap_or(1.0);
    let scaled = |place: [f64; 3]| place.map(|x| scale * x);
    let mut found = Found::default();
    found.is_unitless = !is_known;
    found.cell = cell.map(|cell| Cell { vectors: cell.vectors.map(scaled), ..cell });
    if rows.iter().all(|row| row.radius.is_some()) {
        found.radii = Some(rows.iter().map(|row| scale * row.radius.unwrap_or_default()).collect());
    }
    for row in rows {
        let name = found.name(row.name);
        let Row { element, charge, position, .. } = row;
        let atom = Atom { name, element, charge, model: 1, ..Atom::default() };
        found.push(scaled(position), atom)?;
    }
    found.all(path, options)
}

/// A finite number.
pub(super) fn number(path: &Path, line: u64, text: &str, what: &str) -> Result<f64, PointsError> {
    text.parse()
        .ok()
        .filter(|x: &f64| x.is_finite())
        .ok_or_else(|| wrong(path, line, &format!("has {text:?} as {what}, which is not a number")))
}

/// The error for what is in a line.
pub(super) fn wrong(path: &Path, line: u64, what: &str) -> PointsError {
    format(path, Reason::content(format!("line {line} {what}"), NEXT))
}

/// The error for a number of rows that differs from the number that is claimed.
pub(super) fn miscount(path: &Path, claimed: u64, found: u64) -> PointsError {
    let what = format!("claims {claimed} atoms, but has {found}");
    format(
        path,
        if found < claimed {
            Reason::claims_more(format!("{what}: it is truncated, or the count is wrong"))
        } else {
            Reason::content(what, "correct the count")
        },
    )
}
