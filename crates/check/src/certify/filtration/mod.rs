//! Certification of a filtration: is each simplex there, and does it come when the file says?

mod finding;
mod order;
mod pairs;
mod spans;
mod values;

use serde::Serialize;

use super::certificate::verdict_in_words;
use super::structure::Structure;
use super::{Certificate, CertifyError, Points, Verdict};
use crate::Alpha;
use crate::schema::{Below, ComplexFile, FiltrationFile, PlacedComplex, SchemaError};

use finding::differences;
use spans::Spans;
use values::Ranks;

pub use finding::{Bound, FiltrationFinding};

/// What was judged of a filtration, and what not.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct FiltrationCertificate {
    /// What follows from all findings: valid if only the triangulation departs from the rule, at ties.
    pub verdict: Verdict,
    /// How many findings there are.
    pub findings: usize,
    /// That of the triangulation, which is the complex at α = ∞.
    pub triangulation: Certificate,
    /// Values that are different numbers.
    pub values: usize,
    /// What was not judged.
    pub not_judged: Vec<Unjudged>,
}

/// The verdict with its reason, in one line.
impl std::fmt::Display for FiltrationCertificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        verdict_in_words(f, self.verdict, self.findings, self.triangulation.ties, true)
    }
}

/// Parts of a filtration that are not judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Unjudged {
    /// Values, classes and order: the triangulation is wrong.
    AfterFindings,
    /// Which simplices are Gabriel: the file does not say.
    Gabriel,
    /// From when on simplices are regular and interior: the file does not say.
    Intervals,
    /// Persistence pairs: the file lists none.
    Pairs,
}

impl std::fmt::Display for Unjudged {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::AfterFindings => "values, classes and order (they rest on the triangulation)",
            Self::Gabriel => "which simplices are Gabriel (the file does not say)",
            Self::Intervals => {
                "from when on simplices are regular and interior (the file does not say)"
            }
            Self::Pairs => "persistence pairs (the file lists none)",
        })
    }
}

/// Why a file cannot be judged as a filtration.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CertifyFiltrationError {
    /// Fields do not fit together.
    #[error(transparent)]
    Schema(#[from] SchemaError),
    /// The triangulation cannot be judged.
    #[error(transparent)]
    Triangulation(#[from] CertifyError),
    /// The points are those of a torus.
    #[error("filtrations of a periodic box are not judged")]
    Periodic,
}

impl CertifyFiltrationError {
    /// What to do about it, where there is something.
    pub fn advice(&self) -> Option<&'static str> {
        match self {
            Self::Schema(error) => error.advice(),
            Self::Triangulation(error) => error.advice(),
            Self::Periodic => Some("judge the complexes at some α instead"),
        }
    }
}

/// Judges a filtration: that its simplices are a whole regular triangulation (the rules of
/// [`Claim::visit`](crate::Claim::visit) at α = ∞; of points that span no volume, that of their plane or
/// line), the value of each, whether it is Gabriel, from
/// which α on it is regular and interior, the order, and where that is right the persistence pairs. All
/// by exact numbers; the doubles of a file must be the nearest.
///
/// With the intervals every class at every α is judged: below its value a simplex is exterior, then
/// singular, regular and interior. Faces come before their cofaces where the order is right: no value
/// is smaller than that of a face, and the order of equal ones is by dimension.
///
/// Linear up to sorting, some microseconds for each simplex.
///
/// # Errors
/// [`CertifyFiltrationError`]: fields that do not pair up, numbers out of range; points of a torus.
pub fn certify_filtration(
    file: &FiltrationFile,
) -> Result<(Vec<FiltrationFinding>, FiltrationCertificate), CertifyFiltrationError> {
    file.check()?;
    if file.periodic.is_some() {
        return Err(CertifyFiltrationError::Periodic);
    }
    let placed = whole(file)?;
    let (found, triangulation) = placed.claim().findings()?;
    let mut findings: Vec<_> = found.into_iter().map(FiltrationFinding::Triangulation).collect();
    let mut not_judged = Vec::new();
    let mut values = 0;
    if triangulation.verdict == Verdict::Wrong {
        not_judged.push(Unjudged::AfterFindings);
    } else {
        let points = Points { positions: &placed.positions, weights: &placed.weights };
        let (structure, _) = Structure::new(&placed.complex, points);
        let ranks = Ranks::of(&structure, points);
        let spans = Spans::of(&structure, &ranks);
        values = ranks.values.len();
        findings.extend(judge(file, &structure, &ranks, &spans));
    }
    let absent = [
        (file.gabriel.is_none(), Unjudged::Gabriel),
        (file.regular.is_none() || file.interior.is_none(), Unjudged::Intervals),
        (file.pairs.is_none(), Unjudged::Pairs),
    ];
    not_judged.extend(absent.into_iter().filter(|absent| absent.0).map(|absent| absent.1));
    let verdict = Verdict::of(findings.len(), findings.iter().filter(|f| f.is_tie()).count());
    let count = findings.len();
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

/// What the file says of the simplices, which are those of the triangulation, against what is so.
fn judge(
    file: &FiltrationFile,
    structure: &Structure,
    ranks: &Ranks,
    spans: &Spans,
) -> Vec<FiltrationFinding> {
    let vertices: Vec<[u32; 1]> = file.vertices.iter().map(|&v| [v]).collect();
    let rows = RowNumbers {
        vertices: vertices.iter().map(|&row| structure.vertices.row(row) as usize).collect(),
        edges: file.edges.iter().map(|&row| structure.edges.row(row) as usize).collect(),
        facets: file.facets.iter().map(|&row| structure.facets.row(row) as usize).collect(),
        cells: file.cells.iter().map(|&row| structure.cells.row(row) as usize).collect(),
    };
    let at = |rank: u32| ranks.alpha(rank);
    let mut findings = Vec::new();
    let values = &file.values;
    let mut compare = |bound, given: [&[Alpha]; 3], of: fn(&spans::Span) -> u32| {
        let expected = |spans: &'_ [spans::Span], row: usize| of(&spans[row]);
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
        let own = |known: &[u32], row: usize| known[row] != values::ATTACHED;
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
    let disorder = order::judge(file, &rows, ranks, spans);
    if let (true, Some(given)) = (disorder.is_empty(), &file.pairs) {
        findings.extend(pairs::judge(file, given, structure, &rows, spans));
    }
    findings.extend(disorder);
    findings
}

/// The row in the triangulation of each simplex of the file.
struct RowNumbers {
    vertices: Vec<usize>,
    edges: Vec<usize>,
    facets: Vec<usize>,
    cells: Vec<usize>,
}
