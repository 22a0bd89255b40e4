use serde::Serialize;
use walpha_base::Cancelled;
use walpha_base::monitor::wraps;

use crate::certify::certificate::write_verdict;
use crate::certify::{Certificate, CertifyError, Verdict};
use crate::schema::SchemaError;

/// The verdict on a filtration, and what was not judged.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct FiltrationCertificate {
    /// The verdict from all findings: valid if only the triangulation departs from the rule, at ties.
    pub verdict: Verdict,
    /// Number of findings.
    pub findings: usize,
    /// The certificate of the triangulation, which is the complex at α = ∞.
    pub triangulation: Certificate,
    /// Number of distinct exact values.
    pub values: usize,
    /// What was not judged.
    pub not_judged: Vec<Unjudged>,
}

/// The verdict with its reason, in one line.
impl std::fmt::Display for FiltrationCertificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write_verdict(f, self.verdict, self.findings, self.triangulation.ties, true)
    }
}

/// Parts of a filtration that are not judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Unjudged {
    /// Values, classes and order, as the triangulation is wrong.
    AfterFindings,
    /// Which simplices are Gabriel, as the file does not say.
    Gabriel,
    /// From which α on simplices are regular and interior, as the file does not say.
    Intervals,
    /// Persistence pairs, as the file lists none.
    Pairs,
}

impl std::fmt::Display for Unjudged {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::AfterFindings => "values, classes and order (they depend on the triangulation)",
            Self::Gabriel => "which simplices are Gabriel (the file does not say)",
            Self::Intervals => {
                "from which α on simplices are regular and interior (the file does not say)"
            }
            Self::Pairs => "persistence pairs (the file lists none)",
        })
    }
}

/// Why a file cannot be judged as a filtration.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CertifyFiltrationError {
    /// Fields contradict each other.
    #[error(transparent)]
    Schema(#[from] SchemaError),
    /// The triangulation cannot be judged.
    #[error(transparent)]
    Triangulation(CertifyError),
    /// The points are those of a torus.
    #[error("filtrations of a periodic box are not judged")]
    Periodic,
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

wraps! { CertifyFiltrationError: Triangulation(CertifyError) }

impl CertifyFiltrationError {
    /// How to resolve the error, if there is a way.
    pub fn advice(&self) -> Option<&'static str> {
        match self {
            Self::Schema(error) => error.advice(),
            Self::Triangulation(error) => error.advice(),
            Self::Cancelled(_) => None,
            Self::Periodic => Some("judge its complexes at single values of α instead"),
        }
    }
}
