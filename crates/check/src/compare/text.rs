//! A comparison as text.

use std::fmt::{self, Display};

use super::{Comparison, WeightDifference};

/// The most differences of a kind that are listed.
pub(super) const PRINTED: usize = 10;

impl Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (only_a, only_b) = (&self.points_only_a, &self.points_only_b);
        if only_a.is_empty() && only_b.is_empty() {
            writeln!(f, "points: at the same positions")?;
        }
        rows(f, "points only in A", only_a.iter())?;
        rows(f, "points only in B", only_b.iter())?;
        if self.weights.is_empty() {
            writeln!(f, "weights: equal where both have a point")?;
        }
        let weight =
            |w: &WeightDifference| format!("point {}: {} in A, {} in B", w.point, w.a, w.b);
        rows(f, "weights that differ", self.weights.iter().map(weight))?;
        match self.alpha {
            [a, b] if a == b => writeln!(f, "α: {a} in both")?,
            [a, b] => writeln!(f, "α: {a} in A, {b} in B")?,
        }
        let names = ["vertices", "edges", "facets", "cells"];
        for (name, d) in names.into_iter().zip(&self.dimensions) {
            writeln!(
                f,
                "{name}: {} equal, {} only in A, {} only in B, {} of different class",
                d.equal,
                d.only_a.len(),
                d.only_b.len(),
                d.classes.len()
            )?;
            for (which, only) in [("A", &d.only_a), ("B", &d.only_b)] {
                for (simplex, class) in only.iter().take(PRINTED) {
                    writeln!(f, "  only in {which}: {simplex} {class:?}")?;
                }
            }
            for c in d.classes.iter().take(PRINTED) {
                writeln!(f, "  {}: A {:?}, B {:?}", c.simplex, c.a, c.b)?;
            }
        }
        writeln!(f, "{}", self.domain)?;
        let exterior = if self.exterior {
            ""
        } else {
            "exterior simplices (only one or neither lists them), "
        };
        write!(f, "not compared: {exterior}windings, lists of hidden points and duplicates")
    }
}

/// Writes the number of rows and the first of them; nothing if there are none.
pub(super) fn rows<T: Display>(
    f: &mut fmt::Formatter<'_>,
    what: &str,
    rows: impl ExactSizeIterator<Item = T>,
) -> fmt::Result {
    let count = rows.len();
    if count == 0 {
        return Ok(());
    }
    writeln!(f, "{what}: {count}")?;
    for row in rows.take(PRINTED) {
        writeln!(f, "  {row}")?;
    }
    Ok(())
}
