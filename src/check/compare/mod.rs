//! Comparison of two complexes over the same points.

mod domain;

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;

use super::Simplex;
use super::canonical::sorted;
use crate::shape::{Class, Complex, Simplices};

pub use domain::Domain;

/// A complex with the places of its points.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// x, y, z of each point, all finite.
    pub positions: &'a [[f64; 3]],
    /// A complex by indices into them.
    pub complex: &'a Complex,
}

/// What two complexes A and B have in common, and what not.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Comparison {
    /// Points of A at places where B has none, by A's indices.
    pub points_only_a: Vec<u32>,
    /// Points of B at places where A has none, by B's indices.
    pub points_only_b: Vec<u32>,
    /// Whether exterior simplices were compared: only if both complexes list some.
    pub exterior: bool,
    /// Vertices, edges, facets and cells.
    pub dimensions: [Differences; 4],
    /// What the cells of the two shapes cover.
    pub domain: Domain,
}

/// Differences among the simplices of one dimension.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Differences {
    /// How many simplices are in both with the same class.
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
pub enum NotComparable {
    /// A coordinate is NaN or infinite.
    #[error(
        "point {point} of complex {which} has a coordinate that is not finite; clean the input"
    )]
    NotFinite {
        /// `A` or `B`.
        which: char,
        /// The point.
        point: usize,
    },
    /// A vertex is no point.
    #[error("{simplex} of complex {which} names a point that does not exist")]
    Index {
        /// `A` or `B`.
        which: char,
        /// The simplex.
        simplex: Simplex,
    },
}

/// Compares two complexes, matching points by their places, so that the two may number them
/// differently.
///
/// Windings do not count. Cost O(n log n).
///
/// # Errors
/// [`NotComparable`].
pub fn compare(a: Placed, b: Placed) -> Result<Comparison, NotComparable> {
    sane('A', a)?;
    sane('B', b)?;
    let places = Places::new(a.positions, b.positions);
    let exterior = lists_exterior(a.complex) && lists_exterior(b.complex);
    let (of_a, of_b) = (a.complex, b.complex);
    let dimensions = [
        differences(&of_a.vertices, &of_b.vertices, &places, exterior),
        differences(&of_a.edges, &of_b.edges, &places, exterior),
        differences(&of_a.facets, &of_b.facets, &places, exterior),
        differences(&of_a.cells, &of_b.cells, &places, exterior),
    ];
    let only = |own: &[u32], other: &[u32]| {
        let other: std::collections::BTreeSet<_> = other.iter().collect();
        (0..).zip(own).filter(|(_, place)| !other.contains(place)).map(|(i, _)| i).collect()
    };
    Ok(Comparison {
        points_only_a: only(&places.a, &places.b),
        points_only_b: only(&places.b, &places.a),
        exterior,
        dimensions,
        domain: domain::compare(a, b, &places),
    })
}

impl Comparison {
    /// Whether the points and all compared simplices with their classes are the same.
    pub fn is_equal(&self) -> bool {
        let same =
            |d: &Differences| d.only_a.is_empty() && d.only_b.is_empty() && d.classes.is_empty();
        self.points_only_a.is_empty()
            && self.points_only_b.is_empty()
            && self.dimensions.iter().all(same)
    }
}

/// Numbers for places, common to both complexes.
struct Places {
    positions: Vec<[f64; 3]>,
    /// The place of each point of A.
    a: Vec<u32>,
    b: Vec<u32>,
}

impl Places {
    fn new(a: &[[f64; 3]], b: &[[f64; 3]]) -> Self {
        let by_place =
            |p: &[f64; 3], q: &[f64; 3]| p.partial_cmp(q).expect("coordinates are finite");
        let mut positions = [a, b].concat();
        positions.sort_unstable_by(by_place);
        positions.dedup();
        let number = |p: &[f64; 3]| {
            positions.binary_search_by(|q| by_place(q, p)).expect("every place has a number") as u32
        };
        let (a, b) = (a.iter().map(number).collect(), b.iter().map(number).collect());
        Self { positions, a, b }
    }
}

fn sane(which: char, Placed { positions, complex }: Placed) -> Result<(), NotComparable> {
    if let Some(point) = positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(NotComparable::NotFinite { which, point });
    }
    let n = positions.len();
    let bad = bad_row(&complex.cells, n)
        .or_else(|| bad_row(&complex.facets, n))
        .or_else(|| bad_row(&complex.edges, n))
        .or_else(|| bad_row(&complex.vertices, n));
    bad.map_or(Ok(()), |simplex| Err(NotComparable::Index { which, simplex }))
}

fn bad_row<const N: usize>(simplices: &Simplices<N>, points: usize) -> Option<Simplex> {
    let bad = |row: &&[u32; N]| row.iter().any(|&v| v as usize >= points);
    simplices.vertices.iter().find(bad).map(|row| (*row).into())
}

fn lists_exterior(complex: &Complex) -> bool {
    complex.cells.classes.contains(&Class::Exterior)
        || complex.facets.classes.contains(&Class::Exterior)
        || complex.edges.classes.contains(&Class::Exterior)
        || complex.vertices.classes.contains(&Class::Exterior)
}

fn differences<const N: usize>(
    a: &Simplices<N>,
    b: &Simplices<N>,
    places: &Places,
    exterior: bool,
) -> Differences {
    let listed = |simplices: &Simplices<N>, places: &[u32]| -> BTreeMap<[u32; N], _> {
        let rows = simplices.iter().filter(|(_, class)| exterior || *class != Class::Exterior);
        rows.map(|(row, class)| (sorted(row.map(|v| places[v as usize])), (*row, class))).collect()
    };
    let a = listed(a, &places.a);
    let mut b = listed(b, &places.b);
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
    differences
}

/// How many differences of a kind are printed one by one.
const PRINTED: usize = 10;

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let points = [("A", &self.points_only_a), ("B", &self.points_only_b)];
        for (name, points) in points.into_iter().filter(|(_, points)| !points.is_empty()) {
            writeln!(f, "{} points are only in {name}", points.len())?;
        }
        if !self.exterior {
            writeln!(f, "exterior simplices are not compared: not both complexes list them")?;
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
            for (which, rows) in [("A", &d.only_a), ("B", &d.only_b)] {
                for (simplex, class) in rows.iter().take(PRINTED) {
                    writeln!(f, "  only in {which}: {simplex}, {}", super::class_name(*class))?;
                }
            }
            for difference in d.classes.iter().take(PRINTED) {
                let (a, b) = (super::class_name(difference.a), super::class_name(difference.b));
                writeln!(f, "  {}: {a} in A, {b} in B", difference.simplex)?;
            }
        }
        write!(f, "{}", self.domain)
    }
}
