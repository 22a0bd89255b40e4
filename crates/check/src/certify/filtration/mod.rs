//! Certification of a filtration: whether each simplex exists, and enters at the α in the file.

mod finding;
mod order;
mod pairs;
mod values;

pub use finding::{Bound, FiltrationFinding};

use finding::differences;
use serde::Serialize;
use values::{ATTACHED, Ranks, RowNumbers, Span, Spans};
use walpha_base::advice::{Advice, Advise, wrapped};
use walpha_base::monitor::wraps;
use walpha_base::{Cancelled, Monitor};

use crate::Alpha;
use crate::certify::certificate::{Certificate, CertifyError, Verdict, write_verdict};
use crate::certify::structure::{self, Points, Structure};
use crate::schema::{Below, ComplexFile, FiltrationFile, PlacedComplex, SchemaError};

/// The verdict on a filtration, and the parts that were not judged.
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
    /// The parts that were not judged.
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
    /// Values, classes and order, because the triangulation is wrong.
    AfterFindings,
    /// Whether simplices are Gabriel, because the file does not tell.
    Gabriel,
    /// The α at which simplices become regular and interior, because the file does not tell.
    Intervals,
    /// Persistence pairs, because the file lists none.
    Pairs,
    /// Persistence pairs of dimension 1, because the file lists none.
    Loops,
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
            Self::Loops => "persistence pairs of dimension 1 (the file lists none)",
        })
    }
}

/// The reason why a file cannot be judged as a filtration.
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

impl Advise for CertifyFiltrationError {
    wrapped!(Schema, Triangulation, Cancelled);

    fn advice(&self) -> Option<Advice> {
        match self {
            Self::Periodic => Some("judge its complexes at single values of α instead".into()),
            _ => self.wrapped()?.advice(),
        }
    }
}

/// Judges a filtration: that its simplices are a whole regular triangulation (by the rules of
/// [`Claim::visit`](crate::Claim::visit) at α = ∞; for points that span no volume, the triangulation of their plane or line), the
/// value of each simplex, whether it is Gabriel, the α from which on it is regular and interior, the order and, if that is right,
/// the persistence pairs. Everything is judged in exact numbers; the doubles in a file must be the nearest ones.
///
/// The intervals include the class at every α: below its value a simplex is exterior, then singular, regular and interior. Faces
/// come before their cofaces if the order is right: no value is smaller than that of a face, and equal ones are ordered by
/// dimension.
///
/// Linear except for sorting, and a few microseconds for each simplex; but pairs of dimension 1 require a reduction of matrices.
///
/// # Errors
/// [`CertifyFiltrationError`]: fields of different lengths, numbers out of range; points of a torus.
pub fn certify_filtration(
    file: &FiltrationFile,
) -> Result<(Vec<FiltrationFinding>, FiltrationCertificate), CertifyFiltrationError> {
    let monitor = &*Monitor::current();
    file.check()?;
    if file.periodic.is_some() {
        return Err(CertifyFiltrationError::Periodic);
    }
    let placed = whole(file)?;
    let (found, triangulation) = monitor.part(0, 40, 100).watch(|| placed.claim().findings())?;
    let mut findings: Vec<_> = found.into_iter().map(FiltrationFinding::Triangulation).collect();
    let mut not_judged = Vec::new();
    let mut values = 0;
    if triangulation.verdict == Verdict::Wrong {
        not_judged.push(Unjudged::AfterFindings);
    } else {
        let sites = structure::sites(&placed.positions, &placed.weights);
        let points = Points { sites: &sites };
        let (structure, _) = Structure::new(&placed.complex, points, &monitor.part(40, 50, 100))?;
        let ranks = Ranks::of(&structure, points, &monitor.part(50, 80, 100))?;
        let spans = Spans::of(&structure, &ranks);
        values = ranks.values.len();
        let rest = monitor.part(80, 99, 100);
        findings.extend(judge(file, &structure, &ranks, &spans, &rest)?);
    }
    let absent = [
        (file.gabriel.is_none(), Unjudged::Gabriel),
        (file.regular.is_none() || file.interior.is_none(), Unjudged::Intervals),
        (file.pairs.is_none(), Unjudged::Pairs),
        (file.pairs.as_ref().is_some_and(|pairs| pairs.loops.is_none()), Unjudged::Loops),
    ];
    not_judged.extend(absent.into_iter().filter(|absent| absent.0).map(|absent| absent.1));
    let verdict = Verdict::of(findings.len(), findings.iter().filter(|f| f.is_tie()).count());
    let count = findings.len();
    monitor.part(99, 100, 100).report(1, 1)?;
    let certificate =
        FiltrationCertificate { verdict, findings: count, triangulation, values, not_judged };
    Ok((findings, certificate))
}

/// The complex at α = ∞.
fn whole(file: &FiltrationFile) -> Result<PlacedComplex, SchemaError> {
    let mut complex = ComplexFile::of_points(file.points.clone(), Alpha::INFINITE);
    complex.weights.clone_from(&file.weights);
    complex.cells = Some(file.cells.clone());
    complex.facets = Some(file.facets.clone());
    complex.edges = Some(file.edges.clone());
    complex.vertices = Some(file.vertices.clone());
    complex.hidden.clone_from(&file.hidden);
    complex.duplicates.clone_from(&file.duplicates);
    PlacedComplex::try_from(complex)
}

/// Compares the data of the file about the simplices, which are those of the triangulation, with the exact values.
fn judge(
    file: &FiltrationFile,
    structure: &Structure,
    ranks: &Ranks,
    spans: &Spans,
    monitor: &Monitor,
) -> Result<Vec<FiltrationFinding>, Cancelled> {
    let vertices: Vec<[u32; 1]> = file.vertices.iter().map(|&v| [v]).collect();
    let rows = RowNumbers::of(file, structure);
    let at = |rank: u32| ranks.alpha(rank);
    let mut findings = Vec::new();
    let values = &file.values;
    let mut compare = |bound, given: [&[Alpha]; 3], of: fn(&Span) -> u32| {
        let expected = |spans: &'_ [Span], row: usize| of(&spans[row]);
        let known = |rank| (at(rank), ranks.exact(rank));
        findings.extend(differences(bound, &vertices, given[0], |i| {
            known(expected(&spans.vertices, rows.vertices[i]))
        }));
        findings.extend(differences(bound, &file.edges, given[1], |i| {
            known(expected(&spans.edges, rows.edges[i]))
        }));
        findings.extend(differences(bound, &file.facets, given[2], |i| {
            known(expected(&spans.facets, rows.facets[i]))
        }));
    };
    compare(Bound::Value, [&values.vertices, &values.edges, &values.facets], |span| span.first);
    if let Some(Below { vertices, edges, facets }) = &file.regular {
        compare(Bound::Regular, [vertices, edges, facets], |span| span.regular);
    }
    if let Some(Below { vertices, edges, facets }) = &file.interior {
        compare(Bound::Interior, [vertices, edges, facets], |span| span.interior);
    }
    findings.extend(differences(Bound::Value, &file.cells, &values.cells, |i| {
        let rank = spans.cells[rows.cells[i]];
        (at(rank), ranks.exact(rank))
    }));
    if let Some(gabriel) = &file.gabriel {
        let own = |known: &[u32], row: usize| known[row] != ATTACHED;
        findings.extend(finding::gabriel(&vertices, &gabriel.vertices, |i| {
            own(&ranks.vertices, rows.vertices[i])
        }));
        findings.extend(finding::gabriel(&file.edges, &gabriel.edges, |i| {
            own(&ranks.edges, rows.edges[i])
        }));
        findings.extend(finding::gabriel(&file.facets, &gabriel.facets, |i| {
            own(&ranks.facets, rows.facets[i])
        }));
    }
    let disorder = order::judge(file, &rows, ranks, spans, &monitor.part(1, 5, 10))?;
    if let (true, Some(given)) = (disorder.is_empty(), &file.pairs) {
        let monitor = monitor.part(5, 10, 10);
        findings.extend(pairs::judge(file, given, structure, &rows, spans, &monitor)?);
    }
    findings.extend(disorder);
    Ok(findings)
}
