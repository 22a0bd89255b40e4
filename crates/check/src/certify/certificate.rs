use serde::Serialize;

use super::structure::MAX_CELLS;
use crate::exact::Exact;

/// What a complex is found to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// What the definition makes, ties decided by the rule.
    Exact,
    /// Right, with another choice where the definition leaves one: between points on one empty sphere, or
    /// with equal places and weights. Each sphere is empty, and a whole triangulation fills its hull.
    Valid,
    /// Neither.
    Wrong,
}

impl Verdict {
    /// That of so many findings, of which so many are ties.
    pub(super) fn of(findings: usize, ties: usize) -> Self {
        match (findings, ties) {
            (0, _) => Self::Exact,
            (findings, ties) if findings == ties => Self::Valid,
            _ => Self::Wrong,
        }
    }
}

/// The name in lower case, as in JSON.
impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Exact => "exact",
            Self::Valid => "valid",
            Self::Wrong => "wrong",
        })
    }
}

/// What was judged, and what could not be.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Certificate {
    /// What follows from the findings.
    pub verdict: Verdict,
    /// How many findings there were before the visitor stopped.
    pub findings: usize,
    /// How many of these are [ties](crate::Finding::is_tie), which leave a complex valid.
    pub ties: usize,
    /// Six times the volume of all cells; zero if rows were too wrong to add up.
    pub six_volumes: Exact,
    /// What was not judged, and why.
    pub not_judged: Vec<NotJudged>,
}

impl Certificate {
    /// Whether the complex was judged as a whole triangulation, hull included.
    fn is_of_whole(&self) -> bool {
        !self.not_judged.contains(&NotJudged::HiddenAndHull)
    }
}

/// The verdict with its reason, in one line.
impl std::fmt::Display for Certificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        verdict_in_words(f, self.verdict, self.findings, self.ties, self.is_of_whole())
    }
}

/// A verdict with its reason: how many findings, of which so many are ties.
pub(super) fn verdict_in_words(
    f: &mut std::fmt::Formatter<'_>,
    verdict: Verdict,
    findings: usize,
    ties: usize,
    whole: bool,
) -> std::fmt::Result {
    let plural = |count: usize| if count == 1 { "" } else { "s" };
    match verdict {
        Verdict::Exact => write!(f, "exact: no findings"),
        Verdict::Valid => {
            let hull = if whole { ", and the hull is filled" } else { "" };
            write!(
                f,
                "valid: another choice at {ties} tie{}; every sphere is empty{hull}",
                plural(ties)
            )
        }
        Verdict::Wrong => {
            let wrong = findings - ties;
            write!(f, "wrong: {wrong} finding{}", plural(wrong))?;
            if ties > 0 {
                write!(f, ", and another choice at {ties} tie{}", plural(ties))?;
            }
            Ok(())
        }
    }
}

/// Rules that were not applied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum NotJudged {
    /// Whether a simplex of the shape is missing that nothing listed has as a face: this needs the
    /// whole triangulation.
    MissingSimplices,
    /// Whether points that are not vertices are hidden, and the hull: these need the whole
    /// triangulation.
    HiddenAndHull,
    /// Whether the duplicates are right: no list is given.
    Duplicates,
    /// Rules that rest on others which were broken, or the visitor stopped.
    AfterFindings,
}

impl std::fmt::Display for NotJudged {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::MissingSimplices => {
                "whether whole parts of the shape are missing (needs the exterior simplices)"
            }
            Self::HiddenAndHull => {
                "hidden points and the convex hull (need the exterior simplices)"
            }
            Self::Duplicates => "the list of duplicates (none is given)",
            Self::AfterFindings => "rules that rest on the broken ones",
        })
    }
}

/// Why a claim cannot be judged at all.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CertifyError {
    /// Positions and weights do not pair up.
    #[error("{positions} positions but {weights} weights: each point needs one weight")]
    Lengths {
        /// Positions given.
        positions: usize,
        /// Weights given.
        weights: usize,
    },
    /// A coordinate or weight is NaN or infinite.
    #[error("point {0} has a coordinate or weight that is not finite")]
    NotFinite(usize),
    /// On a torus: a point that is not in the box, or of which no exact copies can be made.
    #[error("point {0} is not in the periodic box, or so fine that its copies would be rounded")]
    NotInBox(usize),
    /// More simplices or points than 32-bit numbers.
    #[error("{0} cells or points are too many to check: at most {max} fit", max = MAX_CELLS)]
    TooMany(usize),
    /// Memory for the links between simplices cannot be had.
    #[error("the check of {cells} cells needs {bytes} bytes of memory, which cannot be had")]
    Memory {
        /// Cells of the complex.
        cells: usize,
        /// Bytes for it and its faces.
        bytes: usize,
    },
}

impl CertifyError {
    /// What to do about it, where there is something.
    pub fn advice(&self) -> Option<&'static str> {
        Some(match self {
            Self::NotFinite(_) => "clean the input",
            Self::NotInBox(_) => "give coordinates from 0 to less than the sides of the box",
            Self::Memory { .. } => "judge a part of it",
            _ => return None,
        })
    }
}
