//! Comparison of two filtrations over the same points.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt::{self, Display};

use serde::Serialize;
use walpha_base::advice::{Advice, Advise, wrapped};
use walpha_base::monitor::Units;
use walpha_base::{Cancelled, Monitor};

use super::complexes::{PRINTED, rows};
use super::points::{CommonPositions, WeightDifference};
use crate::Alpha;
use crate::certify::Simplex;
use crate::schema::{Below, FiltrationFile, SchemaError};

/// The differences between two filtrations A and B.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FiltrationComparison {
    /// Common positions at which the weights differ; of several points at one position the heaviest counts.
    pub weights: Vec<WeightDifference>,
    /// Points of A at positions where B has none, by A's indices.
    pub points_only_a: Vec<u32>,
    /// Points of B at positions where A has none, by B's indices.
    pub points_only_b: Vec<u32>,
    /// Number of simplices that both have with equal values.
    pub equal: usize,
    /// Simplices that only A has, by A's indices.
    pub only_a: Vec<Simplex>,
    /// Simplices that only B has, by B's indices.
    pub only_b: Vec<Simplex>,
    /// Simplices of both with different values.
    pub values: Vec<ValueDifference>,
    /// The largest difference of values, as a share of the larger.
    pub largest_share: f64,
    /// Simplices that are Gabriel in one and not in the other; empty unless both say which are.
    pub gabriel: Vec<Simplex>,
    /// Simplices that become regular or interior at different α; empty unless both say when.
    pub intervals: Vec<Simplex>,
    /// The first simplex, by A's indices, that has another rank in the order; `None` if there is none, if the simplices are not
    /// the same, or if points are numbered differently.
    pub order: Option<Simplex>,
    /// Whether the order was compared.
    pub order_compared: bool,
}

/// A simplex whose value differs.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ValueDifference {
    /// The simplex, by A's indices.
    pub simplex: Simplex,
    /// Its value in A and in B.
    pub values: [Alpha; 2],
}

/// The data of a simplex in a file.
#[derive(Clone, Copy)]
struct Listing {
    value: Alpha,
    gabriel: Option<bool>,
    interval: Option<[Alpha; 2]>,
    number: u32,
}

/// Why two filtrations cannot be compared.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CompareFiltrationsError {
    /// Fields contradict each other, or a coordinate or weight is not finite.
    #[error(transparent)]
    Schema(#[from] SchemaError),
    /// The points of one repeat, and those of the other do not, or otherwise.
    #[error(
        "the points of A and of B repeat in different periodic boxes, or those of one do not repeat"
    )]
    Boxes,
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Advise for CompareFiltrationsError {
    fn advice(&self) -> Option<Advice> {
        match self {
            Self::Boxes => Some("compare filtrations of points in one box".into()),
            other => other.wrapped()?.advice(),
        }
    }

    wrapped!(Schema, Cancelled);
}

/// Compares two filtrations, matching points by their positions, so that the two may number them
/// differently. In a periodic box, simplices that are copies of each other are the same. Values are compared as doubles. Cost
/// O(n log n).
///
/// # Errors
/// Different periodic boxes, fields of different lengths, point numbers out of range, coordinates or weights that are not finite.
pub fn compare_filtrations(
    a: &FiltrationFile,
    b: &FiltrationFile,
) -> Result<FiltrationComparison, CompareFiltrationsError> {
    let monitor = &*Monitor::current();
    a.check()?;
    b.check()?;
    finite(a)?;
    finite(b)?;
    if a.periodic != b.periodic {
        return Err(CompareFiltrationsError::Boxes);
    }
    let common = CommonPositions::new(&a.points, &b.points);
    let work = monitor.units(2 * a.order.len() as u64 + b.order.len() as u64);
    let of_a = simplices(a, &corners(a, &common.a), &work)?;
    let mut of_b = simplices(b, &corners(b, &common.b), &work)?;
    let mut found = FiltrationComparison {
        weights: common.weight_differences(&weights(a), &weights(b)),
        points_only_a: common.only_a(),
        points_only_b: common.only_b(),
        equal: 0,
        only_a: Vec::new(),
        only_b: Vec::new(),
        values: Vec::new(),
        largest_share: 0.0,
        gabriel: Vec::new(),
        intervals: Vec::new(),
        order: None,
        order_compared: false,
    };
    let mut same = BTreeMap::new();
    for (key, (simplex, here)) in of_a {
        work.add(1)?;
        let Some((_, there)) = of_b.remove(&key) else {
            found.only_a.push(simplex);
            continue;
        };
        found.compare(&simplex, here, there);
        same.insert(here.number, (there.number, simplex));
    }
    found.only_b = of_b.into_values().map(|(simplex, _)| simplex).collect();
    found.order_compared =
        common.a == common.b && found.only_a.is_empty() && found.only_b.is_empty();
    if found.order_compared {
        let differs = |(x, y): &(&u32, &u32)| same.get(x).is_none_or(|(number, _)| number != *y);
        let first = a.order.iter().zip(&b.order).find(differs);
        found.order = first.and_then(|(x, _)| Some(same.get(x)?.1.clone()));
    }
    Ok(found)
}

impl FiltrationComparison {
    fn compare(&mut self, simplex: &Simplex, a: Listing, b: Listing) {
        if a.value == b.value {
            self.equal += 1;
        } else {
            let [x, y] = [a.value, b.value].map(Alpha::squared);
            // The difference may be beyond all doubles; the share is not.
            let share = (x - y).abs() / x.abs().max(y.abs());
            self.largest_share = self.largest_share.max(share).min(2.0);
            let values = [a.value, b.value];
            self.values.push(ValueDifference { simplex: simplex.clone(), values });
        }
        if a.gabriel.zip(b.gabriel).is_some_and(|(a, b)| a != b) {
            self.gabriel.push(simplex.clone());
        }
        if a.interval.zip(b.interval).is_some_and(|(a, b)| a != b) {
            self.intervals.push(simplex.clone());
        }
    }

    /// Whether none of the compared properties differs.
    pub fn is_equal(&self) -> bool {
        let lists = [&self.only_a, &self.only_b, &self.gabriel, &self.intervals];
        lists.iter().all(|list| list.is_empty())
            && self.weights.is_empty()
            && self.points_only_a.is_empty()
            && self.points_only_b.is_empty()
            && self.values.is_empty()
            && self.order.is_none()
    }
}

fn finite(file: &FiltrationFile) -> Result<(), SchemaError> {
    let numbers = file.points.as_flattened().iter().chain(file.weights.iter().flatten());
    match numbers.copied().find(|number| !number.is_finite()) {
        Some(number) => Err(SchemaError::Value {
            name: "points",
            value: number.to_string(),
            expected: "finite number",
        }),
        None => Ok(()),
    }
}

/// The weights of the points; all are 0 if the file lists none.
fn weights(file: &FiltrationFile) -> Cow<'_, [f64]> {
    match &file.weights {
        Some(weights) => Cow::Borrowed(weights),
        None => Cow::Owned(vec![0.0; file.points.len()]),
    }
}

/// The common number of a point, and the vectors of the box by which a copy of it is moved, as often as stated.
type Corner = [i64; 4];

/// What the vertices of rows stand for: points, and after them the copies that rows name.
fn corners(file: &FiltrationFile, positions: &[u32]) -> Vec<Corner> {
    let copies = file
        .copies
        .iter()
        .flatten()
        .map(|&[v, a, b, c]| [i64::from(positions[v as usize]), a.into(), b.into(), c.into()]);
    positions.iter().map(|&of| [i64::from(of), 0, 0, 0]).chain(copies).collect()
}

/// The corners of a simplex, ascending. Of its copies in a periodic box, one of which each vertex is itself a point, the least stands for all.
fn key(simplex: &[Corner]) -> Vec<Corner> {
    let moved = |[_, a, b, c]: Corner| {
        let mut moved: Vec<Corner> =
            simplex.iter().map(|[v, x, y, z]| [*v, x - a, y - b, z - c]).collect();
        moved.sort_unstable();
        moved
    };
    simplex.iter().copied().map(moved).min().unwrap_or_default()
}

/// All simplices by the positions of their vertices.
fn simplices(
    file: &FiltrationFile,
    corners: &[Corner],
    work: &Units,
) -> Result<BTreeMap<Vec<Corner>, (Simplex, Listing)>, Cancelled> {
    let mut found = BTreeMap::new();
    let mut number = 0;
    let vertices: Vec<[u32; 1]> = file.vertices.iter().map(|&v| [v]).collect();
    let values = &file.values;
    fn add<const N: usize>(
        found: &mut BTreeMap<Vec<Corner>, (Simplex, Listing)>,
        corners: &[Corner],
        rows: &[[u32; N]],
        number: &mut u32,
        data: impl Fn(usize) -> (Alpha, Option<bool>, Option<[Alpha; 2]>),
        work: &Units,
    ) -> Result<(), Cancelled> {
        for (i, row) in rows.iter().enumerate() {
            work.add(1)?;
            let key = key(&row.map(|v| corners[v as usize]));
            let (value, gabriel, interval) = data(i);
            found.insert(
                key,
                ((*row).into(), Listing { value, gabriel, interval, number: *number }),
            );
            *number += 1;
        }
        Ok(())
    }
    let below = |dimension: usize, i: usize| {
        let gabriel = file.gabriel.as_ref().map(|gabriel| of(gabriel, dimension)[i]);
        let bounds = file.regular.as_ref().zip(file.interior.as_ref());
        let interval = bounds
            .map(|(regular, interior)| [regular, interior].map(|bound| of(bound, dimension)[i]));
        (gabriel, interval)
    };
    add(
        &mut found,
        corners,
        &vertices,
        &mut number,
        |i| {
            let (gabriel, interval) = below(0, i);
            (values.vertices[i], gabriel, interval)
        },
        work,
    )?;
    add(
        &mut found,
        corners,
        &file.edges,
        &mut number,
        |i| {
            let (gabriel, interval) = below(1, i);
            (values.edges[i], gabriel, interval)
        },
        work,
    )?;
    add(
        &mut found,
        corners,
        &file.facets,
        &mut number,
        |i| {
            let (gabriel, interval) = below(2, i);
            (values.facets[i], gabriel, interval)
        },
        work,
    )?;
    add(&mut found, corners, &file.cells, &mut number, |i| (values.cells[i], None, None), work)?;
    Ok(found)
}

fn of<T>(below: &Below<T>, dimension: usize) -> &[T] {
    match dimension {
        0 => &below.vertices,
        1 => &below.edges,
        _ => &below.facets,
    }
}

impl Display for FiltrationComparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (only_a, only_b) = (&self.points_only_a, &self.points_only_b);
        writeln!(f, "points: {} only in A, {} only in B", only_a.len(), only_b.len())?;
        writeln!(f, "weights: {} differ", self.weights.len())?;
        writeln!(
            f,
            "simplices: {} with equal values, {} with different values, {} only in A, {} only in B",
            self.equal,
            self.values.len(),
            self.only_a.len(),
            self.only_b.len()
        )?;
        for ValueDifference { simplex, values: [a, b] } in self.values.iter().take(PRINTED) {
            let [a, b] = [a, b].map(|alpha| alpha.squared());
            writeln!(f, "  {simplex}: {a:?} in A, {b:?} in B")?;
        }
        if !self.values.is_empty() {
            writeln!(f, "  the largest difference is {:e} of the value", self.largest_share)?;
        }
        let kinds = [
            ("only in A", &self.only_a),
            ("only in B", &self.only_b),
            ("Gabriel in one", &self.gabriel),
            ("regular or interior from different α on", &self.intervals),
        ];
        for (what, simplices) in kinds {
            rows(f, what, simplices.iter())?;
        }
        match (&self.order, self.order_compared) {
            (Some(simplex), _) => write!(f, "order: different from {simplex} on"),
            (None, true) => write!(f, "order: the same"),
            (None, false) => write!(
                f,
                "not compared: the order (points or simplices are not the same, or numbered differently)"
            ),
        }
    }
}
