use serde::Serialize;
use walpha_base::Cancelled;
use walpha_base::advice::{Advice, Advise, Category, wrapped};

use super::missing::Declined;
use super::structure::MAX_CELLS;
use crate::exact::Exact;

/// The result of judging a complex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(into = "&'static str")]
pub enum Verdict {
    /// The complex of the definition, with ties decided by the rule.
    Exact,
    /// Exact as far as it was judged: it is not known whether simplices are missing; see [`NotJudged::MissingSimplices`].
    ExactAsFarAsJudged,
    /// Right, with another choice where the definition leaves one: among points on one empty sphere, or with equal positions and
    /// weights. Each sphere is empty, and a whole triangulation has no gaps.
    Valid,
    /// Valid as far as it was judged.
    ValidAsFarAsJudged,
    /// Neither exact nor valid.
    Wrong,
}

impl Verdict {
    /// The verdict for a number of findings, some of which are ties.
    pub(super) fn of(findings: usize, ties: usize) -> Self {
        match (findings, ties) {
            (0, _) => Self::Exact,
            (findings, ties) if findings == ties => Self::Valid,
            _ => Self::Wrong,
        }
    }

    /// Whether everything that the definition requires was judged; for a wrong complex, enough of it.
    pub fn is_complete(self) -> bool {
        !matches!(self, Self::ExactAsFarAsJudged | Self::ValidAsFarAsJudged)
    }
}

/// The words, as in JSON.
impl From<Verdict> for &'static str {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Exact => "exact",
            Verdict::ExactAsFarAsJudged => "exact as far as judged",
            Verdict::Valid => "valid",
            Verdict::ValidAsFarAsJudged => "valid as far as judged",
            Verdict::Wrong => "wrong",
        }
    }
}

/// The words, as in JSON.
impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad((*self).into())
    }
}

/// The verdict on a complex, and the parts that were not judged.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Certificate {
    /// The verdict that follows from the findings.
    pub verdict: Verdict,
    /// Number of findings before the visitor stopped.
    pub findings: usize,
    /// Number of those that are [ties](crate::Finding::is_tie), which leave a complex valid.
    pub ties: usize,
    /// Six times the volume of all cells; zero if rows are invalid.
    pub six_volumes: Exact,
    /// The parts that were not judged, with the reasons.
    pub not_judged: Vec<NotJudged>,
}

impl Certificate {
    /// Whether the complex was judged as a whole triangulation.
    fn is_of_whole(&self) -> bool {
        !self.not_judged.contains(&NotJudged::HiddenAndHull)
    }

    /// Concludes the verdict from the findings and from the parts that were not judged.
    pub(super) fn conclude(&mut self) {
        let is_declined = self
            .not_judged
            .iter()
            .any(|rule| matches!(rule, NotJudged::MissingSimplices(_) | NotJudged::Samples));
        self.verdict = match Verdict::of(self.findings, self.ties) {
            Verdict::Exact if is_declined => Verdict::ExactAsFarAsJudged,
            Verdict::Valid if is_declined => Verdict::ValidAsFarAsJudged,
            verdict => verdict,
        };
    }
}

/// The verdict with its reason, in one line.
impl std::fmt::Display for Certificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write_verdict(f, self.verdict, self.findings, self.ties, self.is_of_whole())
    }
}

/// Writes a verdict with its reason: the number of findings, and of ties among them.
pub(super) fn write_verdict(
    f: &mut std::fmt::Formatter<'_>,
    verdict: Verdict,
    findings: usize,
    ties: usize,
    whole: bool,
) -> std::fmt::Result {
    let plural = |count: usize| if count == 1 { "" } else { "s" };
    match verdict {
        Verdict::Exact | Verdict::ExactAsFarAsJudged => write!(f, "{verdict}: no findings"),
        Verdict::Valid | Verdict::ValidAsFarAsJudged => {
            let gaps = if whole { ", and there are no gaps" } else { "" };
            write!(
                f,
                "{verdict}: another choice at {ties} tie{}; every sphere is empty{gaps}",
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
    /// Whether simplices of the shape are missing, because the search for them was declined. Without this rule and `Samples` a shape
    /// is not exact.
    MissingSimplices(Declined),
    /// Which cells the solid inside an isosurface has: the samples of the volume decide, which are not given.
    Samples,
    /// Singular simplices below the lowest dimension that is [claimed](crate::Claim::lowest) to be listed.
    SingularSimplices,
    /// Whether points that are not vertices are hidden, and the hull: these require the whole triangulation.
    HiddenAndHull,
    /// Whether the duplicates are right, because no list is given.
    Duplicates,
    /// Rules that depend on others which were broken, or that followed when the visitor stopped.
    AfterFindings,
}

impl std::fmt::Display for NotJudged {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::MissingSimplices(Declined { pairs, most, alpha }) => {
                return write!(
                    f,
                    "whether simplices of the shape are missing: about {pairs} pairs of points are near enough for an edge, and {most} are searched; for these simplices that is so beyond α = {alpha}"
                );
            }
            Self::Samples => {
                "which cells the solid inside the isosurface has (samples of the volume decide, which the file does not hold)"
            }
            Self::SingularSimplices => {
                "singular simplices of the kinds that are not listed: of these there are faces alone"
            }
            Self::HiddenAndHull => {
                "hidden points and the convex hull (requires the exterior simplices)"
            }
            Self::Duplicates => "the list of duplicates (none is given)",
            Self::AfterFindings => "rules that depend on the broken ones",
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
    /// On a torus: a point that is not in the box, or whose copies cannot be represented exactly.
    #[error(
        "point {0} is not in the periodic box, or has so many digits that its copies would be rounded"
    )]
    NotInBox(usize),
    /// More simplices or points than 32-bit numbers.
    #[error("{0} cells or points are too many to check: at most {max} fit", max = MAX_CELLS)]
    TooMany(usize),
    /// There is not enough memory for the links between simplices.
    #[error("not enough memory: the check of {cells} cells needs {bytes} bytes")]
    Memory {
        /// Cells of the complex.
        cells: usize,
        /// Bytes needed.
        bytes: usize,
    },
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Advise for CertifyError {
    wrapped!(Cancelled);

    fn advice(&self) -> Option<Advice> {
        let advice = match self {
            Self::NotFinite(_) => "remove such points from the input",
            Self::NotInBox(_) => "move the points into the box, by multiples of its vectors",
            Self::Memory { .. } => "judge a part of it",
            _ => return None,
        };
        Some(advice.into())
    }

    fn category(&self) -> Category {
        match self {
            Self::Memory { .. } => Category::Memory,
            Self::Cancelled(error) => error.category(),
            _ => Category::Input,
        }
    }
}
