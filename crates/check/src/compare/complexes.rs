//! Comparison of two complexes.

use std::collections::BTreeMap;
use std::fmt::{self, Display};

use serde::Serialize;
use walpha_base::advice::{Advice, Advise, wrapped};
use walpha_base::monitor::Units;
use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::sorted;

use super::domain::{self, Domain};
use super::points::{CommonPositions, WeightDifference};
use crate::certify::Simplex;
use crate::{Alpha, Class, Complex, Placed, Simplices};

/// The differences between two complexes A and B.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Comparison {
    /// α of A and of B.
    pub alpha: [Alpha; 2],
    /// Common positions at which the weights differ. Of several points at one position the heaviest counts, which is the one that
    /// is kept.
    pub weights: Vec<WeightDifference>,
    /// Points of A at positions where B has none, by A's indices.
    pub points_only_a: Vec<u32>,
    /// Points of B at positions where A has none, by B's indices.
    pub points_only_b: Vec<u32>,
    /// Whether exterior simplices were compared, which requires that both complexes list some.
    pub exterior: bool,
    /// Vertices, edges, facets and cells.
    pub dimensions: [Differences; 4],
    /// The relation between the regions that the cells cover.
    pub domain: Domain,
}

/// Differences among the simplices of one dimension.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Differences {
    /// Number of simplices that both have with the same class.
    pub equal: usize,
    /// Simplices that only A has, by A's indices, and their classes.
    pub only_a: Vec<(Simplex, Class)>,
    /// Simplices that only B has, by B's indices, and their classes.
    pub only_b: Vec<(Simplex, Class)>,
    /// Simplices that both have with different classes.
    pub classes: Vec<ClassDifference>,
}

/// A simplex whose class differs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct ClassDifference {
    /// The simplex, by A's indices.
    pub simplex: Simplex,
    /// Its class in A.
    pub a: Class,
    /// Its class in B.
    pub b: Class,
}

/// Why two complexes cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// The numbers of positions and weights differ.
    #[error("complex {which} has {positions} points but {weights} weights: each needs one")]
    Lengths {
        /// `A` or `B`.
        which: char,
        /// Points given.
        positions: usize,
        /// Weights given.
        weights: usize,
    },
    /// A coordinate or weight is NaN or infinite.
    #[error("point {point} of complex {which} has a coordinate or weight that is not finite")]
    NotFinite {
        /// `A` or `B`.
        which: char,
        /// The point.
        point: usize,
    },
    /// A row names a point that does not exist.
    #[error("{simplex} of complex {which} names a point that does not exist")]
    Index {
        /// `A` or `B`.
        which: char,
        /// The simplex.
        simplex: Simplex,
    },
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Advise for CompareError {
    wrapped!(Cancelled);

    fn advice(&self) -> Option<Advice> {
        let advice = "remove such points from the input";
        matches!(self, Self::NotFinite { .. }).then(|| advice.into())
    }
}

/// Compares two complexes with their weights and α, matching points by their positions, so that the two may number them
/// differently.
///
/// Windings and lists of hidden points and duplicates do not count. Cost O(n log n).
///
/// # Errors
/// [`CompareError`].
pub fn compare(a: Placed, b: Placed) -> Result<Comparison, CompareError> {
    let monitor = &*Monitor::current();
    check('A', a)?;
    check('B', b)?;
    let common = CommonPositions::new(a.positions, b.positions);
    let exterior = a.complex.lists_exterior() && b.complex.lists_exterior();
    let (of_a, of_b) = (a.complex, b.complex);
    let rows = |complex: &Complex| {
        let Complex { cells, facets, edges, vertices } = complex;
        (cells.len() + facets.len() + edges.len() + vertices.len()) as u64
    };
    let listing = monitor.part(0, 6, 10);
    let listed = listing.units(rows(of_a) + rows(of_b));
    let dimensions = [
        differences(&of_a.vertices, &of_b.vertices, &common, exterior, &listed)?,
        differences(&of_a.edges, &of_b.edges, &common, exterior, &listed)?,
        differences(&of_a.facets, &of_b.facets, &common, exterior, &listed)?,
        differences(&of_a.cells, &of_b.cells, &common, exterior, &listed)?,
    ];
    let domain = domain::compare(a, b, &common, &monitor.part(6, 9, 10))?;
    monitor.part(9, 10, 10).report(1, 1)?;
    Ok(Comparison {
        alpha: [a.alpha, b.alpha],
        weights: common.weight_differences(a.weights, b.weights),
        points_only_a: common.only_a(),
        points_only_b: common.only_b(),
        exterior,
        dimensions,
        domain,
    })
}

impl Comparison {
    /// Whether the points, their weights, α and all compared simplices with their classes are the same.
    pub fn is_equal(&self) -> bool {
        let same =
            |d: &Differences| d.only_a.is_empty() && d.only_b.is_empty() && d.classes.is_empty();
        self.alpha[0] == self.alpha[1]
            && self.weights.is_empty()
            && self.points_only_a.is_empty()
            && self.points_only_b.is_empty()
            && self.dimensions.iter().all(same)
    }
}

fn check(
    which: char,
    Placed { positions, weights, complex, .. }: Placed,
) -> Result<(), CompareError> {
    if positions.len() != weights.len() {
        let (positions, weights) = (positions.len(), weights.len());
        return Err(CompareError::Lengths { which, positions, weights });
    }
    let finite = |(p, w): (&[f64; 3], &f64)| p.iter().chain([w]).all(|x| x.is_finite());
    if let Some(point) = positions.iter().zip(weights).position(|point| !finite(point)) {
        return Err(CompareError::NotFinite { which, point });
    }
    let n = positions.len();
    let bad = bad_row(&complex.cells, n)
        .or_else(|| bad_row(&complex.facets, n))
        .or_else(|| bad_row(&complex.edges, n))
        .or_else(|| bad_row(&complex.vertices, n));
    bad.map_or(Ok(()), |simplex| Err(CompareError::Index { which, simplex }))
}

fn bad_row<const N: usize>(simplices: &Simplices<N>, points: usize) -> Option<Simplex> {
    let bad = |row: &&[u32; N]| row.iter().any(|&v| v as usize >= points);
    simplices.rows().iter().find(bad).map(|row| (*row).into())
}

fn differences<const N: usize>(
    a: &Simplices<N>,
    b: &Simplices<N>,
    common: &CommonPositions,
    exterior: bool,
    work: &Units,
) -> Result<Differences, Cancelled> {
    let listed = |simplices: &Simplices<N>, position_of: &[u32]| {
        let rows = simplices.iter().filter(|(_, class)| exterior || *class != Class::Exterior);
        let keyed = rows.map(|(row, class)| {
            work.add(1)?;
            Ok((sorted(row.map(|v| position_of[v as usize])), (*row, class)))
        });
        keyed.collect::<Result<BTreeMap<[u32; N], _>, Cancelled>>()
    };
    let a = listed(a, &common.a)?;
    let mut b = listed(b, &common.b)?;
    let mut differences = Differences::default();
    for (key, (row, class)) in a {
        match b.remove(&key) {
            None => differences.only_a.push((row.into(), class)),
            Some((_, other)) if other == class => differences.equal += 1,
            Some((_, other)) => {
                let simplex = row.into();
                differences.classes.push(ClassDifference { simplex, a: class, b: other });
            }
        }
    }
    let rest = b.into_values();
    differences.only_b = rest.map(|(row, class)| (Simplex::from(row), class)).collect();
    Ok(differences)
}

/// The maximum number of listed differences of a kind.
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

/// Writes the number of rows and the first of them, or nothing if there are none.
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
