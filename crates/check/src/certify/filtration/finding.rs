use std::fmt;

use serde::Serialize;

use crate::Alpha;
use crate::certify::finding::{Finding, Simplex};
use crate::certify::message::apart;
use crate::exact::Exact;

/// An error of a filtration: the rule that is broken, the simplex that breaks it, and the exact
/// number that shows it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "rule", rename_all = "snake_case")]
#[non_exhaustive]
pub enum FiltrationFinding {
    /// A simplex does not enter, or become regular or interior, at the α in the file.
    When {
        /// The simplex.
        simplex: Simplex,
        /// Which of the three values is wrong.
        bound: Bound,
        /// The given value.
        given: Alpha,
        /// The double nearest to the exact number; ∞ for never.
        expected: Alpha,
        /// The exact number; `None` for never.
        exact: Option<Exact>,
    },
    /// A simplex is Gabriel, or attached, but the file states the opposite.
    Gabriel {
        /// The simplex.
        simplex: Simplex,
        /// Whether it is Gabriel.
        expected: bool,
    },
    /// The order names a simplex a second time, or one that does not exist.
    Number {
        /// The number.
        number: u32,
        /// Number of simplices.
        simplices: usize,
    },
    /// The order leaves a simplex out.
    Absent {
        /// Its number.
        number: u32,
    },
    /// A simplex precedes another that must come first: the order is by value, then dimension, then
    /// vertices.
    Order {
        /// The simplex that precedes in the file.
        before: Simplex,
        /// The simplex right after it.
        after: Simplex,
        /// Their values.
        values: [Exact; 2],
    },
    /// A pair is listed that is not a persistence pair, or is listed twice; or a persistence pair is missing.
    Pair {
        /// 0 for components, 1 for loops, 2 for voids.
        dimension: usize,
        /// Numbers of simplices: the one that creates it, and the one that ends it.
        pair: [u32; 2],
        /// Whether it is listed.
        listed: bool,
    },
    /// The listed essential components, which never end, are wrong.
    Lasting {
        /// Numbers of vertices, as given.
        given: Vec<u32>,
        /// The right ones.
        expected: Vec<u32>,
    },
    /// The simplices are not the regular triangulation.
    #[serde(untagged)]
    Triangulation(Finding),
}

impl FiltrationFinding {
    /// Whether this is not an error but [another choice](Finding::is_tie) where the definition leaves one.
    pub fn is_tie(&self) -> bool {
        matches!(self, Self::Triangulation(finding) if finding.is_tie())
    }
}

/// A change of a simplex at an α.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Bound {
    /// It enters the shape.
    Value,
    /// It becomes a face of another simplex of the shape.
    Regular,
    /// Off the boundary.
    Interior,
}

impl fmt::Display for FiltrationFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Triangulation(finding) => finding.fmt(f),
            Self::When { simplex, bound, given, expected, exact } => {
                let what = match bound {
                    Bound::Value => "enters",
                    Bound::Regular => "becomes regular",
                    Bound::Interior => "becomes interior",
                };
                let [expected, given] = [expected, given].map(|alpha| alpha.squared());
                write!(f, "{simplex} {what} at {expected:?}, not {given:?}")?;
                match exact {
                    Some(exact) if f.alternate() => write!(f, " (exactly {exact:#})"),
                    Some(_) => Ok(()),
                    None => write!(f, " (never)"),
                }
            }
            Self::Gabriel { simplex, expected: true } => {
                write!(f, "{simplex} is Gabriel: no point is inside its sphere")
            }
            Self::Gabriel { simplex, expected: false } => {
                write!(f, "{simplex} is not Gabriel: a point is inside its sphere")
            }
            Self::Number { number, simplices } => write!(
                f,
                "the order names {number} a second time, or there is no such simplex: there are {simplices}"
            ),
            Self::Absent { number } => write!(f, "the order leaves simplex {number} out"),
            Self::Pair { dimension, pair: [from, to], listed: true } => {
                write!(
                    f,
                    "simplices {from} and {to} are not a persistence pair of dimension {dimension}"
                )
            }
            Self::Pair { dimension, pair: [from, to], listed: false } => write!(
                f,
                "the persistence pair of dimension {dimension} of simplices {from} and {to} is missing"
            ),
            Self::Lasting { given, expected } => {
                write!(
                    f,
                    "the components that never end begin with vertices {expected:?}, not {given:?}"
                )
            }
            Self::Order { before, after, values: [a, b] } => {
                let [a, b] = apart([a, b], f);
                write!(
                    f,
                    "{before} must come after {after}: by value ({a}, {b}), then dimension, then vertices"
                )
            }
        }
    }
}

/// Findings for given doubles that differ from the expected ones: for the i-th simplex the double, and the exact number.
pub(super) fn differences<'a, const N: usize>(
    bound: Bound,
    rows: &[[u32; N]],
    given: &[Alpha],
    expected: impl Fn(usize) -> (Alpha, Option<&'a Exact>),
) -> Vec<FiltrationFinding> {
    let judge = |(i, (row, &given)): (usize, (&[u32; N], &Alpha))| {
        let (expected, exact) = expected(i);
        (expected != given).then(|| FiltrationFinding::When {
            simplex: (*row).into(),
            bound,
            given,
            expected,
            exact: exact.cloned(),
        })
    };
    rows.iter().zip(given).enumerate().filter_map(judge).collect()
}

/// Findings for simplices of which the file states wrongly whether they are Gabriel.
pub(super) fn gabriel<const N: usize>(
    rows: &[[u32; N]],
    given: &[bool],
    expected: impl Fn(usize) -> bool,
) -> Vec<FiltrationFinding> {
    let wrong =
        rows.iter().zip(given).enumerate().filter(|(i, (_, given))| **given != expected(*i));
    wrong
        .map(|(i, (row, _))| FiltrationFinding::Gabriel {
            simplex: (*row).into(),
            expected: expected(i),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use dashu_int::IBig;

    use super::*;

    /// Equal numbers are rounded like any others; different ones that round alike are fractions.
    #[test]
    fn numbers_in_the_wrong_order() {
        let text = |numerators: [u32; 2], denominator: u32| {
            let values = numerators
                .map(|numerator| Exact::new(IBig::from(numerator), IBig::from(denominator), 0));
            let (before, after) = ([1, 2].into(), [0].into());
            FiltrationFinding::Order { before, after, values }.to_string()
        };
        assert!(text([1, 1], 3).contains("by value (≈0.333333, ≈0.333333)"), "{}", text([1, 1], 3));
        let alike = text([10_000_001, 10_000_000], 30_000_001);
        assert!(alike.contains("by value (10000001/30000001, 10000000/30000001)"), "{alike}");
    }
}
